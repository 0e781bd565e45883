#include "osm/repairs/backward_turns.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/units.h"
#include "road/conflict_zones.h"

namespace sumogamma::osm {
namespace {

constexpr double kSharp = radians(95.0);  // a little less than is told, for rounded coordinates
constexpr double kBack = 0.9;             // [m], likewise

bool leads_back(const RoadNetwork& road, ConnectionId id) {
  const Connection& turn = road.connection(id);
  // not is_driven(): a junction that SUMO doesn't rule has turns, too
  if (turn.via == kNoLane || turn.direction == TurnDirection::Turnaround ||
      road.lane(turn.from).kind != LaneKind::Normal || road.lane(turn.to).kind != LaneKind::Normal)
    return false;
  const std::vector<Vec2>&lane = road.lane(turn.from).centerline.points(),
        &way = road.lane(turn.via).centerline.points();
  if (lane.size() < 2 || way.size() < 2) return false;
  const Vec2 ahead = (lane.back() - lane[lane.size() - 2]).normalized();
  const Vec2 begin = (way[1] - way[0]).normalized();
  if (begin.dot(ahead) > std::cos(kSharp)) return false;
  return std::any_of(way.begin(), way.end(),
                     [&](const Vec2& point) { return ahead.dot(point - lane.back()) < -kBack; });
}

/// The classes that may make a turn.
VehicleClassMask classes_of(const RoadNetwork& road, const Connection& turn) {
  return road.lane(turn.from).allowed & road.lane(turn.to).allowed & ~vehicle_class::kPedestrian;
}

/// Does a class get from one edge to another without some of the turns?
bool reaches(const RoadNetwork& road, EdgeId from, EdgeId to, VehicleClassMask vehicle,
             const std::set<ConnectionId>& without) {
  std::set<EdgeId> seen = {from};
  std::vector<EdgeId> next = {from};
  while (!next.empty()) {
    const EdgeId here = next.back();
    next.pop_back();
    for (const LaneId lane : road.edge(here).lanes) {
      if ((road.lane(lane).allowed & vehicle) == 0) continue;
      for (const ConnectionId id : road.lane(lane).outgoing) {
        const Lane& onto = road.lane(road.connection(id).to);
        if (without.contains(id) || (onto.allowed & vehicle) == 0 || onto.kind != LaneKind::Normal)
          continue;
        if (onto.edge == to) return true;
        if (seen.insert(onto.edge).second) next.push_back(onto.edge);
      }
    }
  }
  return false;
}

/// Does a lane lead on for a class without some of the turns? One that doesn't is a trap.
bool leads_on(const RoadNetwork& road, LaneId lane, VehicleClassMask vehicle,
              const std::set<ConnectionId>& without) {
  const std::vector<ConnectionId>& turns = road.lane(lane).outgoing;
  return std::any_of(turns.begin(), turns.end(), [&](ConnectionId id) {
    return !without.contains(id) && is_driven(road, id) &&
           (road.lane(road.connection(id).to).allowed & vehicle) != 0;
  });
}

bool is_dispensable(const RoadNetwork& road, ConnectionId id,
                    const std::set<ConnectionId>& without) {
  const Connection& turn = road.connection(id);
  const EdgeId from = road.lane(turn.from).edge, to = road.lane(turn.to).edge;
  const VehicleClassMask classes = classes_of(road, turn);
  for (VehicleClassMask vehicle = 1; vehicle != 0; vehicle <<= 1)
    if ((classes & vehicle) != 0 && (!leads_on(road, turn.from, vehicle, without) ||
                                     !reaches(road, from, to, vehicle, without)))
      return false;
  return true;
}

}  // namespace

std::vector<ConnectionId> backward_turns(const RoadNetwork& road) {
  std::vector<ConnectionId> turns;
  for (std::size_t i = 0; i < road.connections.size(); ++i)
    if (const auto id = static_cast<ConnectionId>(i); leads_back(road, id)) turns.push_back(id);
  return turns;
}

std::vector<ConnectionId> dispensable_turns(const RoadNetwork& road,
                                            const std::vector<ConnectionId>& turns) {
  std::set<ConnectionId> without;
  for (const ConnectionId id : turns) {
    without.insert(id);
    // what was let go before has to stay without need once this one goes, too
    if (!std::all_of(without.begin(), without.end(),
                     [&](ConnectionId other) { return is_dispensable(road, other, without); }))
      without.erase(id);
  }
  return {without.begin(), without.end()};
}

Turn named_turn(const RoadNetwork& road, ConnectionId turn) {
  const Lane &from = road.lane(road.connection(turn).from),
             &to = road.lane(road.connection(turn).to);
  return {road.edge(from.edge).name, road.edge(to.edge).name, from.index, to.index};
}

}  // namespace sumogamma::osm
