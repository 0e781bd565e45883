#include "inference/candidate_ways.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace sumogamma {

namespace {

constexpr double kLength = 100.0;  // of way behind the next junction [m]

double length_of(const RoadNetwork& network, EdgeId edge) {
  const auto& lanes = network.edge(edge).lanes;
  return lanes.empty() ? 0.0 : network.lane(lanes.front()).length;
}

/// 0 for straight on, more for what turns more.
int turn_of(const Connection& connection) {
  switch (connection.direction) {
    case TurnDirection::Straight:
      return 0;
    case TurnDirection::PartlyLeft:
    case TurnDirection::PartlyRight:
      return 1;
    case TurnDirection::Left:
    case TurnDirection::Right:
      return 2;
    case TurnDirection::Turnaround:
      break;
  }
  return 3;
}

}  // namespace

CandidateWays::CandidateWays(const RoadNetwork& network)
    : network_(network), over_(network.lanes.size()) {
  for (std::size_t i = 0; i < network.connections.size(); ++i) {
    const Connection& link = network.connections[i];
    if (network.lane(link.from).kind != LaneKind::Normal) continue;
    for (LaneId lane = link.via; lane != kNoLane;) {
      over_[index_of(lane)].push_back(static_cast<ConnectionId>(i));
      const auto& next = network.lane(lane).outgoing;
      lane = next.empty() ? kNoLane : network.connection(next.front()).via;
    }
  }
}

/// The edge and those that lie straightest on behind it, up to kLength.
std::vector<EdgeId> CandidateWays::straight_on(EdgeId from, VehicleClassMask mask) const {
  std::vector<EdgeId> route = {from};
  for (double length = length_of(network_, from); length < kLength;) {
    const Connection* best = nullptr;
    for (const LaneId lane : network_.edge(route.back()).lanes) {
      if ((network_.lane(lane).allowed & mask) == 0) continue;
      for (const ConnectionId id : network_.lane(lane).outgoing) {
        const Connection& link = network_.connection(id);
        const Lane& to = network_.lane(link.to);
        const bool known = std::find(route.begin(), route.end(), to.edge) != route.end();
        if ((to.allowed & mask) == 0 || to.kind != LaneKind::Normal || known) continue;
        if (best == nullptr || turn_of(link) < turn_of(*best)) best = &link;
      }
    }
    if (best == nullptr) break;
    route.push_back(network_.lane(best->to).edge);
    length += std::max(length_of(network_, route.back()), 1.0);
  }
  return route;
}

void CandidateWays::add_way(const AgentType& type, LaneId start, std::vector<EdgeId> route,
                            Ways& ways) const {
  PathRequest request;
  request.route = route;
  request.vehicle_class = vehicle_class_from_name(type.sumo_class);
  request.start_lane = start;
  request.max_lateral_acceleration = type.max_lateral_acceleration;
  request.comfortable_deceleration = type.comfortable_deceleration;
  request.max_speed = type.max_speed;
  request.cornering = {1.1 * type.wheelbase / std::tan(type.max_steering), type.length, type.width,
                       network_.left_hand};
  std::string why;
  if (auto path = build_driving_path(network_, request, why))
    ways.push_back(std::make_shared<const Path>(std::move(*path)));
}

CandidateWays::Ways CandidateWays::make(const AgentType& type, LaneId lane) const {
  const VehicleClassMask mask = vehicle_class_from_name(type.sumo_class);
  Ways ways;
  const auto go_on = [&](LaneId start, EdgeId edge, EdgeId next) {
    std::vector<EdgeId> route = straight_on(next, mask);
    if (std::find(route.begin(), route.end(), edge) != route.end()) route.resize(1);
    route.insert(route.begin(), edge);
    add_way(type, start, std::move(route), ways);
  };
  const Lane& here = network_.lane(lane);
  if (here.kind == LaneKind::Internal) {
    for (const ConnectionId id : over_[index_of(lane)]) {
      const Connection& link = network_.connection(id);
      if ((network_.lane(link.to).allowed & mask) != 0)
        go_on(link.from, network_.lane(link.from).edge, network_.lane(link.to).edge);
    }
    return ways;
  }
  if (here.kind != LaneKind::Normal) return ways;
  std::vector<EdgeId> next;
  for (const LaneId beside : network_.edge(here.edge).lanes) {
    if ((network_.lane(beside).allowed & mask) == 0) continue;
    for (const ConnectionId id : network_.lane(beside).outgoing) {
      const Lane& to = network_.lane(network_.connection(id).to);
      if ((to.allowed & mask) == 0 || to.kind != LaneKind::Normal || to.edge == here.edge) continue;
      if (std::find(next.begin(), next.end(), to.edge) == next.end()) next.push_back(to.edge);
    }
  }
  for (const EdgeId edge : next) go_on(lane, here.edge, edge);
  if (next.empty()) add_way(type, lane, {here.edge}, ways);
  return ways;
}

std::span<const std::shared_ptr<const Path>> CandidateWays::ways(const AgentType& type,
                                                                 AgentTypeId id, LaneId lane) {
  if (lane == kNoLane || type.kinematics != Kinematics::SingleTrack || type.guided) return {};
  const auto key = std::make_pair(lane, id);
  auto found = made_.find(key);
  if (found == made_.end()) found = made_.emplace(key, make(type, lane)).first;
  return found->second;
}

}  // namespace sumogamma
