#include "study/offences/rule_roads.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr VehicleClassMask kRoadVehicle = vehicle_class::kMotor | vehicle_class::kBicycle;

bool is_signalled(const RoadNetwork& network, ConnectionId id) {
  return network.connection(id).signal != kNoSignal;
}

/// RuleRoads::by_signal: the lanes beside one with signals, those before and behind them.
std::vector<bool> lanes_by_signals(const RoadNetwork& network) {
  std::vector<bool> edges(network.edges.size(), false), lanes(network.lanes.size(), false);
  const auto mark = [&](LaneId lane) { edges[index_of(network.lane(lane).edge)] = true; };
  for (const Lane& lane : network.lanes) {
    if (std::none_of(lane.outgoing.begin(), lane.outgoing.end(),
                     [&](ConnectionId id) { return is_signalled(network, id); }))
      continue;
    for (const LaneId beside : network.edge(lane.edge).lanes) {
      mark(beside);
      for (const ConnectionId link : network.lane(beside).incoming)
        lanes[index_of(network.connection(link).from)] = true;
    }
    for (const ConnectionId link : lane.outgoing) {
      mark(network.connection(link).to);
      if (network.connection(link).via != kNoLane) mark(network.connection(link).via);
    }
  }
  for (std::size_t i = 0; i < lanes.size(); ++i)
    if (edges[index_of(network.lanes[i].edge)]) lanes[i] = true;
  return lanes;
}

/// RuleRoads::stop_reach of one lane. A stop line may run askew, so that it is nearer at a lane's
/// side than at its middle.
double reach_of_stop_line(const RoadNetwork& network, const Lane& lane) {
  const bool guarded =
      std::any_of(lane.outgoing.begin(), lane.outgoing.end(), [&](ConnectionId id) {
        return is_signalled(network, id) && for_vehicles(network.lane(network.connection(id).to));
      });
  if (lane.kind != LaneKind::Normal || !for_vehicles(lane) || !guarded) return -1.0;
  double askew = 0;
  for (const double side : {1.0, -1.0}) {
    const LaneId beside = lane_beside(network, lane, side);
    if (beside == kNoLane) continue;
    const Vec2& end = network.lane(beside).centerline.points().back();
    askew = std::max(askew, (end - lane.centerline.points().back()).norm());
  }
  return kMeetsWithin + askew;
}

}  // namespace

bool for_vehicles(const Lane& lane) {
  return lane.kind != LaneKind::WalkingArea && lane.kind != LaneKind::Crossing &&
         (lane.allowed & kRoadVehicle);
}

RuleRoads::RuleRoads(const RoadNetwork& roads, const LaneLocator& places, const TrafficCode& law)
    : network(roads),
      locator(places),
      code(law),
      has_storeys(sumogamma::has_storeys(roads)),
      stop_reach(roads.lanes.size(), -1.0),
      by_signal(lanes_by_signals(roads)) {
  for (std::size_t i = 0; i < roads.lanes.size(); ++i)
    stop_reach[i] = reach_of_stop_line(roads, roads.lanes[i]);
}

}  // namespace sumogamma
