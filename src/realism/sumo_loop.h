#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "realism/road_loop.h"

namespace sumogamma {

/// SUMO's own drivers in closed loop on a network, from the same places and speeds as RoadLoop, on
/// the same routes, with the same factors on speed limits (limit_factor) and the network's signals.
class SumoLoop {
 public:
  /// Both outlive it.
  SumoLoop(const RecordedScene& scene, const RecordedRoad& road);

  /// Rollouts of a window by a method: sumo-krauss, sumo-idm, sumo-eidm (carFollowModel, else
  /// SUMO's defaults, steps of 0.1 s), sumo-sublane (Krauss with lateral-resolution 0.64). One SUMO
  /// drives them all, one after another, with its own seed and what it draws from there. Throws
  /// SumoError where SUMO fails.
  std::vector<Rollout> drive(const ScoreWindow& window, const std::string& method,
                             std::uint64_t seed, std::size_t count, EntryCounts& entries) const;

 private:
  const RecordedScene& scene_;
  const RecordedRoad& road_;
};

}  // namespace sumogamma
