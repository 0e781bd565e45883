#pragma once

#include <optional>

#include "model/tick_geometry.h"
#include "model/tracking.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// Backing out: what drivers do who stand nose to nose. differs from the paper: K holds no velocity
/// backwards, so two bodies that are in each other's way would stand for ever. A vehicle that has
/// been wedged for long (see is_wedged) and has room behind rolls back along its path by some
/// metres, at walking pace, and then lets the others go first for some seconds. Where there is no
/// room behind, those who stand there roll back before it, one after the other. Who has stood for
/// long in the way of somebody wedged, and waits for that one or for another who is, steps back
/// likewise.
///
/// Still to roll back for that long, and still to let others go first [s]; kept once a tick, after
/// everybody has moved.
void update_backing(const TrafficView& view, const TickGeometry& geometry, double dt,
                    TrafficState& traffic, std::size_t row);

/// The body after a tick of backing out, as far as it keeps clear of everybody as they would brake
/// now; nothing where the row isn't backing, or stands and has no room to begin. Forward speed 0.
std::optional<BodyState> back_out(const TrafficView& view, const TickGeometry& geometry,
                                  std::size_t row, double dt);

}  // namespace sumogamma
