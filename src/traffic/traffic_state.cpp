#include "traffic/traffic_state.h"

#include <limits>
#include <utility>

#include "scene/locate.h"

namespace sumogamma {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The one list of the columns besides `id`.
template <typename Visit>
void for_each_column(TrafficState& traffic, Visit&& visit) {
  visit(traffic.path);
  visit(traffic.passing_offset);
  visit(traffic.lateral_aim);
  visit(traffic.overtaking_room);
  visit(traffic.merge_to);
  visit(traffic.gate);
  visit(traffic.keeps_clear);
  visit(traffic.halted_for);
  visit(traffic.halted_at);
  visit(traffic.waiting_time);
  visit(traffic.stood_at);
  visit(traffic.backing_left);
  visit(traffic.gives_way_left);
  visit(traffic.strayed);
}

void begin_row(const Scene& scene, std::size_t row, TrafficState& traffic) {
  traffic.passing_offset[row] = scene.manners[row].path_offset;
  traffic.lateral_aim[row] = scene.manners[row].path_offset;
  traffic.merge_to[row] = kNoLane;
  traffic.gate[row] = kNever;
  traffic.halted_for[row] = kNoConnection;
  traffic.stood_at[row] = -kNever;
}

/// Both lists are in order of id.
void match_ids(const Scene& scene, TrafficState& traffic) {
  if (traffic.id == scene.id) return;
  constexpr auto kNew = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> from(scene.size(), kNew);
  std::size_t old = 0;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    while (old < traffic.size() && traffic.id[old] < scene.id[row]) ++old;
    if (old < traffic.size() && traffic.id[old] == scene.id[row]) from[row] = old;
  }
  for_each_column(traffic, [&](auto& column) {
    std::remove_reference_t<decltype(column)> next(scene.size());
    for (std::size_t row = 0; row < next.size(); ++row)
      if (from[row] != kNew) next[row] = std::move(column[from[row]]);
    column = std::move(next);
  });
  traffic.id = scene.id;
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (from[row] == kNew) begin_row(scene, row, traffic);
}

}  // namespace

void match_rows(const Scene& scene, const RoadState& road, TrafficState& traffic) {
  match_ids(scene, traffic);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (road.path(scene.path[row]) == traffic.path[row].get()) continue;
    traffic.path[row] = scene.path[row] == kNoPath
                            ? nullptr
                            : road.paths[static_cast<std::size_t>(scene.path[row])];
    traffic.gate[row] = kNever;
  }
}

void change_path(Path path, double along, std::size_t row, RoadState& road, Scene& scene,
                 TrafficState& traffic) {
  take_path(std::move(path), along, row, road, scene);
  traffic.path[row] = road.paths[static_cast<std::size_t>(scene.path[row])];
  traffic.gate[row] = kNever;
}

}  // namespace sumogamma
