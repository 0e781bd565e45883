#include "ego/plan_trace.h"

#include <algorithm>
#include <cmath>

#include "ego/driving_problem.h"
#include "ego/futures.h"
#include "geometry/simplify.h"

namespace sumogamma {

namespace {

/// Off by no more than a picture shows.
std::vector<Vec2> simplified(const std::vector<Vec2>& line) {
  constexpr double kTolerance = 0.1;  // [m]
  const std::vector<bool> needed = needed_points(line, kTolerance);
  std::vector<Vec2> kept;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (needed[i]) kept.push_back(line[i]);
  return kept;
}

std::vector<Vec2> line_of(const AgentType& type, const PlanRoot& root, std::size_t row,
                          const PlanRoot::Choice& choice, double horizon) {
  constexpr double kPiece = 0.5;  // [m]
  const Scene& scene = root.fork.scene;
  const Vec2& here = scene.position[row];
  std::vector<Vec2> line{here};
  if (const Path* path = root.fork.road.path(choice.path)) {
    const double faster = scene.speed[row] + 0.5 * type.max_acceleration * horizon;
    const double reach = horizon * std::min(faster, scene.preferred_speed[row]);
    const double along = path->line.project(here).along;
    const auto pieces = static_cast<int>(std::ceil(reach / kPiece));
    for (int k = 1; k <= pieces; ++k)
      line.push_back(path->line.point_at(along + reach * k / pieces));
    line = simplified(line);
  } else if (choice.intention.kind == IntentionKind::Velocity) {
    line.push_back(here + horizon * choice.intention.goal);
  }
  return line;
}

}  // namespace

void trace_beliefs(const AgentTypeTable& types, const PlanRoot& root, double horizon,
                   PlanTrace& trace) {
  const Scene& scene = root.fork.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (root.choices[row].empty()) continue;
    PlanTrace::Belief& belief = trace.beliefs.emplace_back();
    belief.id = scene.id[row];
    const AgentType& type = type_of(types, scene.type[row]);
    for (const PlanRoot::Choice& choice : root.choices[row])
      belief.ways.push_back({choice.weight, line_of(type, root, row, choice, horizon)});
  }
}

void trace_scenarios(const PlanRoot& root, std::uint64_t key, std::uint32_t count,
                     PlanTrace& trace) {
  trace.scenarios.resize(count);
  for (std::size_t row = 0; row < root.choices.size(); ++row) {
    if (root.choices[row].empty()) continue;
    for (std::uint32_t index = 0; index < count; ++index) {
      const std::size_t way = draw_choice(root, row, key, index, count);
      trace.scenarios[index].push_back(
          {root.fork.scene.id[row], static_cast<std::int32_t>(way), {}});
    }
  }
}

void trace_futures(const Scene& scene, const Futures& futures, PlanTrace& trace) {
  const auto every = static_cast<std::size_t>(std::lround(1.0 / futures.step));
  const std::size_t agents = futures.agents.size(), size = futures.steps * agents;
  for (std::size_t begin = 0; begin < futures.poses.size(); begin += size) {
    PlanTrace::Scenario& scenario = trace.scenarios.emplace_back();
    for (std::size_t agent = 0; agent < agents; ++agent) {
      const AgentId id{futures.agents[agent]};
      std::vector<Vec2> line{scene.position[find_row(scene, id)]};
      for (std::size_t step = every; step <= futures.steps; step += every)
        line.push_back(futures.poses[begin + (step - 1) * agents + agent].position);
      scenario.push_back({id, -1, std::move(line)});
    }
  }
}

}  // namespace sumogamma
