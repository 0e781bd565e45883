#pragma once

#include <optional>
#include <string>

#include "road/road_network.h"
#include "sumo/backend.h"
#include "sumo/scenario_input.h"

namespace sumogamma {

/// What the SUMO at the other end of --connect must be running.
struct ConnectExpectation {
  std::string where;  ///< "--connect localhost:8813", or what else it is called
  const ScenarioInput* scenario = nullptr;
  const RoadNetwork* network = nullptr;  ///< as read from the scenario's net file
  double step = 0.05;                    ///< [s]
  std::optional<double>
      begin;  ///< [s]; empty where the scenario loads a state with a time of its own
};

/// Compares step length, time, network and version of the SUMO that the user started with what this
/// run is about: poses written into another network, or at another pace, would be wrong without a
/// word. Throws Error that says what differs and how to start it.
void require_same_run(SumoBackend& backend, const ConnectExpectation& expected);

/// Version of the SUMO that is installed here, "1.15.0"; empty where there is none or it won't
/// tell.
std::string installed_sumo_version();

}  // namespace sumogamma
