#include "ego/ego_driver.h"

#include <chrono>
#include <cmath>

#include "scene/extent.h"
#include "scene/storey.h"

namespace sumogamma {

bool must_brake_now(const Model& model, const Scene& scene, std::size_t row) {
  constexpr double kMargin = 0.3;  // [m]
  const double speed = scene.speed[row];
  if (speed < 1e-3) return false;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const double way = speed * speed / (2.0 * type.max_deceleration) + kMargin;
  OrientedBox box = box_of(scene, row);
  box.center += 0.5 * way * box.forward;
  box.half += Vec2(0.5 * way, kMargin);
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const Vec2 place = scene.position[other] - scene.position[row];
    if (other == row || place.dot(box.forward) <= 0.0 ||
        place.norm() > box.half.norm() + way + scene.footprint[other].radius ||
        on_other_storey(model.road, scene, row, other))
      continue;
    if (separation(box, box_of(scene, other)) <= 0.0) return true;
  }
  return false;
}

void EgoDriver::plan(const TrafficView& world, std::size_t row) {
  const Scene& scene = world.scene;
  const auto number = static_cast<std::int64_t>(plans_.size());
  PlanTrace trace;
  const EgoView view{world,
                     workers_,
                     row,
                     task_.settings,
                     task_.goal,
                     task_.seed,
                     number,
                     since(),
                     progress_,
                     task_.rules,
                     task_.look_on ? &trace : nullptr};
  const auto start = std::chrono::steady_clock::now();
  EgoAction action = planner_(view);
  if (!action.trajectory.empty())
    action.trajectory.insert(action.trajectory.begin(), {0.0, scene.position[row]});
  times_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  if (task_.look_on) {
    trace.ego = scene.id[row];
    trace.time = scene.time;
    trace.action = action;
    task_.look_on(trace);
  }
  plans_.push_back({number, since(), scene.position[row], scene.heading[row], scene.speed[row],
                    progress_, std::move(action), 0});
  planned_at_ = since();
}

bool EgoDriver::is_due() const {
  constexpr double kRounding = 1e-9;
  return since() >= static_cast<double>(plans_.size()) / task_.settings.rate - kRounding;
}

Vec2 EgoDriver::operator()(const TrafficView& world, std::size_t row) {
  if (is_due()) plan(world, row);
  const double after = since() - planned_at_;
  ++ticks_;
  const ActionPace pace{task_.settings.max_speed, after, task_.step};
  if (task_.settings.emergency_brake && must_brake_now(world.model, world.scene, row)) {
    ++plans_.back().emergency_ticks;
    const EgoAction brake = full_braking(type_of(world.model.types, world.scene.type[row]));
    return velocity_of(brake, world.model, world.scene, row, pace);
  }
  return velocity_of(plans_.back().action, world.model, world.scene, row, pace);
}

}  // namespace sumogamma
