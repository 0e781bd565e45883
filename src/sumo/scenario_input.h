#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace sumogamma {

/// Where the parts of a scenario lie: a folder made by `sumo-gamma import`, or any user's .sumocfg.
struct ScenarioInput {
  std::string name;                ///< folder or config name without extension
  std::filesystem::path config;    ///< the .sumocfg
  std::filesystem::path settings;  ///< scenario.toml beside it; empty where there is none
  std::filesystem::path network;   ///< the net file that the config names
  std::vector<std::filesystem::path> additional;  ///< its additional files
  double begin = 0;                               ///< [s]
  double end = -1;                                ///< [s]; negative where it says none
};

/// Resolves SCENARIO (a folder with scenario.sumocfg, or a .sumocfg file). Throws Error naming the
/// file where it, the network or a route or additional file is missing, or the config is not XML.
ScenarioInput find_scenario(const std::filesystem::path& scenario);

}  // namespace sumogamma
