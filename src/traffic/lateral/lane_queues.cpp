#include "traffic/lateral/lane_queues.h"

#include "scene/extent.h"

namespace sumogamma {

void measure_queues(const TrafficParameters& parameters, const Model& model, const RoadState& road,
                    const Scene& scene, LaneQueues& queues) {
  queues.assign(model.road.lanes.size(), 0.0);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr || path->walking || scene.speed[row] > parameters.queue_speed) continue;
    const AgentType& type = type_of(model.types, scene.type[row]);
    const double along = scene.path_along[row];
    queues[index_of(path->stretch_at(along).lane)] +=
        2.0 * half_extent(scene, row, path->line.direction_at(along)) + type.min_gap;
  }
}

double queue_ahead(const LaneQueues& queues, const Path& path, double along, double reach) {
  double length = 0.0;
  LaneId last = kNoLane;
  for (const PathStretch& stretch : path.stretches) {
    if (stretch.from > along + reach) break;
    if (stretch.to < along || stretch.lane == last) continue;
    last = stretch.lane;
    length += queues[index_of(stretch.lane)];
  }
  return length;
}

bool is_full(const LaneQueues& queues, const Lane& lane, LaneId id, double length) {
  return queues[index_of(id)] + length > lane.length;
}

}  // namespace sumogamma
