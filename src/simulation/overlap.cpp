#include "simulation/overlap.h"

#include <algorithm>

namespace sumogamma {

namespace {
// less is rounding [m]
constexpr double kTouching = 1e-6;
}  // namespace

void OverlapRecord::update(const Scene& scene, const TickGeometry& geometry, Workers& workers) {
  found_.resize(workers.count());
  for (auto& list : found_) list.clear();
  double largest = 0;
  for (const Footprint& footprint : scene.footprint) largest = std::max(largest, footprint.radius);

  workers.for_each_range(scene.size(), [&](std::size_t worker, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const double own = scene.footprint[row].radius;
      geometry.grid.visit_within(
          scene.position[row], own + largest, [&](std::uint32_t other, double square) {
            const double reach = own + scene.footprint[other].radius;
            if (other <= row || square > reach * reach) return;
            const double depth = overlap_depth(scene, geometry, row, other);
            if (depth > kTouching)
              found_[worker].push_back({static_cast<std::uint32_t>(row), other, depth});
          });
    }
  });

  std::fill(now_.begin(), now_.end(), 0);
  for (const auto& list : found_) {
    for (const Contact& contact : list) {
      for (std::uint32_t row : {contact.first, contact.second}) {
        deepest_[row] = std::max(deepest_[row], contact.depth);
        now_[row] = 1;
      }
      const std::uint64_t key = (static_cast<std::uint64_t>(contact.first) << 32) | contact.second;
      const auto place = std::lower_bound(pairs_.begin(), pairs_.end(), key);
      if (place == pairs_.end() || *place != key) pairs_.insert(place, key);
    }
  }
  agent_steps_ += std::count(now_.begin(), now_.end(), 1);
}

std::size_t OverlapRecord::agents_deeper_than(double depth) const {
  return static_cast<std::size_t>(
      std::count_if(deepest_.begin(), deepest_.end(), [&](double d) { return d > depth; }));
}

}  // namespace sumogamma
