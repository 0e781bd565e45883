#pragma once

#include "road/path.h"

namespace sumogamma {

/// Fills path.speed_profile from lane limits and curvature (v^2 kappa <= lateral acceleration),
/// then brakes backwards with the comfortable deceleration, by ramps. Curvature is the mean turning
/// over the way that the steering takes, so that a map's kinks are spread as drivers do.
void compute_speed_profile(const PathRequest& request, Path& path);

/// Rounds the corners of a driving path: a box filter along it, as wide as the turning radius asks
/// for, or the length of a long body, so that a body which can't turn on the spot cuts a corner
/// like a driver does instead of overshooting it. Places along the path are carried over.
void round_corners(const Cornering& cornering, Path& path);

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
