#include "sumo/edge_speeds.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr double kLeast = 0.1;  // of a queue that stands [m/s]

double free_speed(const RoadNetwork& network, std::size_t edge) {
  double fastest = 0.0;
  for (const LaneId lane : network.edges[edge].lanes)
    fastest = std::max(fastest, network.lane(lane).speed_limit);
  return std::max(fastest, kLeast);
}

}  // namespace

EdgeSpeeds::EdgeSpeeds(const RoadNetwork& network)
    : speeds_(network.edges.size(), 0.0),
      told_(network.edges.size(), 0.0),
      sums_(network.edges.size()) {}

void EdgeSpeeds::add(const RoadNetwork& network, const Scene& scene) {
  constexpr double kWeight = 1.0 / 90.0;  // the mean age of an average over 180 s
  std::fill(sums_.begin(), sums_.end(), Sum{});
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const LaneId id = scene.lane[row].lane;
    // who halts by plan holds up nobody's reckoning
    if (id == kNoLane || scene.path[row] == kNoPath || scene.halt[row].left > 0.0) continue;
    const Lane& lane = network.lane(id);
    if (lane.kind != LaneKind::Normal) continue;
    Sum& sum = sums_[index_of(lane.edge)];
    sum.speed += scene.velocity[row].norm();
    ++sum.count;
  }
  for (std::size_t edge = 0; edge < sums_.size(); ++edge) {
    const Sum& sum = sums_[edge];
    if (sum.count == 0 && speeds_[edge] == 0.0) continue;
    const double free = free_speed(network, edge);
    if (speeds_[edge] == 0.0) speeds_[edge] = free;
    const double now = sum.count > 0 ? std::clamp(sum.speed / sum.count, kLeast, free) : free;
    speeds_[edge] += kWeight * (now - speeds_[edge]);
  }
}

std::vector<std::pair<EdgeId, double>> EdgeSpeeds::take_changes(const RoadNetwork& network) {
  constexpr double kWorthTelling = 0.05;
  std::vector<std::pair<EdgeId, double>> changes;
  for (std::size_t edge = 0; edge < speeds_.size(); ++edge) {
    if (speeds_[edge] == 0.0) continue;
    if (told_[edge] == 0.0) told_[edge] = free_speed(network, edge);
    if (std::abs(speeds_[edge] - told_[edge]) < kWorthTelling * told_[edge]) continue;
    told_[edge] = speeds_[edge];
    const Lane& lane = network.lane(network.edges[edge].lanes.front());
    changes.emplace_back(static_cast<EdgeId>(edge), lane.length / speeds_[edge]);
  }
  return changes;
}

}  // namespace sumogamma
