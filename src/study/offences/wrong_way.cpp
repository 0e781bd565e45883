#include <algorithm>

#include "base/units.h"
#include "scene/extent.h"
#include "study/offences/ground.h"
#include "traffic/lateral/passing.h"

namespace sumogamma {

namespace {

constexpr double kMoving = 0.5;   // [m/s]
constexpr double kBeside = 20.0;  // from middle to middle [m]
constexpr double kSoon = 4.0;     // [s]
constexpr double kFaster = 1.0;   // [m/s]

/// Does a vehicle on a lane that leads the other way get past somebody narrow?
bool overtakes(const RuleView& view, std::size_t subject, const LaneHit& hit) {
  const RoadNetwork& network = view.roads.network;
  const LaneId own = network.lane(hit.lane).opposite;
  if (own == kNoLane) return false;
  const Lane& lane = network.lane(own);
  const Scene& scene = view.scene;
  const Vec2& velocity = scene.velocity[subject];
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Vec2& position = scene.position[row];
    const Vec2 way = position - scene.position[subject];
    // who is ahead is overtaken while the agent closes up, too
    const double closes = kSoon * (scene.speed[subject] - scene.speed[row]);
    const double reach = way.dot(velocity) > 0.0 ? std::max(kBeside, closes) : kBeside;
    if (row == subject || way.norm() > reach) continue;
    const Vec2 forward = direction_of(scene.heading[row]);
    if (!is_narrow(2.0 * half_extent(scene, row, left_of(forward))) ||
        forward.dot(hit.direction) > -0.5 || scene.speed[row] > scene.speed[subject] + kFaster)
      continue;
    if (lane.centerline.project(position).distance < 0.5 * lane.width) return true;
  }
  return false;
}

}  // namespace

std::optional<Finding> goes_wrong_way(const RuleView& view, std::size_t row, const Place& here,
                                      RuleWork& work) {
  const Vec2& velocity = view.scene.velocity[row];
  const bool drives =
      velocity.norm() > kMoving && velocity.dot(direction_of(view.scene.heading[row])) > 0.0;
  if (!here.against || !drives ||
      !holds_beside(view, row, work, [](const Place& place) { return place.against.has_value(); }))
    return {};
  return overtakes(view, row, *here.against) ? Finding::Overtaking : Finding::WrongWay;
}

}  // namespace sumogamma
