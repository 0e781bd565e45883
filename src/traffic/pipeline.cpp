#include "traffic/pipeline.h"

#include "model/stopping_guard.h"
#include "scene/locate.h"
#include "traffic/patience.h"
#include "traffic/recovery/detour.h"
#include "traffic/recovery/lost_way.h"
#include "traffic/recovery/reversing.h"
#include "traffic/road_context.h"

namespace sumogamma {

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
  choose_lanes(tick, traffic.lanes);
  if (tick.model.options.take_detours) traffic.detours += take_detours(tick);
  update_road_contexts(tick);
}

void remember_tick(const TrafficTick& tick, Traffic& traffic) {
  Scene& scene = tick.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Kinematics kinematics = type_of(tick.model.types, scene.type[row]).kinematics;
    count_waiting(tick.parameters, tick.dt, kinematics, scene, tick.traffic, row);
    update_held(tick.dt, scene, row);
  }
  update_backing(tick.view(), tick.geometry, tick.dt, tick.workers, traffic.backing, tick.traffic);
}

}  // namespace sumogamma
