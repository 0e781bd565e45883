#include "prediction/companions.h"

#include <cmath>

namespace sumogamma {

void join_paths(std::span<const Companion> agents, const CompanionKernel& kernel, SpatialGrid& grid,
                std::vector<std::array<Vec2, FlowMemory::kSteps>>& joint, std::size_t steps) {
  joint.resize(agents.size());
  std::vector<Vec2> positions;
  for (std::size_t k = 0; k < agents.size(); ++k) {
    positions.push_back(agents[k].position);
    joint[k] = agents[k].path;
  }
  if (kernel.weight <= 0 || kernel.distance <= 0 || kernel.speed <= 0) return;
  grid.rebuild(positions);
  const double by_distance = 1.0 / (kernel.distance * kernel.distance);
  const double by_speed = 1.0 / (kernel.speed * kernel.speed);
  for (std::size_t self = 0; self < agents.size(); ++self) {
    const Companion& agent = agents[self];
    if (!agent.joins) continue;
    double total = 1;
    auto add = [&](std::uint32_t row, double square) {
      const Companion& other = agents[row];
      if (row == self || !other.joins) return;
      const double apart =
          by_distance * square + by_speed * (other.velocity - agent.velocity).squaredNorm();
      if (apart > FlowMemory::kReach) return;
      const double weight = kernel.weight * std::exp(-0.5 * apart);
      total += weight;
      for (std::size_t k = 0; k < steps; ++k) joint[self][k] += weight * other.path[k];
    };
    grid.visit_within(agent.position, std::sqrt(FlowMemory::kReach) * kernel.distance, add);
    for (std::size_t k = 0; k < steps; ++k) joint[self][k] /= total;
  }
}

}  // namespace sumogamma
