#include "simulation/open_steps.h"

#include "model/stopping_guard.h"

namespace sumogamma {

OpenSteps::OpenSteps(const Model& model, Workers& workers) : model_(model), workers_(workers) {
  workspaces_.resize(workers.count());
}

void OpenSteps::make(std::size_t rows, Scene& scene) {
  const double step = model_.options.step;
  commands_.resize(rows);
  prepare_tick(model_, scene, workers_, geometry_);
  workers_.for_each_range(rows, [&](std::size_t worker, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Vec2 velocity =
          gamma_velocity(model_, scene, geometry_, row, scene.behavior[row], workspaces_[worker]);
      commands_[row] = next_body(model_, scene, row, velocity, step, workspaces_[worker]);
    }
  });
  for (std::size_t row = 0; row < rows; ++row) {
    scene.acceleration[row] = (commands_[row].velocity - scene.velocity[row]) / step;
    place_body(commands_[row], scene, row);
    update_held(step, scene, row);
  }
  ++scene.tick;
  scene.time += step;
}

}  // namespace sumogamma
