#include "ego/ego_view.h"

#include <algorithm>
#include <cmath>

#include "scene/extent.h"
#include "scene/storey.h"

namespace sumogamma {

namespace {

VisibleAgent seen(const Scene& scene, std::size_t row) {
  const OrientedBox box = box_of(scene, row);
  return {scene.id[row].value, scene.type[row],    scene.position[row], scene.heading[row],
          scene.velocity[row], 2.0 * box.half.x(), 2.0 * box.half.y()};
}

void look_along(const Path& path, double along, EgoObservation& observation) {
  constexpr double kStep = 2.0;  // [m]
  for (double ahead = 0.0; ahead <= kSeen && along + ahead <= path.line.length(); ahead += kStep) {
    const PathStretch& stretch = path.stretch_at(along + ahead);
    observation.way.push_back({path.line.point_at(along + ahead), ahead, stretch.room_left,
                               stretch.room_right, path.profile_at(along + ahead)});
  }
}

void look_at_light(const Model& model, const RoadState& road, const Path& path, double front,
                   EgoObservation& observation) {
  for (auto link = path.link_after(front); link != path.links.end(); ++link) {
    if (link->stop_line - front > kSeen) return;
    const Light light = road.signal(model.road.connection(link->connection));
    if (light == Light::None) continue;
    observation.light = light;
    observation.to_light = link->stop_line - front;
    return;
  }
}

}  // namespace

bool has_reached(const EgoGoal& goal, const Scene& scene, std::size_t row) {
  constexpr double kAside = 8.0, kBeyond = 15.0;  // [m]
  const Vec2 way = goal.position - scene.position[row];
  const double ahead = way.dot(goal.direction);
  return ahead <= kGoalRadius && ahead > -kBeyond &&
         std::abs(cross(goal.direction, way)) <= kAside &&
         direction_of(scene.heading[row]).dot(goal.direction) > 0.0;
}

std::vector<std::size_t> rows_about(const Model& model, const Scene& scene, std::size_t row,
                                    double reach, std::size_t most) {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const double square = (scene.position[other] - scene.position[row]).squaredNorm();
    if (other == row || square > reach * reach || on_other_storey(model.road, scene, row, other))
      continue;
    found.emplace_back(square, other);
  }
  std::sort(found.begin(), found.end());
  if (found.size() > most) found.resize(most);
  std::vector<std::size_t> rows;
  for (const auto& [square, other] : found) rows.push_back(other);
  return rows;
}

std::vector<std::size_t> rows_seen(const EgoView& view) {
  return rows_about(view.world.model, view.world.scene, view.row, kSeen,
                    static_cast<std::size_t>(view.settings.agents_seen));
}

EgoObservation observe_ego(const Model& model, const RoadState& road, const Scene& scene,
                           std::size_t row, const EgoGoal& goal, double since) {
  EgoObservation observation;
  observation.time = since;
  observation.ego = seen(scene, row);
  observation.speed = scene.speed[row];
  observation.steering = scene.steering[row];
  observation.to_goal = (goal.position - scene.position[row]).norm();
  for (const std::size_t other : rows_about(model, scene, row, kSeen, kAgentsSeen))
    observation.agents.push_back(seen(scene, other));
  if (const Path* path = road.path(scene.path[row])) {
    look_along(*path, scene.path_along[row], observation);
    look_at_light(model, road, *path, scene.path_along[row] + 0.5 * observation.ego.length,
                  observation);
  }
  return observation;
}

}  // namespace sumogamma
