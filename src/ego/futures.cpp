#include "ego/futures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "ego/ego_action.h"
#include "scene/behavior_draw.h"
#include "scene/extent.h"

namespace sumogamma {

namespace {

constexpr double kHorizon = 4.0;  // [s]

/// Everybody but the ego as one of the many that it might be.
void draw_hidden(const Model& model, AgentId ego, std::uint64_t key, Scene& scene) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.id[row] == ego) continue;
    const AgentType& type = type_of(model.types, scene.type[row]);
    const IntentionKind intention = scene.behavior[row].intention.kind;
    const double offset = scene.manners[row].path_offset;
    scene.behavior[row] = draw_behavior(type, key, scene.id[row].value);
    scene.behavior[row].intention.kind = intention;
    scene.manners[row] = draw_manners(type.compliance, key, scene.id[row].value);
    scene.manners[row].path_offset = offset;
    scene.preferred_speed[row] = std::max(scene.preferred_speed[row], scene.speed[row]);
  }
}

double acceleration_at(const std::vector<double>& plan, double rate, double time) {
  if (plan.empty()) return 0.0;
  const auto period = static_cast<std::size_t>(std::max(time * rate + 1e-6, 0.0));
  return plan[std::min(period, plan.size() - 1)];
}

void append_state(const Scene& scene, const std::vector<std::size_t>& rows, Futures& futures) {
  const OrientedBox ego = box_of(scene, rows.front());
  double gap = std::numeric_limits<double>::infinity();
  for (const std::size_t row : rows) {
    futures.poses.push_back({scene.position[row], scene.heading[row], scene.speed[row]});
    if (row != rows.front()) gap = std::min(gap, distance(ego, box_of(scene, row)));
  }
  futures.gap.push_back(gap);
}

}  // namespace

Futures sample_futures(const EgoView& view, const FuturesRequest& request, ForwardModel& forward) {
  const Scene& scene = view.world.scene;
  forward.follow(view.world.model);
  std::vector<std::size_t> seen = rows_about(view.world.model, scene, view.row, kSeen, kAgentsSeen);
  seen.insert(seen.begin(), view.row);
  Futures futures;
  futures.steps = static_cast<std::size_t>(std::lround(kHorizon / ForwardModel::kStep));
  for (const std::size_t row : seen) futures.agents.push_back(scene.id[row].value);
  Fork root = fork_of(view.world, seen);
  root.scene.control[find_row(root.scene, scene.id[view.row])] = Control::Planned;
  std::vector<std::size_t> rows;  // of the fork, in the order of `agents`
  for (const std::uint32_t id : futures.agents) rows.push_back(find_row(root.scene, AgentId{id}));
  Fork fork;
  for (int sample = 0; sample < request.samples; ++sample) {
    fork = root;
    const std::uint64_t key =
        random_bits(request.key, static_cast<std::uint64_t>(sample), 0, Draw::Futures);
    draw_hidden(forward.model(), scene.id[view.row], key, fork.scene);
    for (std::size_t step = 0; step < futures.steps; ++step) {
      const double time = static_cast<double>(step) * ForwardModel::kStep;
      EgoAction action;
      action.acceleration = acceleration_at(request.plan, view.settings.rate, time);
      forward.advance(fork, view.rules, [&](const TrafficView& world, std::size_t row) {
        return velocity_of(action, world.model, world.scene, row,
                           {view.settings.max_speed, 0.0, ForwardModel::kStep});
      });
      append_state(fork.scene, rows, futures);
    }
  }
  return futures;
}

}  // namespace sumogamma
