#pragma once

#include <optional>
#include <vector>

#include "base/parallel.h"
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
/// What a row has before it.
struct Backing {
  double left = 0;       ///< still to roll back [s]
  double gives_way = 0;  ///< still to let others go first [s]
};

/// Keeps everybody's once a tick, after all have moved: each row's follows from the frozen ones of
/// all, so that nothing depends on the order of rows. `next` is scratch. dt [s].
void update_backing(const TrafficView& view, const TickGeometry& geometry, double dt,
                    Workers& workers, std::vector<Backing>& next, TrafficState& traffic);

/// The body after a tick of backing out, as far as it keeps clear of everybody as they would brake
/// now; nothing where the row isn't backing, or stands and has no room to begin. Forward speed 0.
std::optional<BodyState> back_out(const TrafficView& view, const TickGeometry& geometry,
                                  std::size_t row, double dt);

}  // namespace sumogamma
