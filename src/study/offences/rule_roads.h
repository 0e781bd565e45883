#pragma once

#include "road/road_network.h"
#include "scene/storey.h"
#include "study/offences/judges.h"

namespace sumogamma {

/// May vehicles, bicycles among them, drive on a lane?
bool for_vehicles(const Lane& lane);

/// All lanes for which wanted(LaneId) holds that contain the point, in order of id, into `hits`
/// (cleared first), but those on another storey than the agent's own.
template <typename Wanted>
void find_lanes(const RuleView& view, std::size_t row, const Vec2& point, Wanted&& wanted,
                std::vector<LaneHit>& hits) {
  const RoadNetwork& network = view.roads.network;
  view.roads.locator.find_containing(point, wanted, hits);
  const LanePosition& own = view.scene.lane[row];
  if (!view.roads.has_storeys || own.lane == kNoLane || hits.empty()) return;
  const auto ground_at = [&](LaneId lane, double along) {
    return Ground{lane, along, elevation_at(network.lane(lane), along)};
  };
  const Ground ground = ground_at(own.lane, own.along);
  std::erase_if(hits, [&](const LaneHit& hit) {
    return on_other_storey(network, ground, ground_at(hit.lane, hit.along));
  });
}

/// Did a link show red before and after the tick?
inline bool was_and_is_red(const RuleView& view, ConnectionId link) {
  const Connection& connection = view.roads.network.connection(link);
  return is_red(view.before.signal(connection)) && is_red(view.road.signal(connection));
}

}  // namespace sumogamma
