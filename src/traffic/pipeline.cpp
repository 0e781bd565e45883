#include "traffic/pipeline.h"

#include "model/stopping_guard.h"
#include "scene/locate.h"
#include "traffic/patience.h"
#include "traffic/recovery/detour.h"
#include "traffic/recovery/lost_way.h"
#include "traffic/recovery/reversing.h"
#include "traffic/road_context.h"

namespace sumogamma {

void update_traffic(const Model& model, RoadState& road, Scene& scene, double dt, Workers& workers,
                    TickGeometry& geometry, Traffic& traffic) {
  const TrafficTick tick{model, geometry.grid, workers,       dt,
                         road,  scene,         traffic.state, traffic.approaches};
  match_rows(scene, road, traffic.state);
  workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double before = scene.path_along[row];
      locate_on_path(model.road, road, scene, row);
      note_progress(before, dt, scene, traffic.state, row);
    }
  });
  find_ways_back(tick);
  prepare_tick(model, scene, workers, geometry);
  choose_lanes(tick, traffic.lanes);
  if (model.options.take_detours) traffic.detours += take_detours(tick);
  update_road_contexts(tick);
}

void remember_tick(const Model& model, const RoadState& road, Scene& scene, double dt,
                   Workers& workers, const TickGeometry& geometry, Traffic& traffic) {
  const TrafficView view{model, road, scene, traffic.state, geometry.grid, traffic.approaches};
  for (std::size_t row = 0; row < scene.size(); ++row) {
    count_waiting(dt, type_of(model.types, scene.type[row]).kinematics, scene, traffic.state, row);
    update_held(dt, scene, row);
  }
  update_backing(view, geometry, dt, workers, traffic.backing, traffic.state);
}

}  // namespace sumogamma
