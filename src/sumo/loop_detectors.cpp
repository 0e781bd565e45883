#include "sumo/loop_detectors.h"

#include <cmath>

namespace sumogamma {

LoopDetectors find_loop_detectors(const RoadNetwork& network, const SumoBackend& backend,
                                  double now) {
  LoopDetectors detectors;
  for (const SumoBackend::Detector& detector : backend.detectors()) {
    const auto lane = network.lane_by_name.find(detector.lane);
    if (lane == network.lane_by_name.end()) continue;
    detectors.loops[lane->second].push_back({detectors.ages.size(), detector.position, now});
    detectors.ages.emplace_back(detector.id, 0.0);
  }
  return detectors;
}

void note_passages(const Scene& scene, std::span<const KnownAgent> known, double now,
                   LoopDetectors& detectors) {
  if (detectors.loops.empty()) return;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const KnownAgent& agent = known[scene.id[row].value];
    // an override hides SUMO's own vehicles from the loop: they are reported, too
    if (scene.control[row] == Control::Parked || agent.is_person) continue;
    const auto lane = detectors.loops.find(scene.lane[row].lane);
    if (lane == detectors.loops.end()) continue;
    for (LoopDetectors::Loop& loop : lane->second)
      if (std::abs(loop.position - scene.lane[row].along) <= 0.5 * agent.length)
        loop.last_seen = now;
  }
  for (const auto& [lane, list] : detectors.loops)
    for (const LoopDetectors::Loop& loop : list)
      detectors.ages[loop.index].second = now - loop.last_seen;
}

}  // namespace sumogamma
