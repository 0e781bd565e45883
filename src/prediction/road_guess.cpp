#include "prediction/road_guess.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace sumogamma {

namespace {

constexpr double kBeside = 2.0;      // of a lane's surface [m]
constexpr double kAligned = 0.5;     // cosine between lane and heading
constexpr std::size_t kPieces = 24;  // lanes that a way may run over

/// Angle by which a connection turns, positive left [rad].
double turn_of(const RoadNetwork& network, const Connection& connection) {
  const Polyline& from = network.lane(connection.from).centerline;
  const Polyline& to = network.lane(connection.to).centerline;
  const Vec2 before = from.direction_at(from.length()), after = to.direction_at(0);
  return std::atan2(cross(before, after), before.dot(after));
}

/// Appends the part of a lane's centreline that is still ahead; returns its length [m].
double append_rest(const Polyline& line, double along, bool reversed, std::vector<Vec2>& points) {
  const std::vector<Vec2>& vertices = line.points();
  points.push_back(line.point_at(along));
  if (reversed) {
    for (std::size_t k = vertices.size(); k-- > 0;)
      if (line.along_of_vertex(k) < along) points.push_back(vertices[k]);
    return along;
  }
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (line.along_of_vertex(k) > along) points.push_back(vertices[k]);
  return line.length() - along;
}

}  // namespace

std::array<ConnectionId, kRoadWays> RoadGuess::branches(LaneId lane, VehicleClassMask mask) const {
  std::array<ConnectionId, kRoadWays> found{};
  found.fill(kNoConnection);
  double straightest = 1e300, leftmost = -1e300, rightmost = 1e300;
  for (const ConnectionId id : network_->lane(lane).outgoing) {
    const Connection& connection = network_->connection(id);
    if (!(network_->lane(connection.to).allowed & mask) ||
        connection.direction == TurnDirection::Turnaround)
      continue;
    const double turn = turn_of(*network_, connection);
    if (std::abs(turn) < straightest) straightest = std::abs(turn), found[0] = id;
    if (turn > leftmost) leftmost = turn, found[1] = id;
    if (turn < rightmost) rightmost = turn, found[2] = id;
  }
  return found;
}

Polyline RoadGuess::follow(LaneId lane, double along, bool reversed, std::size_t way,
                           VehicleClassMask mask, double length) const {
  std::vector<Vec2> points;
  double left = length - append_rest(network_->lane(lane).centerline, along, reversed, points);
  // against a lane there are no connections to go by
  for (std::size_t piece = 0; piece < kPieces && left > 0 && !reversed; ++piece) {
    const ConnectionId id = branches(lane, mask)[way];
    if (id == kNoConnection) break;
    const Connection& connection = network_->connection(id);
    // one decision: after the next junction the straightest counts
    if (network_->lane(lane).outgoing.size() > 1) way = 0;
    lane = connection.via != kNoLane ? connection.via : connection.to;
    if (network_->lane(lane).kind == LaneKind::WalkingArea) break;
    left -= append_rest(network_->lane(lane).centerline, 0, false, points);
  }
  Polyline line(points);
  if (left <= 0) return line;
  points.push_back(line.points().back() + left * line.direction_at(line.length()));
  return Polyline(points);
}

std::optional<std::array<Polyline, kRoadWays>> RoadGuess::ways(const AgentType& type,
                                                               const Vec2& position, double heading,
                                                               double length) const {
  if (network_ == nullptr) return std::nullopt;
  const VehicleClassMask mask = vehicle_class_from_name(type.sumo_class);
  const LaneHit hit = locator_.find_nearest(position, mask, heading, kBeside);
  if (hit.lane == kNoLane || network_->lane(hit.lane).kind == LaneKind::WalkingArea)
    return std::nullopt;
  const double agreement = hit.direction.dot(direction_of(heading));
  const bool reversed = type.kinematics == Kinematics::Holonomic && agreement < 0;
  if ((reversed ? -agreement : agreement) < kAligned) return std::nullopt;
  std::array<Polyline, kRoadWays> ways;
  for (std::size_t way = 0; way < kRoadWays; ++way)
    ways[way] = follow(hit.lane, hit.along, reversed, way, mask, length);
  return ways;
}

void follow_line(const Polyline& line, const Vec2& position, std::span<const double> progress,
                 std::span<Vec2> displacement) {
  const PolylinePosition start = line.project(position);
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    const double along = start.along + progress[k];
    displacement[k] =
        line.point_at(along) + start.offset * left_of(line.direction_at(along)) - position;
  }
}

}  // namespace sumogamma
