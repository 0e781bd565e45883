#include <algorithm>

#include "base/units.h"
#include "study/offences/ground.h"
#include "study/offences/rule_roads.h"

namespace sumogamma {

namespace {

/// Is a point that is on no lane and no junction between two pieces of road?
bool in_gap(const RuleView& view, std::size_t row, const Vec2& point, RuleWork& work) {
  constexpr double kGap = 0.5;  // [m]
  const auto is_road = [&](const Vec2& place) {
    if (view.roads.locator.on_junction(place)) return true;
    find_lanes(
        view, row, place, [&](LaneId lane) { return for_vehicles(view.roads.network.lane(lane)); },
        work.hits);
    return !work.hits.empty();
  };
  // along, across and both diagonals of the agent
  constexpr int kAxes = 4;
  for (int k = 0; k < kAxes; ++k) {
    const Vec2 reach = kGap * direction_of(view.scene.heading[row] + k * kPi / kAxes);
    if (is_road(point + reach) && is_road(point - reach)) return true;
  }
  return false;
}

}  // namespace

std::optional<Finding> is_off_road(const RuleView& view, std::size_t row, const Place& here,
                                   RuleWork& work) {
  if (!here.none || here.junction || in_gap(view, row, view.scene.position[row], work)) return {};
  return Finding::OffRoad;
}

}  // namespace sumogamma
