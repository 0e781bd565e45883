#pragma once

#include <cstdint>
#include <string>

#include "realism/free_run.h"
#include "realism/road_loop.h"

namespace sumogamma {

/// SUMO's own drivers in free runs: the recording as the demand that `scene-from --map` writes, by
/// the methods of SumoLoop. SUMO inserts everybody when it finds room; signals are the network's.
class SumoFreeRuns {
 public:
  /// Both outlive it.
  SumoFreeRuns(const RecordedScene& scene, const RecordedRoad& road);

  /// Throws Error with what SUMO says where it fails.
  FreeRun drive(const std::string& method, std::uint64_t seed) const;

 private:
  const RecordedScene& scene_;
  const RecordedRoad& road_;
  std::string demand_;  ///< the same for all methods, but for how types drive
};

}  // namespace sumogamma
