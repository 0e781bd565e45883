#pragma once

#include "traffic/junction/arbitration.h"

namespace sumogamma {

/// A piece of a link as it lies for somebody on `path`, whose link begins at `link_begin`: who
/// walks over a crossing against its lane meets the same places in the opposite order, counted from
/// the other end.
struct Piece {
  double begin = 0, end = 0;
};
Piece as_travelled(const Path& path, double link_begin, double begin, double end);

/// Where a front waits for a zone of a link [m along its path]: before the stop line, or on the
/// junction where SUMO's network has room for that before the zone. The flag says which.
struct WaitingPlace {
  double along = 0;
  bool inside = false;
};
WaitingPlace waiting_place(const TrafficParameters& parameters, const PathLink& link,
                           double zone_begin);

/// Who has to wait on a junction waits where it stands in nobody's way: not with its body in a zone
/// that somebody else is about to need, but before it, unless it is in there already.
void keep_zones_free(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                     LinkDecision& decision);

}  // namespace sumogamma
