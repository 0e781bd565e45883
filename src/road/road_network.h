#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "geometry/polyline.h"
#include "geometry/vec2.h"

namespace sumogamma {

enum class LaneId : std::int32_t {};
enum class EdgeId : std::int32_t {};
enum class JunctionId : std::int32_t {};
enum class SignalId : std::int32_t {};
enum class ConnectionId : std::int32_t {};
inline constexpr LaneId kNoLane{-1};
inline constexpr EdgeId kNoEdge{-1};
inline constexpr JunctionId kNoJunction{-1};
inline constexpr SignalId kNoSignal{-1};
inline constexpr ConnectionId kNoConnection{-1};

/// Position of an id in its array.
template <typename Id>
constexpr std::size_t index_of(Id id) {
  return static_cast<std::size_t>(id);
}

/// SUMO's abstract vehicle classes as bits of a mask, so that who may use which lane is SUMO's own
/// permission (page Simulation/VehiclePermissions).
using VehicleClassMask = std::uint32_t;
namespace vehicle_class {
inline constexpr VehicleClassMask kPedestrian = 1u << 0, kBicycle = 1u << 1, kMotorcycle = 1u << 2,
                                  kMoped = 1u << 3, kPassenger = 1u << 4, kDelivery = 1u << 5,
                                  kTruck = 1u << 6, kTrailer = 1u << 7, kBus = 1u << 8,
                                  kTaxi = 1u << 9, kEmergency = 1u << 10, kTram = 1u << 11,
                                  kRail = 1u << 12, kRailUrban = 1u << 13, kRailElectric = 1u << 14,
                                  kRailFast = 1u << 15, kShip = 1u << 16, kPrivate = 1u << 17,
                                  kAuthority = 1u << 18, kArmy = 1u << 19, kVip = 1u << 20,
                                  kHov = 1u << 21, kCoach = 1u << 22, kEvehicle = 1u << 23,
                                  kCustom1 = 1u << 24, kCustom2 = 1u << 25, kOther = 1u << 26,
                                  kAll = ~0u;
/// Who walks, or rides among those who do.
inline constexpr VehicleClassMask kOnFootOrBicycle = kPedestrian | kBicycle;
inline constexpr VehicleClassMask kOnRails = kTram | kRail | kRailUrban | kRailElectric | kRailFast;
/// Who has a motor and drives on roads.
inline constexpr VehicleClassMask kMotor =
    kMotorcycle | kMoped | kPassenger | kDelivery | kTruck | kTrailer | kBus | kTaxi | kEmergency |
    kPrivate | kAuthority | kArmy | kVip | kHov | kCoach | kEvehicle | kCustom1 | kCustom2;
}  // namespace vehicle_class
/// Mask of a SUMO class name, deprecated ones ("public_transport") included; all bits for
/// "ignoring", whom no permission binds; kOther for a name that SUMO 1.15 doesn't know.
VehicleClassMask vehicle_class_from_name(std::string_view name);

enum class LaneKind : std::uint8_t { Normal, Internal, Crossing, WalkingArea };

/// Where the centerline of a lane crosses that of another.
struct LaneCrossing {
  LaneId other = kNoLane;
  bool apart = false;  ///< one lies a storey above the other there
};

/// A lane of any kind; immutable after reading.
struct Lane {
  std::string name;
  EdgeId edge = kNoEdge;
  int index = 0;  ///< within the edge, 0 = rightmost (leftmost with left-hand traffic)
  int layer = 0;  ///< OpenStreetMap's, over (> 0) or under others; on a junction the one nearest to
                  ///< the ground of those that meet there
  LaneKind kind = LaneKind::Normal;
  VehicleClassMask allowed = vehicle_class::kAll;
  double speed_limit = 0;  ///< [m/s]
  double width = 0;        ///< [m]
  double length =
      0;  ///< as SUMO counts positions on it [m]; the centerline may be longer or shorter
  Polyline centerline;  ///< [m]; of a walking area: its outline ring (not a path)
  std::vector<double>
      elevation;  ///< by vertex of the centerline [m]; empty: 0 everywhere. Keeps bridges apart
  std::vector<Vec2> outline;  ///< polygon of a walking area or crossing as in the file, else empty
  double beside_left = 0,
         beside_right = 0;  ///< free of people's ways beside a lane on a junction [m]
  LaneId inner = kNoLane;   ///< neighbour with the next higher index on the same edge (towards the
                            ///< road's middle)
  LaneId outer =
      kNoLane;  ///< neighbour with the next lower index on the same edge (towards the kerb)
  LaneId opposite = kNoLane;  ///< nearest lane of the opposite direction, where the network says so
  bool has_overpass = false;  ///< its edge crosses another, or itself, above or below it
  JunctionId junction = kNoJunction;    ///< of internal lanes, crossings and walking areas
  std::vector<ConnectionId> outgoing;   ///< connections that start here
  std::vector<ConnectionId> incoming;   ///< connections that end here
  std::vector<LaneCrossing> crossings;  ///< by the other lane (find_lane_crossings())
};

/// Height of the lane `along` its centerline [m], interpolated; 0 in a flat network.
double elevation_at(const Lane& lane, double along);

struct Edge {
  std::string name;
  LaneKind kind = LaneKind::Normal;
  JunctionId from = kNoJunction, to = kNoJunction;
  int priority = 0;
  std::string type;                    ///< OSM type such as "highway.primary"; may be empty
  std::vector<LaneId> lanes;           ///< by index
  std::vector<EdgeId> crossing_edges;  ///< of a crossing: the edges that it crosses
};

/// Where a link leads, seen from its begin.
enum class TurnDirection : std::uint8_t {
  Straight,
  Left,
  Right,
  PartlyLeft,
  PartlyRight,
  Turnaround
};

/// Who goes first over a link that no signal governs.
enum class LinkPriority : std::uint8_t {
  Major,
  Minor,
  Equal,  ///< right before left
  Stop,
  AllWayStop,
  Zipper,
  Other,  ///< signalled, switched off, or the end of the road
};

/// Has everybody to halt at the line of such a link?
inline bool halts_first(LinkPriority priority) {
  return priority == LinkPriority::Stop || priority == LinkPriority::AllWayStop;
}

/// A link from lane to lane over a junction.
struct Connection {
  LaneId from = kNoLane, to = kNoLane;
  LaneId via = kNoLane;  ///< first internal lane, kNoLane where the lanes meet directly
  JunctionId junction = kNoJunction;
  int junction_link = -1;  ///< index into Junction::requests; -1 where the link has none
  SignalId signal = kNoSignal;
  int signal_link = -1;  ///< index into the signal's state string
  double setback = 0;    ///< a waiting front halts this far before the link's begin [m]
  double storage =
      0;  ///< of an inner signal: way from the stop lines of the signals before it, over
          ///< their junction and the road behind it, else 0 [m] (find_inner_signals())
  TurnDirection direction = TurnDirection::Straight;
  LinkPriority priority = LinkPriority::Major;  ///< without a signal
};

/// One row of a junction's right-of-way matrix (SUMO page Networks/SUMO_Road_Networks#requests).
struct RightOfWay {
  std::vector<bool> yields_to;   ///< by link: this link must let that one pass
  std::vector<bool> conflicts;   ///< by link: the two paths cross or merge
  bool may_stop_inside = false;  ///< SUMO's cont: may wait on the junction
};

/// A junction near another and the way there along a lane of it [m].
struct JunctionNeighbour {
  JunctionId junction = kNoJunction;
  double way = 0;
};

struct Junction {
  std::string name;
  std::string type;  ///< priority, traffic_light, right_before_left, allway_stop, dead_end, ...
  Vec2 position = Vec2::Zero();
  std::vector<Vec2> outline;
  std::vector<RightOfWay> requests;
  std::vector<ConnectionId>
      links;  ///< by request index; kNoConnection for an index without a connection
  bool in_roundabout = false;
  /// In the order of the links; the same again where a later link has a shorter way
  /// (find_lane_crossings()).
  std::vector<JunctionNeighbour> neighbours;
};

struct SignalPhase {
  double duration = 0;  ///< [s]
  std::string state;    ///< by link: r, y, g, G, ... (SUMO page Simulation/Traffic_Lights)
};

/// A signal program as the network file gives it; the live state comes from SUMO.
struct Signal {
  std::string name;
  std::size_t size = 0;             ///< number of links = length of its state string
  std::vector<SignalPhase> phases;  ///< of the first program in the file
};

enum class ObstacleKind : std::uint8_t { Building, Barrier, Furniture };

/// A solid thing off the road network that nobody walks or drives through.
struct Obstacle {
  ObstacleKind kind = ObstacleKind::Building;
  std::vector<Vec2>
      outline;  ///< closed ring without a repeated point (Building) or open chain (Barrier)
};

/// Where two roads cross, one above the other; of a road that crosses itself, twice the same edge.
struct Overpass {
  EdgeId one = kNoEdge, other = kNoEdge;
  double along_one = 0,
         along_other = 0;  ///< on the centerlines of their first lanes for motor vehicles [m]
};

/// Everything immutable about the place: built once by the reader, valid by construction.
struct RoadNetwork {
  bool left_hand = false;
  std::vector<Lane> lanes;
  std::vector<Edge> edges;
  std::vector<Connection> connections;
  std::vector<Junction> junctions;
  std::vector<Signal> signals;
  std::vector<Obstacle> obstacles;
  bool has_layers = false;           ///< some road is over or under others
  std::vector<Overpass> overpasses;  ///< by edge (find_overpasses())
  Vec2 lower_corner = Vec2::Zero(),
       upper_corner = Vec2::Zero();       ///< bounding box of the network [m]
  std::string projection;                 ///< PROJ string of the file, "!" where there is none
  Vec2 projection_offset = Vec2::Zero();  ///< added to projected coordinates [m]

  std::unordered_map<std::string, LaneId> lane_by_name;
  std::unordered_map<std::string, EdgeId> edge_by_name;
  std::unordered_map<std::string, JunctionId> junction_by_name;
  std::unordered_map<std::string, SignalId> signal_by_name;

  const Lane& lane(LaneId id) const { return lanes[index_of(id)]; }
  const Edge& edge(EdgeId id) const { return edges[index_of(id)]; }
  const Connection& connection(ConnectionId id) const { return connections[index_of(id)]; }
  const Junction& junction(JunctionId id) const { return junctions[index_of(id)]; }
};

/// May any of these classes use a lane of the edge?
inline bool allows(const RoadNetwork& network, const Edge& edge, VehicleClassMask classes) {
  return std::any_of(edge.lanes.begin(), edge.lanes.end(),
                     [&](LaneId id) { return (network.lane(id).allowed & classes) != 0; });
}

/// Is a lane for people on foot and bicycles only?
inline bool is_without_motors(const Lane& lane) {
  return (lane.allowed & ~vehicle_class::kOnFootOrBicycle) == 0;
}

/// Does one edge lead straight back to where the other comes from?
inline bool are_opposite(const Edge& a, const Edge& b) { return a.from == b.to && a.to == b.from; }

/// The lane of an edge on which pedestrians walk: the lowest index that admits them, as in SUMO.
inline LaneId walking_lane(const RoadNetwork& network, EdgeId edge) {
  for (const LaneId id : network.edge(edge).lanes)
    if (network.lane(id).allowed & vehicle_class::kPedestrian) return id;
  return kNoLane;
}

/// May who takes a connection wait on the junction, where its first internal lane ends?
inline bool may_stop_inside(const RoadNetwork& network, const Connection& connection) {
  if (connection.junction == kNoJunction || connection.junction_link < 0) return false;
  const auto& requests = network.junction(connection.junction).requests;
  const auto link = static_cast<std::size_t>(connection.junction_link);
  return link < requests.size() && requests[link].may_stop_inside;
}

/// The lane beside `lane` of the same edge, to its left (side > 0) or right; kNoLane where there is
/// none.
inline LaneId lane_beside(const RoadNetwork& network, const Lane& lane, double side) {
  return (side > 0) != network.left_hand ? lane.inner : lane.outer;
}

}  // namespace sumogamma
