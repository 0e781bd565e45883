#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sumo/sumo_options.h"

namespace sumogamma {

/// Where the parts of a scenario lie and what its configuration says: a folder made by
/// `sumo-gamma import`, or any user's .sumocfg.
struct ScenarioInput {
  std::string name;                ///< folder or config name without extension
  std::filesystem::path config;    ///< the .sumocfg
  std::filesystem::path settings;  ///< scenario.toml beside it; empty where there is none
  std::filesystem::path network;   ///< the net file that SUMO loads
  std::vector<std::filesystem::path> routes, additional;  ///< and its route and additional files
  SumoOptions options;  ///< of the .sumocfg and of --sumo-options, which win
  std::optional<double> begin, end, step_length;  ///< [s], where they are set
  std::optional<std::uint64_t> seed;
  /// The .sumocfg as SUMO can open it: SUMO splits names of files at commas, those of the folder,
  /// too, so that one with a comma is reached through a descriptor that `folder` keeps open.
  std::string config_for_sumo;
  std::shared_ptr<const int> folder;
};

/// Resolves SCENARIO (a folder with scenario.sumocfg, or a .sumocfg file) with the further options
/// that the user gives to SUMO. Throws Error naming the file where it, the network or a route or
/// additional file is missing, the config is not XML, or the run would be mesoscopic.
ScenarioInput find_scenario(const std::filesystem::path& scenario,
                            std::span<const std::string> sumo_options = {});

}  // namespace sumogamma
