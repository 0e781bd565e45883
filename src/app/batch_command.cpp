#include <memory>

#include "app/batch_session.h"
#include "app/command.h"
#include "app/validators.h"
#include "base/error.h"

namespace sumogamma {

CommandRunner add_batch_command(CLI::App& parent) {
  auto options = std::make_shared<BatchOptions>();
  CLI::App* command = parent.add_subcommand(
      "batch",
      "run a study: scenarios x parameters x seeds x {GAMMA, plain}; goes on where it was "
      "stopped");
  command->add_option("STUDY", options->study, "the study's TOML file")->required();
  command->add_option("-o,--output", options->output, "the study's folder")->required();
  command->add_option("--jobs", options->jobs, "processes at once (default: as many as processors)")
      ->check(whole_number(1, 4096));
  command->add_option("--shard", options->shard, "part I of N of the runs alone: I/N");
  command->add_flag("--merge", options->merge, "run nothing: results of what the shards ran");
  command->add_option("--from", options->from, "with --merge: folders of shards that ran elsewhere")
      ->take_all();
  command->add_option("--until", options->until,
                      "MEASURE=WIDTH: add seeds until the widest 95 % interval of a key of "
                      "results.json (paired with the baseline) is so narrow; WIDTH may be a "
                      "percentage");
  return [options](const CommonOptions& common) {
    if (common.seed_given || !common.set.empty())
      throw Error("batch", "seeds and settings stand in the study, leave --seed and --set out");
    return run_batch(*options, common);
  };
}

}  // namespace sumogamma
