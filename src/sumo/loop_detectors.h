#pragma once

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "road/road_network.h"
#include "scene/scene.h"
#include "sumo/backend.h"
#include "sumo/known_agents.h"

namespace sumogamma {

/// Induction loops on lanes of the network. Actuated signals don't see ghosts: they are told when a
/// vehicle was last on each of their loops.
struct LoopDetectors {
  struct Loop {
    std::size_t index = 0;  ///< into ages
    double position = 0;    ///< along the lane [m]
    double last_seen = 0;   ///< when a vehicle was last on it [s]
  };
  std::map<LaneId, std::vector<Loop>> loops;
  std::vector<std::pair<std::string, double>> ages;  ///< id and time since it was last passed [s]
};

LoopDetectors find_loop_detectors(const RoadNetwork& network, const SumoBackend& backend,
                                  double now);

/// Notes whose bodies are on loops and brings the ages up to `now` [s]. `known`: by AgentId.
void note_passages(const Scene& scene, std::span<const KnownAgent> known, double now,
                   LoopDetectors& detectors);

}  // namespace sumogamma
