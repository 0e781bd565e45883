#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/command.h"
#include "base/error.h"
#include "base/print.h"
#include "base/subprocess.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "validation/verdict.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct ValidateOptions {
  std::string output;
  std::string scenarios;  ///< empty: found beside the program
  unsigned seeds = 8;
  bool fast = false;
  bool no_sumo = false;
  bool force = false;
  std::vector<std::string> only;
};

/// The folder with `sumo_scenarios` and `tools`: above the program in a build tree, or where the
/// project was installed.
fs::path data_folder(const std::string& given) {
  const fs::path beside = own_program().parent_path();
  std::vector<fs::path> places{beside / "../share/sumo-gamma", fs::current_path()};
  for (fs::path up = beside; up.has_relative_path(); up = up.parent_path()) places.push_back(up);
  if (!given.empty()) places = {given};
  for (const fs::path& place : places)
    if (fs::exists(place / "sumo_scenarios" / "saturation") &&
        fs::exists(place / "tools" / "measure_traffic.py"))
      return fs::weakly_canonical(place);
  throw Error(
      given.empty() ? "validate" : "--data " + given,
      "finds no folder with sumo_scenarios and tools/measure_traffic.py; give the project's "
      "with --data");
}

std::vector<Trial> chosen_trials(const std::vector<std::string>& only) {
  std::vector<Trial> trials = driving_trials();
  for (Trial& trial : walking_trials()) trials.push_back(std::move(trial));
  if (only.empty()) return trials;
  std::vector<Trial> chosen;
  for (const std::string& id : only) {
    const auto found = std::find_if(trials.begin(), trials.end(),
                                    [&](const Trial& trial) { return trial.id == id; });
    if (found == trials.end()) {
      std::string ids;
      for (const Trial& trial : trials) ids += (ids.empty() ? "" : ", ") + trial.id;
      throw Error("--only " + id, "is no trial; there are " + ids);
    }
    chosen.push_back(*found);
  }
  return chosen;
}

struct Interrupted {};

std::string outcome_of(const ProcessRequest& request) {
  const ProcessResult result = run_process(request);
  if (result.stopped || interrupted()) throw Interrupted();
  if (!result.ok())
    throw Error(request.arguments[0] + " " + request.arguments[1],
                describe_end(result, request.time_limit) + ": " + result.errors);
  return result.output;
}

/// What tools/measure_traffic.py says of a small scenario, driven by `control`.
json measure(const fs::path& data, const Trial& trial, const std::string& control,
             std::uint64_t seed, const fs::path& folder) {
  const fs::path scenario = data / "sumo_scenarios" / trial.scenario;
  ProcessRequest run;
  run.arguments = {own_program(), "run",      scenario / (trial.scenario + ".sumocfg"),
                   "-o",          folder,     "--trajectory-period",
                   "0.1",         "--seed",   std::to_string(seed),
                   "--control",   control,    "--quiet",
                   "--force",     "--preset", trial.preset};
  run.should_stop = interrupted;
  outcome_of(run);
  ProcessRequest figures;
  figures.arguments = {"python3", "-B", data / "tools" / "measure_traffic.py", trial.scenario,
                       folder};
  figures.should_stop = interrupted;
  json measured = json::parse(outcome_of(figures), nullptr, false);
  if (measured.is_discarded())
    throw Error("tools/measure_traffic.py " + trial.scenario, "printed no JSON");
  fs::remove_all(folder);
  return measured;
}

/// A criterion's value; the largest of a list; not a number where there is none.
double value_at(const json& measured, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!measured.contains(place)) return std::nan("");
  const json& value = measured.at(place);
  if (value.is_number()) return value.get<double>();
  double largest = std::nan("");
  if (value.is_array())
    for (const json& one : value)
      if (one.is_number()) largest = std::fmax(largest, one.get<double>());
  return largest;
}

/// Values [criterion][seed].
using Values = std::vector<std::vector<double>>;

Values values_of(const Trial& trial, const ValidateOptions& options, const std::string& control,
                 const fs::path& data, Workers& workers) {
  Values values(trial.criteria.size());
  for (std::uint64_t seed = 1; seed <= options.seeds; ++seed) {
    if (interrupted()) throw Interrupted();
    std::vector<double> of_seed;
    if (trial.walk) {
      of_seed = trial.walk(seed, workers);
    } else {
      const json measured = measure(data, trial, control, seed, fs::path(options.output) / "run");
      for (const Criterion& criterion : trial.criteria)
        of_seed.push_back(value_at(measured, criterion.pointer));
    }
    for (std::size_t k = 0; k < values.size(); ++k) values[k].push_back(of_seed[k]);
  }
  return values;
}

int validate(const ValidateOptions& options, const CommonOptions& common) {
  const std::vector<Trial> trials = chosen_trials(options.only);
  const bool drives = std::any_of(trials.begin(), trials.end(),
                                  [](const Trial& trial) { return !trial.scenario.empty(); });
  const fs::path data = drives ? data_folder(options.scenarios) : fs::path();
  const OutputFolder folder(options.output, options.force);
  Workers workers(common.threads);
  std::vector<Outcome> outcomes;
  for (const Trial& trial : trials) {
    if (!common.quiet) fmt::print(stderr, "{}: {}\n", trial.id, trial.asks);
    Values ours = values_of(trial, options, "all", data, workers);
    Values sumo(trial.criteria.size());
    if (!trial.walk && !options.no_sumo) sumo = values_of(trial, options, "none", data, workers);
    for (std::size_t k = 0; k < trial.criteria.size(); ++k)
      outcomes.push_back(judge(trial, trial.criteria[k], std::move(ours[k]), std::move(sumo[k])));
    // what is known so far isn't lost where a later trial is interrupted
    write_file(fs::path(options.output) / "validate.json",
               outcomes_json(outcomes, SUMOGAMMA_VERSION));
    write_file(fs::path(options.output) / "validate.html",
               outcomes_html(outcomes, SUMOGAMMA_VERSION));
  }
  std::fputs(outcomes_markdown(outcomes).c_str(), stdout);
  const auto failed = std::count_if(outcomes.begin(), outcomes.end(), [](const Outcome& outcome) {
    return outcome.verdict == Judgement::Fail;
  });
  if (!common.quiet)
    fmt::print(stderr, "{} of {} figures fail; the page: {}\n", failed, outcomes.size(),
               (fs::path(options.output) / "validate.html").string());
  return failed > 0 ? kExitNotHeld : kExitDone;
}

}  // namespace

CommandRunner add_validate_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "validate", "drive and walk cases whose outcome is known, and judge what comes of them");
  auto options = std::make_shared<ValidateOptions>();
  command->add_option("-o,--output", options->output, "folder for validate.json and validate.html")
      ->required();
  command->add_option("--seeds", options->seeds, "seeds 1 to N of each trial")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_flag("--fast", options->fast, "two seeds");
  command->add_option("--only", options->only, "these trials: V1, R4 …")->delimiter(',');
  command->add_flag("--no-sumo", options->no_sumo, "leave out the same cases driven by SUMO");
  command->add_option("--data", options->scenarios,
                      "folder that holds sumo_scenarios and tools (found beside the program)");
  command->add_flag("--force", options->force, "write into a folder that holds other results");
  return [options](const CommonOptions& common) {
    if (options->fast) options->seeds = std::min(options->seeds, 2u);
    try {
      return validate(*options, common);
    } catch (const Interrupted&) {
      return kExitInterrupted;
    }
  };
}

}  // namespace sumogamma
