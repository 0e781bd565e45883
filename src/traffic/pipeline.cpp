#include "traffic/pipeline.h"

#include <algorithm>

#include "model/stopping_guard.h"
#include "scene/locate.h"
#include "traffic/longitudinal/stop_points.h"
#include "traffic/patience.h"
#include "traffic/perception.h"
#include "traffic/recovery/detour.h"
#include "traffic/recovery/lost_way.h"
#include "traffic/recovery/reversing.h"
#include "traffic/road_context.h"

namespace sumogamma {

namespace {

/// How far the rules of a row look at this tick, but for those that look far now and then [m]. Who
/// backs out needs to know of everybody about the place to which it rolls, too.
double reach_of(const TrafficTick& tick, const TrafficView& view, std::size_t row) {
  const Path* path = view.road.path(view.scene.path[row]);
  const double around = outlook(view, row, tick.dt);
  if (path != nullptr && path->walking) return std::max(around, view.parameters.near);
  const AgentType& type = type_of(view.model.types, view.scene.type[row]);
  return std::max(
      {around, driver_reach(type, view.scene.speed[row]),
       tick.geometry.agent[row].radius + kFarthestCorner + 2.0 * view.parameters.least_gap});
}

void perceive_all(const TrafficTick& tick) {
  const TrafficView view = tick.view();
  tick.perception.resize(view.scene.size());
  tick.workers.for_each_range(view.scene.size(),
                              [&](std::size_t, std::size_t begin, std::size_t end) {
                                for (std::size_t row = begin; row < end; ++row)
                                  perceive(view, row, reach_of(tick, view, row), tick.perception);
                              });
}

}  // namespace

void update_traffic(const TrafficTick& tick, Traffic& traffic) {
  Scene& scene = tick.scene;
  match_rows(scene, tick.road, tick.traffic);
  tick.workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double before = scene.path_along[row];
      locate_on_path(tick.model.road, tick.road, scene, row);
      note_progress(tick.parameters, before, tick.dt, scene, tick.traffic, row);
    }
  });
  find_ways_back(tick);
  prepare_tick(tick.model, scene, tick.workers, tick.geometry);
  perceive_all(tick);
  if (tick.lanes) choose_lanes(tick, traffic.lanes);
  if (tick.lanes && tick.model.options.take_detours) traffic.detours += take_detours(tick);
  update_road_contexts(tick);
}

void remember_tick(const TrafficTick& tick, Traffic& traffic) {
  Scene& scene = tick.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Kinematics kinematics = type_of(tick.model.types, scene.type[row]).kinematics;
    count_waiting(tick.parameters, tick.dt, kinematics, scene, tick.traffic, row);
    update_held(tick.dt, scene, row);
  }
  tick.waits.rebuild(scene);
  update_backing(tick.view(), tick.geometry, tick.dt, tick.workers, traffic.backing, tick.traffic);
}

}  // namespace sumogamma
