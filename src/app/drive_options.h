#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/run_session.h"
#include "ego/external_ego.h"

namespace sumogamma {

/// Options of `sumo-gamma drive`; what is unset comes from [ego] of scenario.toml.
struct DriveOptions {
  RunOptions run;  ///< scenario, output, step, agents, back end, preset
  std::string seeds = "1";
  std::string shard;                         ///< "i/n"
  std::vector<std::filesystem::path> merge;  ///< folders whose episodes are taken over
  std::string replay;                        ///< seeds
  std::filesystem::path reference;           ///< a drive by GAMMA of the same seeds
  std::string address;                       ///< of --ego
  bool anywhere = false;
  ExternalLimits limits;
  std::optional<std::string> planner, vehicle, type, goal_edge;
  std::optional<double> goal_way, max_speed, deadline;
  std::vector<double> window;
  bool untrusted = false, emergency_brake = false;
};

/// Drives the episodes that aren't done yet, and writes the tables of all that are.
int drive_session(const DriveOptions& options, const CommonOptions& common);

/// "7", "1..200" or several of them with commas between, in order, each once. Throws Error naming
/// `option`.
std::vector<std::uint64_t> parse_seeds(const std::string& option, const std::string& text);

}  // namespace sumogamma
