#pragma once

#include "road/path.h"

namespace sumogamma {

inline bool allows(const Lane& lane, VehicleClassMask vehicle_class) {
  return (lane.allowed & vehicle_class) != 0;
}

/// Width of the lanes beside `lane` on the inner or outer side, as far as `counts(Lane)` holds [m].
template <typename Counts>
double width_beside(const RoadNetwork& network, const Lane& lane, bool inner, Counts&& counts) {
  double width = 0.0;
  const Lane* here = &lane;
  for (;;) {
    const LaneId next = inner ? here->inner : here->outer;
    if (next == kNoLane || !counts(network.lane(next))) return width;
    here = &network.lane(next);
    width += here->width;
  }
}

/// From the middle of a lane to the kerb, over the lanes of other vehicles [m].
double width_to_kerb(const RoadNetwork& network, const Lane& lane);

/// Moves the stop lines of a path with rounded corners back to where it passes the ends of the
/// lanes: it may pass them earlier than their own middles do.
void move_stop_lines(const RoadNetwork& network, Path& path);

/// Calls carry(along) for every place on a path that moves with its line: ends of stretches, links,
/// halts, pieces over roads.
template <typename Carry>
void carry_places(Path& path, Carry&& carry) {
  for (PathStretch& stretch : path.stretches) {
    carry(stretch.from);
    carry(stretch.to);
  }
  for (PathLink& link : path.links) {
    carry(link.halt);
    carry(link.stop_line);
    carry(link.end);
    carry(link.inside);
  }
  for (PathStop& stop : path.stops) carry(stop.along);
  for (RoadCrossing& piece : path.over_road) {
    carry(piece.begin);
    carry(piece.end);
  }
}

/// Appends the points of a line between two places on it [m], ends included; reversed where to <
/// from.
void append_span(const Polyline& line, double from, double to, std::vector<Vec2>& points);

}  // namespace sumogamma
