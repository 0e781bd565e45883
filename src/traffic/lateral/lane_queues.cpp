#include "traffic/lateral/lane_queues.h"

namespace sumogamma {

void measure_queues(const TrafficView& view, LaneQueues& queues) {
  const Scene& scene = view.scene;
  queues.assign(view.model.road.lanes.size(), 0.0);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Path* path = view.road.path(scene.path[row]);
    if (path == nullptr || path->walking || scene.speed[row] > view.parameters.queue_speed)
      continue;
    const EgoOnPath& ego = view.perception.ego[row];
    queues[index_of(path->stretch_at(ego.along).lane)] +=
        2.0 * ego.half_length + type_of(view.model.types, scene.type[row]).min_gap;
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
