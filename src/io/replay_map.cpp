#include "io/replay_map.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

/// How a lane looks. The numbers are known to replay/map.js.
enum class Look { Road = 0, Walk = 1, Cycle = 2, Rail = 3, Inside = 4, Crossing = 5, Area = 6 };

using vehicle_class::kMotor;

Look look_of(const Lane& lane) {
  if (lane.kind == LaneKind::Crossing) return Look::Crossing;
  if (lane.kind == LaneKind::WalkingArea) return Look::Area;
  if (lane.allowed & kMotor) return lane.kind == LaneKind::Internal ? Look::Inside : Look::Road;
  if (lane.allowed & vehicle_class::kPedestrian) return Look::Walk;
  if (lane.allowed & vehicle_class::kBicycle) return Look::Cycle;
  if (lane.allowed & vehicle_class::kOnRails) return Look::Rail;
  return Look::Walk;  // closed to everybody: verges and the like
}

std::int64_t decimetres(double metres) { return std::llround(metres * 10.0); }

Json flat(const std::vector<Vec2>& points) {
  Json list = Json::array();
  for (const Vec2& point : points) {
    list.push_back(decimetres(point.x()));
    list.push_back(decimetres(point.y()));
  }
  return list;
}

Json lane_json(const RoadNetwork& network, const Lane& lane) {
  Json json = {{"k", static_cast<int>(look_of(lane))}, {"p", flat(lane.centerline.points())}};
  if (lane.kind != LaneKind::WalkingArea) json["w"] = decimetres(lane.width);
  if (!lane.elevation.empty()) {
    const double mean = std::accumulate(lane.elevation.begin(), lane.elevation.end(), 0.0) /
                        static_cast<double>(lane.elevation.size());
    // layers of OpenStreetMap are 5 m apart
    if (const auto level = std::llround(mean / 5.0); level != 0) json["z"] = level;
  }
  if (lane.kind == LaneKind::Normal) {
    // what lies on the side of the road's middle: another lane of the same edge (dashed) or the
    // road's middle (solid)
    const bool vehicles = lane.allowed & (kMotor | vehicle_class::kBicycle);
    if (vehicles && lane.inner != kNoLane) json["m"] = 1;
    if (vehicles && lane.inner == kNoLane && lane.opposite != kNoLane) json["m"] = 2;
    if (network.left_hand && json.contains("m")) json["l"] = 1;
  }
  return json;
}

/// A stop line with the signal links that lead over it: x, y, direction of travel [rad/1000], half
/// width, links.
Json stop_line_json(const RoadNetwork& network, const Lane& lane) {
  Json links = Json::array();
  for (const ConnectionId id : lane.outgoing) {
    const Connection& connection = network.connection(id);
    if (connection.signal == kNoSignal || network.lane(connection.to).kind == LaneKind::Crossing)
      continue;
    links.push_back(index_of(connection.signal));
    links.push_back(connection.signal_link);
  }
  if (links.empty()) return nullptr;
  const Vec2 end = lane.centerline.points().back();
  const double heading = heading_of(lane.centerline.direction_at(lane.centerline.length()));
  return {decimetres(end.x()), decimetres(end.y()), std::llround(heading * 1000.0),
          decimetres(0.5 * lane.width), links};
}

/// A signalled crossing shows its light at both ends: the same layout as a stop line.
void append_crossing_lights(const RoadNetwork& network, const Lane& lane, Json& lines) {
  for (const ConnectionId id : lane.incoming) {
    const Connection& connection = network.connection(id);
    if (connection.signal == kNoSignal || lane.centerline.points().size() < 2) continue;
    const Json links = {index_of(connection.signal), connection.signal_link};
    for (const double along : {0.0, lane.centerline.length()}) {
      const Vec2 place = lane.centerline.point_at(along);
      const double heading = heading_of(lane.centerline.direction_at(along));
      lines.push_back({decimetres(place.x()), decimetres(place.y()), std::llround(heading * 1000.0),
                       decimetres(0.5 * lane.width), links});
    }
    return;
  }
}

}  // namespace

std::string replay_map_json(const std::string& title, const RoadNetwork& network,
                            const AgentTypeTable& types) {
  Json lanes = Json::array(), lines = Json::array(), junctions = Json::array(),
       obstacles = Json::array();
  for (const Lane& lane : network.lanes) {
    lanes.push_back(lane_json(network, lane));
    if (lane.kind == LaneKind::Crossing) {
      append_crossing_lights(network, lane, lines);
    } else if (Json line = stop_line_json(network, lane); !line.is_null()) {
      lines.push_back(std::move(line));
    }
  }
  for (const Junction& junction : network.junctions)
    if (junction.outline.size() >= 3) junctions.push_back(flat(junction.outline));
  for (const Obstacle& obstacle : network.obstacles)
    obstacles.push_back({{"k", static_cast<int>(obstacle.kind)}, {"p", flat(obstacle.outline)}});
  Json type_list = Json::array();
  for (const AgentType& type : types)
    type_list.push_back({{"name", type.name}, {"walks", type.kinematics == Kinematics::Holonomic}});
  const Json map = {{"title", title},         {"leftHand", network.left_hand}, {"lanes", lanes},
                    {"junctions", junctions}, {"obstacles", obstacles},        {"stopLines", lines},
                    {"types", type_list}};
  return map.dump();
}

}  // namespace sumogamma
