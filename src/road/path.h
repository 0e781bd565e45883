#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/packed_values.h"
#include "road/road_network.h"

namespace sumogamma {

/// A piece of a path that runs on one lane (or from one into its neighbour during a lane change).
struct PathStretch {
  LaneId lane = kNoLane;
  double from = 0, to = 0;  ///< along the path [m]
  double lane_from = 0;     ///< along the lane where the stretch begins [m]
  bool reversed = false;    ///< pedestrians: walked against the lane's direction
  double speed_limit = 0;   ///< [m/s]
  double room_left = 0;     ///< path to the left boundary of what the class may use [m]
  double room_right = 0;    ///< likewise to the right [m]
  double kerb = 0;          ///< path to the kerb, over lanes of any vehicles [m]
  int route_index = -1;     ///< of the edge in the trip's route; -1 on foot
  bool changing = false;    ///< moves over into `lane` from its neighbour
};

/// A junction link on the path: where rules of right of way and signals apply.
struct PathLink {
  ConnectionId connection = kNoConnection;
  double stop_line = 0;  ///< along the path, where the link begins [m]
  double end = 0;        ///< along the path, where the junction is left [m]
  double halt = 0;       ///< along the path, where a front that waits comes to rest at most [m]
  double inside = 0;     ///< along the path, up to where a front may wait on the junction for those
                         ///< who go first (SUMO's cont); the stop line or less where it may not [m]
  /// On foot: sides of the room beside the path in which who waits at `halt` is off the ways that
  /// vehicles take [m, left positive].
  double halt_left = std::numeric_limits<double>::infinity(),
         halt_right = -std::numeric_limits<double>::infinity();
};

/// A planned halt: a <stop> of the route.
struct PathStop {
  double along = 0;     ///< front bumper's place [m]
  double duration = 0;  ///< [s]; infinite: until the world lets it go on
  double room = 0;      ///< before `along`, in which it may halt behind another that does [m]
  int plan = -1;        ///< index in the plan of its vehicle, as the world counts
};

/// A planned halt as a trip has it: an edge of the route, a lane of that and a place on it.
struct RouteStop {
  std::size_t route_index = 0;
  int lane_index = -1;  ///< -1: any lane
  double along = 0;     ///< front bumper's place along the lane [m]
  double room = 0;      ///< as PathStop::room
  int plan = -1;        ///< as PathStop::plan
};

/// Where a walk leads straight over a road between junctions, from kerb to kerb.
struct RoadCrossing {
  double begin = 0, end = 0;  ///< along the path: where the sidewalks' edges are [m]
};

/// Who is longer than this leaves its lane with its ends where it turns [m].
inline constexpr double kLongBody = 8.0;

/// How a body takes bends.
struct Cornering {
  double turning_radius = 0;     ///< tightest that it can drive [m]; bends are rounded to about it
  double length = 0, width = 0;  ///< [m]; 0: short
  bool keep_left = false;        ///< the kerb is on the left
};

/// Speed limits that hold now, by LaneId [m/s]: variable speed signs. Null: the network's.
using SpeedLimits = std::shared_ptr<const std::vector<double>>;

/// What a path is made from.
struct PathRequest {
  std::span<const EdgeId> route;
  VehicleClassMask vehicle_class = 0;
  LaneId start_lane = kNoLane;            ///< kNoLane: the best lane of the first edge
  double start_along = 0;                 ///< on the start lane [m]
  double arrival_position = -1;           ///< on the last edge [m]; negative: its end
  double max_lateral_acceleration = 2.5;  ///< [m/s^2]
  double comfortable_deceleration = 2.5;  ///< [m/s^2]
  double max_speed = 50;                  ///< [m/s]
  double speed_factor = 1;                ///< of the lane limits
  SpeedLimits speed_limits;      ///< shared by all: what changes there holds for new pieces
  Cornering cornering;           ///< none: as the lanes lie
  std::vector<RouteStop> stops;  ///< in order; the path is in their lanes at their places
  double mid_block = -1;  ///< in [0, 1): on foot crosses between junctions, that share of the way
                          ///< to the junction ahead; negative: on crossings alone
};

/// One lane of one edge of a route and the cheapest way on from it.
struct LaneOption {
  double cost = std::numeric_limits<double>::infinity();  ///< lane changes from entering here to
                                                          ///< the route's end, weighted
  int exit_index = -1;                ///< index of the lane on which the edge is left
  ConnectionId next = kNoConnection;  ///< connection taken from there
  double drivable = 0;  ///< from the edge's begin until a lane change can't be put off any more [m]
  double leave_cost = std::numeric_limits<double>::infinity();  ///< of leaving by this very lane
  ConnectionId leave = kNoConnection;                           ///< likewise the connection
};

/// Where a vehicle goes, apart from the lanes that it takes: what its path is made from again when
/// it changes them.
struct Trip {
  std::vector<EdgeId> route;
  PathRequest request;                           ///< `route` there is this one's
  std::vector<std::vector<LaneOption>> options;  ///< by edge of the route, then by lane index

  Trip() = default;
  Trip(const Trip&) = delete;  // the request refers to the route
  Trip& operator=(const Trip&) = delete;
};

/// By how much a line is nearer to the edges of its lanes than their middles are [m].
struct Cut {
  double left = 0, right = 0;
};

/// Where the middle of the lane lies beside a path's line: corners are rounded on their inner side.
struct LaneMiddle {
  std::uint32_t piece = 0;  ///< of Path::kProfileStep, from the path's begin
  double offset = 0;        ///< positive to the left [m]
};

/// A way through the network that one agent means to follow: geometry with everything that rules
/// need to know along it.
struct Path {
  Polyline line;
  std::vector<PathStretch> stretches;   ///< in order, gapless
  std::vector<PathLink> links;          ///< in order of stop_line
  std::vector<PathStop> stops;          ///< in order
  std::vector<RoadCrossing> over_road;  ///< in order; on foot
  /// [m/s] every kProfileStep along: bends and limits with braking ahead. Packed, as it and the
  /// lane's middles would be most of what an agent takes in memory.
  PackedValues speed_profile;
  std::vector<LaneMiddle> lane_middle;  ///< in order; those at least kLeastCut off the line
  double arrival = 0;                   ///< along, where the trip ends [m]
  bool walking = false;
  std::shared_ptr<const Trip> trip;  ///< null on foot

  static constexpr double kProfileStep = 1.0;
  static constexpr double kLeastCut = 0.1;  ///< smoothing leaves less everywhere [m]

  /// Stretch that holds `along` (clamped). Precondition: not empty.
  const PathStretch& stretch_at(double along) const;
  /// First link that doesn't end before `along`, or the end of links.
  std::vector<PathLink>::const_iterator link_from(double along) const {
    return std::lower_bound(links.begin(), links.end(), along,
                            [](const PathLink& link, double value) { return link.end < value; });
  }
  /// First link that begins beyond `along`, or the end of links.
  std::vector<PathLink>::const_iterator link_after(double along) const {
    return std::upper_bound(
        links.begin(), links.end(), along,
        [](double value, const PathLink& link) { return value < link.stop_line; });
  }
  /// Speed that bends and limits leave at `along`, interpolated [m/s].
  double profile_at(double along) const;
  /// By how much less than its stretches say the line leaves to its sides between two places; 0
  /// where that is less than kLeastCut.
  Cut cut_between(double from, double to) const;
};

/// Path of a vehicle along its route: the lanes that need the fewest lane changes, changes spread
/// over the edge. It halts at the request's stops until the world lets it go on, and has none of
/// those that lie behind its beginning. nullopt with `why` set where a pair of edges isn't
/// connected for the class.
std::optional<Path> build_driving_path(const RoadNetwork& network, const PathRequest& request,
                                       std::string& why);

/// Path of a pedestrian along the edges of a walk: sidewalks in either direction, walking areas and
/// crossings between them found by least distance. nullopt with `why` set where the walk can't be
/// connected. Who crosses between junctions (`mid_block`) does where that saves the crossing of the
/// road it walks along.
std::optional<Path> build_walking_path(const RoadNetwork& network, const PathRequest& request,
                                       std::string& why);

}  // namespace sumogamma
