#include "prediction/flow_memory.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

std::int64_t cell_of(double coordinate, double cell) {
  return static_cast<std::int64_t>(std::floor(coordinate / cell));
}
}  // namespace

std::uint32_t FlowMemory::place_for(const Vec2& position) {
  Cell& cell = cells_[key_of(cell_of(position.x(), kCell), cell_of(position.y(), kCell))];
  if (cell.samples.size() < cell_capacity_) {
    cell.samples.push_back(static_cast<std::uint32_t>(samples_.size()));
    samples_.emplace_back();
    return cell.samples.back();
  }
  const std::uint32_t oldest = cell.samples[cell.next];
  cell.next = (cell.next + 1) % cell_capacity_;
  return oldest;
}

void FlowMemory::remember(std::uint32_t agent, const Vec2& position, const Vec2& velocity,
                          std::span<const Vec2> predicted) {
  if (!position.allFinite()) return;
  const std::uint32_t index = place_for(position);
  Sample& sample = samples_[index];
  sample.position = position;
  sample.velocity = velocity;
  sample.agent = agent;
  sample.known = 0;
  for (std::size_t k = 0; k < kSteps; ++k)
    sample.residual[k] = predicted[std::min(k, predicted.size() - 1)];
  Active& active = active_[agent];
  active.seen = true;
  std::shift_right(active.recent.begin(), active.recent.end(), 1);
  active.recent[0] = index;
  active.count = std::min<std::uint32_t>(active.count + 1, kSteps);
}

void FlowMemory::resolve(std::uint32_t agent, const Vec2& position) {
  const auto found = active_.find(agent);
  if (found == active_.end()) return;
  for (std::uint32_t k = 0; k < found->second.count; ++k) {
    Sample& sample = samples_[found->second.recent[k]];
    // a slot that was taken over by another agent since
    if (sample.agent != agent || sample.known != k) continue;
    sample.residual[k] = position - sample.position - sample.residual[k];
    sample.known = k + 1;
  }
}

void FlowMemory::end_frame() {
  std::erase_if(active_, [](const auto& entry) { return !entry.second.seen; });
  for (auto& entry : active_) entry.second.seen = false;
}

std::array<Vec2, FlowMemory::kSteps> FlowMemory::correction(std::uint32_t agent,
                                                            const Vec2& position,
                                                            const Vec2& velocity,
                                                            const FlowKernel& kernel) const {
  std::array<Vec2, kSteps> sum;
  sum.fill(Vec2::Zero());
  std::array<double, kSteps> weight{};
  const double by_distance = 1.0 / (kernel.distance * kernel.distance);
  const double by_speed = 1.0 / (kernel.speed * kernel.speed);
  const double radius = std::sqrt(kReach) * kernel.distance;
  const std::int64_t left = cell_of(position.x() - radius, kCell),
                     right = cell_of(position.x() + radius, kCell);
  const std::int64_t low = cell_of(position.y() - radius, kCell),
                     high = cell_of(position.y() + radius, kCell);
  for (std::int64_t y = low; y <= high; ++y)
    for (std::int64_t x = left; x <= right; ++x) {
      const auto cell = cells_.find(key_of(x, y));
      if (cell == cells_.end()) continue;
      for (const std::uint32_t index : cell->second.samples) {
        const Sample& sample = samples_[index];
        const double apart = by_speed * (sample.velocity - velocity).squaredNorm() +
                             by_distance * (sample.position - position).squaredNorm();
        if (apart > kReach || sample.agent == agent || sample.known == 0) continue;
        const double w = std::exp(-0.5 * apart);
        for (std::uint32_t k = 0; k < sample.known; ++k) {
          sum[k] += w * sample.residual[k];
          weight[k] += w;
        }
      }
    }
  for (std::size_t k = 0; k < kSteps; ++k) sum[k] /= weight[k] + kernel.prior;
  return sum;
}

}  // namespace sumogamma
