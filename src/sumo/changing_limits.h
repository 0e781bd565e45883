#pragma once

#include <memory>
#include <string>
#include <vector>

#include "road/path.h"
#include "road/road_network.h"
#include "sumo/backend.h"

namespace sumogamma {

/// Speed limits that change while SUMO runs: variable speed signs, and what another client sets.
struct ChangingLimits {
  std::shared_ptr<std::vector<double>> limits;  ///< by LaneId [m/s]; null: none can change
  std::vector<LaneId> lanes;                    ///< whose limit may change
  double next_look = 0;                         ///< when they are read again [s]
};

/// `sign_lanes`: whose limit SUMO changes as it runs; `any`: every lane's may.
ChangingLimits find_changing_limits(const RoadNetwork& network,
                                    const std::vector<std::string>& sign_lanes, bool any);

/// Reads the limits, once a second; by LaneId where they have changed, empty where nowhere.
std::vector<bool> read_limits(const RoadNetwork& network, double now, SumoBackend& backend,
                              ChangingLimits& changing);

/// Does a path use one of these lanes?
bool uses_lanes(const Path& path, const std::vector<bool>& lanes);

}  // namespace sumogamma
