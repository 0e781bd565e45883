#include "traffic/lateral/exit_lane.h"

#include <algorithm>

#include "road/path_builder.h"

namespace sumogamma {

LaneId free_entry(const TrafficView& view, const LaneQueues& queues, const Path& path,
                  const Surroundings& around) {
  const RoadNetwork& network = view.model.road;
  const double front = around.along + around.half_length, length = 2.0 * around.half_length;
  const auto link = path.link_from(around.along);
  if (length > kLongBody || link == path.links.end() ||
      link->stop_line - front > view.parameters.soon_way ||
      link->end - kEntryReach < std::max(front, link->stop_line))
    return kNoLane;
  const Connection& connection = network.connection(link->connection);
  const Light signal = view.road.signal(connection);
  if (link->stop_line > front && (is_red(signal) || is_amber(signal))) return kNoLane;
  const Lane& own = network.lane(connection.to);
  const bool keeps = path.stretch_at(link->end + 0.1).lane == connection.to;
  const auto next = static_cast<std::size_t>(path.stretch_at(around.along).route_index) + 1;
  if (!keeps || !is_full(queues, own, connection.to, length) || next >= path.trip->options.size())
    return kNoLane;
  const auto cost_from = [&](const Lane& lane) {
    return path.trip->options[next][static_cast<std::size_t>(lane.index)].cost;
  };
  for (const LaneId id : {own.inner, own.outer}) {
    if (id == kNoLane) continue;
    const Lane& lane = network.lane(id);
    const bool alone =
        std::all_of(lane.incoming.begin(), lane.incoming.end(), [&](ConnectionId other) {
          const Connection& into = network.connection(other);
          return network.lane(into.from).kind == LaneKind::Internal ||
                 is_red(view.road.signal(into));
        });
    if (alone && !is_full(queues, lane, id, length) && cost_from(lane) <= cost_from(own) + 0.5)
      return id;
  }
  return kNoLane;
}

}  // namespace sumogamma
