#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <string>

namespace sumogamma {

inline constexpr int kExitDone = 0;
inline constexpr int kExitNotHeld =
    1;  ///< ran, but something it was asked to guarantee did not hold
inline constexpr int kExitBadInput = 2;
inline constexpr int kExitSumoFailed = 3;
inline constexpr int kExitInterrupted = 130;

/// Options that every command has.
struct CommonOptions {
  std::uint64_t seed = 1;
  bool seed_given = false;  ///< --seed was there
  unsigned threads = 1;
  bool quiet = false;
  std::string log_level = "warn";
  std::vector<std::string> set;  ///< key=value, overriding scenario.toml
  std::FILE* out = stdout;       ///< results for people and pipes
};

/// Each command adds its sub-command to the parser and returns what to run when it was chosen. The
/// runner returns an exit code; Error and SumoError thrown by it are printed and mapped to 2 and 3
/// in main.
using CommandRunner = std::function<int(const CommonOptions&)>;
CommandRunner add_import_command(CLI::App& parent);
CommandRunner add_demand_command(CLI::App& parent);
CommandRunner add_run_command(CLI::App& parent);
CommandRunner add_scene_command(CLI::App& parent);
CommandRunner add_scene_from_command(CLI::App& parent);
CommandRunner add_predict_command(CLI::App& parent);
CommandRunner add_drive_command(CLI::App& parent);
CommandRunner add_replay_command(CLI::App& parent);
CommandRunner add_batch_command(CLI::App& parent);
CommandRunner add_compare_command(CLI::App& parent);
CommandRunner add_report_command(CLI::App& parent);
CommandRunner add_validate_command(CLI::App& parent);
CommandRunner add_score_command(CLI::App& parent);
CommandRunner add_version_command(CLI::App& parent);

/// True once the user pressed Ctrl-C or the process was asked to end (SIGINT, SIGTERM, SIGHUP).
bool interrupted();

}  // namespace sumogamma
