#include "traffic/junction/approaches.h"

#include <algorithm>

#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// Is the next link of a row, on wheels, one with the right of way?
bool comes_with_right_of_way(const Model& model, const RoadState& road, const Scene& scene,
                             std::size_t row) {
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr || path->walking) return false;
  const auto link = path->link_from(scene.path_along[row]);
  if (link == path->links.end()) return false;
  const Connection& connection = model.road.connection(link->connection);
  return has_right_of_way(connection, road.signal(connection));
}

}  // namespace

ConnectionId halt_counts_for(const RoadNetwork& road, const Path& path, const PathLink& link,
                             double length) {
  ConnectionId counts = link.connection;
  if (road.connection(link.connection).signal != kNoSignal) return counts;
  double clear = link.end;
  for (auto next = path.link_after(link.stop_line); next != path.links.end(); ++next) {
    if (next->halt - length > clear) break;
    clear = next->end;
    const Connection& connection = road.connection(next->connection);
    if (connection.signal != kNoSignal) break;
    if (halts_first(connection.priority)) counts = next->connection;
  }
  return counts;
}

void ApproachTable::note_waiting(const TrafficView& view) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  waiting_.resize(scene.size());
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const RoadContext& context = scene.context[row];
    // who is on foot shuffles before what shuts its way, and never stands for long
    const bool shuffles =
        type_of(model.types, scene.type[row]).kinematics == Kinematics::Holonomic &&
        context.reason == LimitReason::None && waited(view, row) >= Patience::Pressing;
    waiting_[row] = {context.reason,          context.foe,
                     traffic.halted_for[row], traffic.halted_at[row],
                     context.to_halt,         shuffles || blocked(view, row) >= Patience::Waiting};
  }
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (waiting_[row].reason != LimitReason::Yield || stood(view, row) < Patience::Waiting)
      continue;
    if (!comes_with_right_of_way(model, road, scene, row)) continue;
    // whoever that one stands behind holds it up, too
    std::size_t foe = view.waits.foe(row);
    while (foe < scene.size() && !waiting_[foe].holds_up) {
      waiting_[foe].holds_up = true;
      if (waiting_[foe].reason != LimitReason::Leader) break;
      foe = view.waits.foe(foe);
    }
  }
}

void ApproachTable::rebuild(const TrafficView& view) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  note_waiting(view);
  for (const Approach& approach : approaches_) ranges_[index_of(approach.connection)] = {};
  ranges_.resize(model.road.connections.size());
  approaches_.clear();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr || path->links.empty()) continue;
    const EgoOnPath& ego = view.perception.ego[row];
    const double along = ego.along, half_length = ego.half_length;
    const double speed = std::max(0.0, scene.velocity[row].dot(ego.tangent));
    const bool wide = 2.0 * ego.half_width > kWideBody;
    // far enough for the slowest foe to find its gap: ten seconds at the present speed
    const double reach = std::max(path->walking ? 8.0 : 30.0, 10.0 * speed);
    const ConnectionId halted_for = view.traffic.halted_for[row];
    auto link = path->link_from(along - half_length);
    for (; link != path->links.end() && link->stop_line < along + half_length + reach; ++link) {
      const bool has_halted =
          halted_for != kNoConnection &&
          halt_counts_for(model.road, *path, *link, 2.0 * half_length) == halted_for;
      approaches_.push_back({link->connection, static_cast<std::uint32_t>(row),
                             along + half_length - link->stop_line, 2.0 * half_length, speed,
                             speed < view.parameters.halting_speed, wide, has_halted,
                             static_cast<std::uint32_t>(link - path->links.begin())});
    }
  }
  std::sort(approaches_.begin(), approaches_.end(), [](const Approach& a, const Approach& b) {
    if (a.connection != b.connection) return a.connection < b.connection;
    return a.front != b.front ? a.front > b.front : a.row < b.row;
  });
  for (std::size_t i = 0; i < approaches_.size(); ++i) {
    Range& range = ranges_[index_of(approaches_[i].connection)];
    if (range.begin == range.end) range.begin = static_cast<std::uint32_t>(i);
    range.end = static_cast<std::uint32_t>(i + 1);
  }
}

std::span<const Approach> ApproachTable::of(ConnectionId id) const {
  if (id == kNoConnection || index_of(id) >= ranges_.size()) return {};
  const Range range = ranges_[index_of(id)];
  return std::span<const Approach>(approaches_).subspan(range.begin, range.end - range.begin);
}

}  // namespace sumogamma
