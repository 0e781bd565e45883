#include "sumo/waiting_place.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/extent.h"
#include "sumo/ghosts.h"

namespace sumogamma {

namespace {

/// How near a vehicle is [m]; more than `reach` where that is farther off.
double distance_to_vehicles(const Model& model, const Scene& scene, std::size_t row, double reach) {
  double nearest = std::numeric_limits<double>::infinity();
  const OrientedBox own = box_of(scene, row);
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const double apart = (scene.position[other] - own.center).norm();
    if (other == row || apart > reach + own.half.norm() + scene.footprint[other].radius ||
        type_of(model.types, scene.type[other]).kinematics == Kinematics::Holonomic)
      continue;
    nearest = std::min(nearest, separation(own, box_of(scene, other)));
  }
  return nearest;
}

}  // namespace

void step_to_kerb(const Model& model, Scene& scene, std::size_t row, double dt) {
  constexpr double kPace = 0.5;               // [m/s]
  constexpr double kEdge = 0.05;              // kept from the lane's border [m]
  constexpr double kThere = 0.01;             // [m]
  constexpr double kShy = 0.5, kAgain = 0.7;  // to vehicles: steps back, comes forward again [m]
  scene.velocity[row] = Vec2::Zero();
  scene.speed[row] = 0.0;
  const LaneId id = scene.lane[row].lane;
  if (id == kNoLane) return;
  const Lane& lane = model.road.lane(id);
  if (lane.kind != LaneKind::Normal || !is_without_motors(lane)) return;
  const double vehicle = distance_to_vehicles(model, scene, row, kAgain);
  if (vehicle >= kShy && vehicle < kAgain) return;
  const Vec2 before = scene.position[row];
  const PolylinePosition place = lane.centerline.project(before);
  const Vec2 forward = lane.centerline.direction_at(place.along), left = left_of(forward);
  const double kerb = lane.inner == kNoLane ? -1.0 : model.road.left_hand ? -1.0 : 1.0;
  const double side = vehicle < kShy ? -kerb : kerb;
  const double room = 0.5 * lane.width - half_extent(scene, row, left) - kEdge;
  const double wanted = side * std::max(room, 0.0) - place.offset;
  if (std::abs(wanted) < kThere || std::abs(place.offset) > 0.5 * lane.width) return;
  const double step = std::min(kPace * dt, std::abs(wanted));
  for (const Vec2& way : {Vec2(std::copysign(step, wanted) * left), Vec2(-step * forward)}) {
    const double along = place.along + way.dot(forward);
    if (along < 0.0) continue;
    scene.position[row] = before + way;
    if (!touches(scene, row)) {
      scene.velocity[row] = way / dt;
      scene.speed[row] = way.norm() / dt;
      return;
    }
    scene.position[row] = before;
  }
}

}  // namespace sumogamma
