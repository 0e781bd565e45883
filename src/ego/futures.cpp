#include "ego/futures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "ego/driving_problem.h"
#include "ego/ego_action.h"
#include "scene/extent.h"

namespace sumogamma {

namespace {

constexpr double kHorizon = 4.0;  // [s]

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

Futures sample_futures(const EgoView& view, const FuturesRequest& request,
                       const WayBeliefs& beliefs, ForwardModel& forward) {
  const Scene& scene = view.world.scene;
  forward.follow(view.world.model);
  std::vector<std::size_t> seen = rows_seen(view);
  seen.insert(seen.begin(), view.row);
  Futures futures;
  futures.steps = static_cast<std::size_t>(std::lround(kHorizon / ForwardModel::kStep));
  for (const std::size_t row : seen) futures.agents.push_back(scene.id[row].value);
  const PlanRoot root = plan_root(view, beliefs, request.knows, 0);
  Fork fork = root.fork;
  std::vector<std::size_t> rows;  // of the fork, in the order of `agents`
  for (const std::uint32_t id : futures.agents) rows.push_back(find_row(fork.scene, AgentId{id}));
  DrivingState state;
  const auto samples = static_cast<std::uint32_t>(request.samples);
  const std::uint64_t key = random_bits(request.key, 0, 0, Draw::Futures);
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    draw_scenario(forward.model(), root, key, sample, samples, state);
    fork.scene = state.scene;
    fork.road = state.road;
    fork.traffic.state = state.traffic;
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
