#include "ego/forward_model.h"

#include <utility>

namespace sumogamma {

Fork fork_of(const TrafficView& world, std::vector<std::size_t> rows) {
  Fork fork{world.scene, world.road, {}};
  std::vector<bool> left_out(world.scene.size(), true);
  for (const std::size_t row : rows) left_out[row] = false;
  remove_agents(fork.scene, left_out);
  fork.traffic.parameters = world.parameters;
  fork.traffic.code = world.code;
  fork.traffic.state = world.traffic;
  match_rows(fork.scene, fork.road, fork.traffic.state);
  fork.traffic.waits.rebuild(fork.scene);
  for (std::size_t row = 0; row < fork.scene.size(); ++row) {
    if (fork.scene.control[row] != Control::External) continue;
    fork.scene.control[row] = Control::Gamma;
    if (fork.road.path(fork.scene.path[row]) == nullptr)
      fork.scene.behavior[row].intention.kind = IntentionKind::KeepVelocity;
  }
  return fork;
}

void ForwardModel::follow(const Model& model) {
  if (!model_) {
    model_ = std::make_unique<Model>(model);
    model_->options.step = kStep;
    model_->options.use_guard = false;
  }
  if (model_->types.size() == model.types.size()) return;
  model_->types = model.types;
  model_->kinematics = model.kinematics;
}

void ForwardModel::advance(Fork& fork, bool rules, const PlannedVelocity& planned) {
  advance_rows({*model_, workers_, fork.road, fork.scene, fork.traffic, work_},
               {.dt = kStep, .rules = rules, .lanes = false}, planned);
}

}  // namespace sumogamma
