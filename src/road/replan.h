#pragma once

#include <optional>
#include <vector>

#include "road/path.h"

namespace sumogamma {

/// Somebody amid its path, which is made again from there on. The new one begins `back` [m] behind
/// it or at the edge's begin. Precondition: the path is a vehicle's.
struct Replan {
  const RoadNetwork& network;
  const Path& path;
  double along;  ///< on the path [m]
  double back;   ///< [m]
};

/// A path made again, and the place on it [m].
struct Replanned {
  Path path;
  double along;
};

// All keep the halts that lie ahead, and give nothing where the trip can't go on that way.

/// Moves over into `target`, a neighbour of the lane there, within `distance` [m], and goes on as
/// the trip needs. Nothing where the edge ends before the change does, the lane does not lead on,
/// or too little is left of it for the changes that it takes from there.
std::optional<Replanned> change_lane(const Replan& from, LaneId target, double distance);

/// Stays on the present lane for `stay` [m] more before it changes lanes. Nothing where too little
/// of the edge would be left to change.
std::optional<Replanned> stay_in_lane(const Replan& from, double stay);

/// For somebody who is amid a lane change and gives it up: back to the middle of the lane that it
/// came from. Nothing where there is no change, or it has come more than two thirds of the way.
std::optional<Replanned> back_to_lane(const Replan& from);

/// Leaves the edge by the present lane, for who finds no gap. Nothing where the lane doesn't lead
/// into the route's next edge, that one is too short for the changes that it takes there, or they
/// cost more than `worse` lane changes later on.
std::optional<Replanned> keep_lane(const Replan& from, double worse);

/// Comes out of the junction ahead, or the one that it is on, on `target`, a lane beside the one
/// that its link leads to: it moves over on the last 12 m of the link.
std::optional<Replanned> enter_beside(const Replan& from, LaneId target);

/// A place in a lane, or on a link that begins there: counted from the lane's begin still [m].
struct LanePlace {
  LaneId lane = kNoLane;
  ConnectionId link = kNoConnection;
  double along = 0;
};

/// For who has come to `place` by no way that its path knows: in that lane for some way, as far as
/// that leaves room for the lane changes that the trip takes, else out of it by its own link, and
/// no further than the trip's lanes lead. Nothing where the lane isn't on the rest of the route.
std::optional<Replanned> go_on_from(const Replan& from, const LanePlace& place);

/// Goes on by another route to the same destination, which begins with the edge where it is.
/// Nobody who has halts ahead gets another route.
std::optional<Replanned> take_route(const Replan& from, std::vector<EdgeId> route);

/// The same path by the speed limits that hold now. Precondition: it is a vehicle's.
Path with_speed_limits(const Path& path, const std::vector<double>& limits);

}  // namespace sumogamma
