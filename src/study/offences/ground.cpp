#include "study/offences/ground.h"

#include "base/units.h"
#include "study/offences/rule_roads.h"

namespace sumogamma {

namespace {

using GroundRule = std::optional<Finding> (*)(const RuleView&, std::size_t row, const Place& here,
                                              RuleWork&);
constexpr GroundRule kOnGround[] = {is_off_road, goes_wrong_way, is_on_sidewalk};

/// Does an agent drive on its own lane, the way that it leads? Nothing else of the place matters
/// to it then.
bool keeps_its_lane(const RuleView& view, std::size_t row) {
  constexpr double kMoved = 20.0;  // since its place on the lane was found [m]
  const LanePosition& own = view.scene.lane[row];
  if (own.lane == kNoLane) return false;
  const Lane& lane = view.roads.network.lane(own.lane);
  if (!for_vehicles(lane) || !(lane.allowed & vehicle_class::kMotor)) return false;
  const PolylinePosition place =
      lane.centerline.project(view.scene.position[row], own.along - kMoved, own.along + kMoved);
  return place.along > 0.0 && place.along < lane.centerline.length() &&
         place.distance <= 0.5 * lane.width &&
         view.scene.velocity[row].dot(lane.centerline.direction_at(place.along)) >= 0.0;
}

}  // namespace

Place place_at(const RuleView& view, std::size_t row, const Vec2& point, RuleWork& work) {
  find_lanes(
      view, row, point, [](LaneId) { return true; }, work.hits);
  Place place;
  place.none = work.hits.empty();
  place.junction = view.roads.locator.on_junction(point);
  const Vec2& velocity = view.scene.velocity[row];
  const double limit = -0.5 * velocity.norm();  // cos 120 degrees
  bool on_road = false, on_walkway = false, explained = place.junction;
  for (const LaneHit& hit : work.hits) {
    const Lane& lane = view.roads.network.lane(hit.lane);
    if (for_vehicles(lane)) {
      on_road = on_road || (lane.allowed & vehicle_class::kMotor);
      if (velocity.dot(hit.direction) >= limit)
        explained = true;
      else if (lane.kind == LaneKind::Normal)
        place.against = hit;
    }
    const bool beside_road = lane.kind == LaneKind::Normal || lane.kind == LaneKind::WalkingArea;
    if ((lane.allowed & vehicle_class::kPedestrian) && !(lane.allowed & vehicle_class::kMotor) &&
        beside_road)
      on_walkway = true;
  }
  if (explained) place.against.reset();
  place.walkway = on_walkway && !on_road;
  return place;
}

void judge_ground(const RuleView& view, std::size_t row, RuleMemory&, RuleWork& work) {
  if (keeps_its_lane(view, row)) return;
  const Place here = place_at(view, row, view.scene.position[row], work);
  for (const GroundRule rule : kOnGround)
    if (const auto what = rule(view, row, here, work))
      work.found.push_back({.row = static_cast<std::uint32_t>(row), .what = *what});
}

}  // namespace sumogamma
