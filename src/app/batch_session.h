#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/command.h"

namespace sumogamma {

/// Options of `sumo-gamma batch`.
struct BatchOptions {
  std::filesystem::path study, output;
  unsigned jobs = 0;   ///< processes at once; 0: as many as there are processors
  std::string shard;   ///< "i/n", empty: all runs
  bool merge = false;  ///< run nothing: results of what was run
  std::vector<std::filesystem::path> from;  ///< further folders where shards ran
  std::string until;
};

/// Runs what of a study isn't done yet, a process a run, and writes the study's results. Returns
/// the exit code: 1 where runs failed. Throws Error before the first run for what can't be run.
int run_batch(const BatchOptions& options, const CommonOptions& common);

}  // namespace sumogamma
