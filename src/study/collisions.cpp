#include "study/collisions.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

CollisionMonitor::CollisionMonitor(double step, const RoadNetwork* road)
    : step_(step), road_(road), has_storeys_(road && has_storeys(*road)) {}

void CollisionMonitor::prepare(const Scene& scene) {
  const std::size_t count = scene.size();
  intervals_.resize(count);
  outlines_.resize(count);
  overlapping_.assign(count, false);
  for (std::size_t row = 0; row < count; ++row) {
    outlines_[row] =
        place_polygon(scene.footprint[row].outline(), direction_of(scene.heading[row]));
    double left = 0, right = 0;
    for (std::uint32_t k = 0; k < outlines_[row].count; ++k) {
      left = std::min(left, outlines_[row].vertices[k].x());
      right = std::max(right, outlines_[row].vertices[k].x());
    }
    const double x = scene.position[row].x();
    intervals_[row] = {x + left, x + right, static_cast<std::uint32_t>(row)};
  }
  std::sort(intervals_.begin(), intervals_.end(), [](const Interval& a, const Interval& b) {
    return a.left != b.left ? a.left < b.left : a.row < b.row;
  });
  if (!has_storeys_) return;
  ground_.resize(count);
  for (std::size_t row = 0; row < count; ++row) {
    const LanePosition& place = scene.lane[row];
    // an agent off every lane is taken to be on the ground
    ground_[row] = {
        place.lane, place.along,
        place.lane == kNoLane ? 0.0 : elevation_at(road_->lane(place.lane), place.along)};
  }
}

void CollisionMonitor::add(const Scene& scene, const AgentTypeTable& types) {
  prepare(scene);
  for (std::size_t i = 0; i < intervals_.size(); ++i) {
    const std::size_t a = intervals_[i].row;
    for (std::size_t j = i + 1; j < intervals_.size() && intervals_[j].left < intervals_[i].right;
         ++j) {
      const std::size_t b = intervals_[j].row;
      const double reach = scene.footprint[a].radius + scene.footprint[b].radius;
      if (std::abs(scene.position[a].y() - scene.position[b].y()) >= reach) continue;
      if (has_storeys_ && on_other_storey(*road_, ground_[a], ground_[b])) continue;
      meet(scene, types, std::min(a, b), std::max(a, b));
    }
  }
  agent_steps_ += scene.size();
  overlap_steps_ +=
      static_cast<std::uint64_t>(std::count(overlapping_.begin(), overlapping_.end(), true));
}

void CollisionMonitor::meet(const Scene& scene, const AgentTypeTable& types, std::size_t a,
                            std::size_t b) {
  const double depth =
      overlap_depth(outlines_[a], outlines_[b], scene.position[b] - scene.position[a]);
  if (!(depth > kContact)) return;
  overlapping_[a] = overlapping_[b] = true;
  const auto [found, first] =
      index_.try_emplace({scene.id[a].value, scene.id[b].value}, pairs_.size());
  if (first)
    pairs_.push_back({scene.time, scene.id[a], scene.id[b], scene.type[a], scene.type[b],
                      0.5 * (scene.position[a] + scene.position[b]), 0.0, 0.0});
  CollisionPair& pair = pairs_[found->second];
  pair.depth = std::max(pair.depth, depth);
  pair.duration += step_;
  if (!first) return;
  const std::string &one = type_of(types, scene.type[a]).name,
                    &other = type_of(types, scene.type[b]).name;
  ++by_types_[std::min(one, other) + "-" + std::max(one, other)];
}

CollisionResult CollisionMonitor::result() const {
  CollisionResult result;
  result.unique_pairs = pairs_.size();
  for (const CollisionPair& pair : pairs_) {
    if (pair.depth > kDeep) ++result.deep_pairs;
    result.worst_penetration_m = std::max(result.worst_penetration_m, pair.depth);
  }
  result.by_types = by_types_;
  result.agent_hours = static_cast<double>(agent_steps_) * step_ / 3600.0;
  if (agent_steps_ > 0) {
    result.unique_pairs_per_agent_hour = static_cast<double>(pairs_.size()) / result.agent_hours;
    result.overlap_share_of_agent_steps =
        static_cast<double>(overlap_steps_) / static_cast<double>(agent_steps_);
  }
  return result;
}

}  // namespace sumogamma
