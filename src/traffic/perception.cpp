#include "traffic/perception.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/extent.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// Adds somebody who is within `aside` of the row's path.
void add_user(const TrafficView& view, const Path& path, std::size_t other, double reach,
              double aside, Surroundings& around) {
  const Scene& scene = view.scene;
  const double from = around.along - reach, to = around.along + reach;
  const double farthest = aside + scene.footprint[other].radius;
  PolylinePosition place = path.line.project_near(scene.position[other], from, to, farthest);
  if (place.distance > farthest) {
    // far aside, unless it is behind the path's begin
    if (path.line.segment_at(from) > 0) return;
    place = path.line.project(scene.position[other], from, to);
    if (place.along > 0.0) return;
  }
  const Vec2 direction = path.line.direction_at(place.along);
  const Vec2 from_line = scene.position[other] - path.line.point_at(place.along);
  // a path may begin close behind its agent: who is further back is there straight on
  const double beyond = place.along <= 0.0 ? std::min(direction.dot(from_line), 0.0) : 0.0;
  const double offset = beyond < 0.0 ? cross(direction, from_line) : place.offset;
  if (std::abs(offset) > farthest) return;
  const double half_length = half_extent(view.scene, other, direction);
  const double middle = place.along + beyond;
  around.users.push_back(
      {middle - half_length, middle + half_length, offset,
       half_extent(view.scene, other, left_of(direction)), scene.velocity[other].dot(direction),
       direction.dot(direction_of(view.scene.heading[other])) > 0.5,
       type_of(view.model.types, scene.type[other]).kinematics == Kinematics::Holonomic,
       static_cast<std::uint32_t>(other)});
}

}  // namespace

void perceive(const TrafficView& view, std::size_t row, double reach, Perception& perception) {
  perception.ego[row] = ego_on_path(view.road, view.scene, row);
  perception.reach[row] = reach;
  std::vector<std::uint32_t>& near = perception.near[row];
  near.clear();
  visit_storey(view, row, view.scene.position[row], reach,
               [&](std::size_t other) { near.push_back(static_cast<std::uint32_t>(other)); });
}

bool is_its_turn(const TrafficView& view, std::size_t row, double dt) {
  const auto period = std::max<std::int64_t>(1, std::llround(view.parameters.look_period / dt));
  return (view.scene.tick + view.scene.id[row].value) % period == 0;
}

Replan replan(const TrafficTick& tick, std::size_t row) {
  return {tick.model.road, *tick.road.path(tick.scene.path[row]), tick.scene.path_along[row],
          tick.parameters.nearby};
}

void go_on_by(const TrafficTick& tick, Replanned way, std::size_t row) {
  change_path(std::move(way.path), way.along, row, tick.road, tick.scene, tick.traffic);
  tick.perception.ego[row] = ego_on_path(tick.road, tick.scene, row);
}

void look_around(const TrafficView& view, std::size_t row, double reach, double aside,
                 Surroundings& around) {
  const Path& path = *view.road.path(view.scene.path[row]);
  static_cast<EgoOnPath&>(around) = view.perception.ego[row];
  around.users.clear();
  visit_near(view, row, reach,
             [&](std::size_t other) { add_user(view, path, other, reach, aside, around); });
  std::sort(around.users.begin(), around.users.end(),
            [](const PathUser& a, const PathUser& b) { return a.row < b.row; });
}

void look_at_walls(const TrafficView& view, const Path& path, std::size_t row, double reach,
                   double aside, Surroundings& around) {
  around.walls.clear();
  if (view.model.obstacles.empty()) return;
  view.model.obstacles.find_near(view.scene.position[row], reach, around.sides);
  for (const std::uint32_t index : around.sides) {
    const ObstacleIndex::Side& side = view.model.obstacles.side(index);
    const Vec2 whole = side.to - side.from;
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(whole.norm() / view.parameters.sampling_step)));
    PolylinePosition last;
    for (int k = 0; k <= pieces; ++k) {
      const Vec2 point = side.from + (static_cast<double>(k) / pieces) * whole;
      const PolylinePosition place =
          path.line.project(point, around.along - reach, around.along + reach);
      if (k > 0 && std::min(place.distance, last.distance) < aside)
        around.walls.push_back(
            {std::min(place.along, last.along), std::max(place.along, last.along),
             0.5 * (place.offset + last.offset), 0.5 * std::abs(place.offset - last.offset)});
      last = place;
    }
  }
}

void look_at_red_crossings(const TrafficView& view, const Path& path, std::size_t row,
                           Surroundings& around) {
  const RoadContext& context = view.scene.context[row];
  if (waited(view, row) < Patience::Impatient || context.reason == LimitReason::Signal) return;
  for (const Vec2& way : context.to_red) {
    if (way.isZero()) continue;
    const Vec2 onto = way.normalized();
    const Vec2 tip = view.scene.position[row] + way + half_extent(view.scene, row, onto) * onto;
    const PolylinePosition place = path.line.project(tip, around.along - view.parameters.near,
                                                     around.along + view.parameters.near);
    around.walls.push_back({place.along - 0.5 * view.parameters.sampling_step,
                            place.along + 0.5 * view.parameters.sampling_step, place.offset,
                            0.5 * view.parameters.sampling_step});
  }
}

double hoped_speed(const TrafficParameters& parameters, const Surroundings& around, double offset,
                   double free_speed, double margin) {
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  double hoped = free_speed;
  for (const PathUser& user : around.users) {
    if (user.front < rear - 0.3) continue;
    if (std::abs(user.offset - offset) > user.half_width + around.half_width + margin) continue;
    const double gap = user.rear - front;
    if (gap < 0.0) return -1.0;
    hoped = std::min(hoped, std::max(user.speed + gap / parameters.outlook, 0.0));
  }
  return hoped;
}

}  // namespace sumogamma
