#include "app/inspector.h"

#include <spdlog/spdlog.h>

#include "sumo/control_choice.h"

namespace sumogamma {

std::span<const InspectedAgent> Inspector::spaces() {
  const Scene& scene = sim_.scene;
  if (!plan_.inspect || planes_ > kMostPlanes) return {};
  if (tick_ != scene.tick) {
    tick_ = scene.tick;
    count_ = 0;
    for (std::size_t row = 0; row < scene.size(); ++row)
      if (scene.control[row] == Control::Gamma && is_wanted(row)) look_at(row);
    count_planes();
  }
  return {agents_.data(), count_};
}

bool Inspector::is_wanted(std::size_t row) {
  const Scene& scene = sim_.scene;
  const std::size_t id = scene.id[row].value;
  if (id >= wanted_.size()) wanted_.resize(id + 1, -1);
  if (wanted_[id] < 0) {
    const std::string& type =
        type_of(sim_.model.types, kind_of(sim_.model.types, scene.type[row])).name;
    wanted_[id] =
        concerns(*plan_.inspect, type, type, world_.names()[id], plan_.clock.seed) ? 1 : 0;
  }
  return wanted_[id] == 1;
}

void Inspector::look_at(std::size_t row) {
  seen_ = true;
  if (count_ == kMostAgents) {
    if (!told_of_number_)
      spdlog::warn(
          "--inspect: more than {} agents at once, the velocity spaces of the first {} "
          "are recorded",
          kMostAgents, kMostAgents);
    told_of_number_ = true;
    return;
  }
  if (count_ == agents_.size()) agents_.emplace_back();
  InspectedAgent& agent = agents_[count_++];
  const Scene& scene = sim_.scene;
  agent.id = scene.id[row];
  agent.velocity = scene.velocity[row];
  agent.chosen =
      gamma_velocity(sim_.model, scene, sim_.work.geometry, row, scene.behavior[row], agent.work);
  agent.binding = binding_of(scene, row, agent.chosen, agent.work);
}

void Inspector::count_planes() {
  for (std::size_t i = 0; i < count_; ++i) planes_ += agents_[i].work.constraints.planes.size();
  if (planes_ > kMostPlanes)
    spdlog::warn("--inspect: {} half-planes are recorded, from {} s on no more are", planes_,
                 sim_.scene.time);
}

void Inspector::close() const {
  if (plan_.inspect && !seen_)
    spdlog::warn(
        "--inspect: none of those was ever there and driven by GAMMA, no velocity space "
        "is recorded");
}

}  // namespace sumogamma
