#pragma once

#include <string>
#include <vector>

#include "road/path.h"

namespace sumogamma {

/// The last of a link on which a path is led over to the lane behind it [m].
inline constexpr double kEntryReach = 12.0;

/// A place on a trip: an edge of its route, and how far along one of its lanes [m].
struct TripPlace {
  std::size_t edge = 0;  ///< of the route
  int lane = 0;          ///< of the edge
  double along = 0;
};

/// Where the route's edge `index` is left, along its lane `lane` [m].
double end_of(const Trip& trip, std::size_t index, const Lane& lane);

/// The first stop on the route's edge `index` beyond `from` along it that has to be in a lane.
const RouteStop* stop_on_lane(const Trip& trip, std::size_t index, double from);

/// Puts the path of a vehicle together, piece by piece, along lanes and links.
class PathBuilder {
 public:
  PathBuilder(const RoadNetwork& network, const PathRequest& request)
      : network_(network), request_(request) {}

  /// What comes now belongs to this edge of the route.
  void enter_edge(std::size_t route_index) { route_index_ = static_cast<int>(route_index); }
  /// Runs along one lane between two places on it.
  void follow(LaneId id, double from, double to);
  /// Moves over from one lane to its neighbour on the same edge while covering [from, to] of the
  /// old one. Returns how many metres of the new lane lie beside one of the old: in a bend not one.
  double change(LaneId old_lane, LaneId new_lane, double from, double to);
  /// Crosses a junction by a connection, into `beside` instead of its own lane where that is one;
  /// false where its internal lanes don't lead to the target.
  bool cross(ConnectionId id, LaneId beside = kNoLane);
  /// Goes on from a place of the trip to its end. False with `why` set where a junction on the way
  /// can't be crossed.
  bool drive_on(const Trip& trip, TripPlace from, std::string& why);
  /// The path of what was put together. The builder is used up.
  Path finish();
  /// Likewise of a piece of the trip, with its halts but for those behind its beginning.
  Path finish(std::shared_ptr<const Trip> trip);

 private:
  void cover_edge(const Edge& edge, const TripPlace& from, int exit, double to);
  void follow_link(LaneId id, LaneId to, double most);
  double length();
  void begin_stretch(LaneId id, double lane_from);
  void end_stretch() { path_.stretches.back().to = length(); }
  PathStretch stretch_on(LaneId id) const;

  const RoadNetwork& network_;
  const PathRequest& request_;
  int route_index_ = 0;
  Path path_;
  std::vector<Vec2> points_;
  std::size_t measured_ = 0;
  double length_ = 0.0;
};

}  // namespace sumogamma
