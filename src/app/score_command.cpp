#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/command.h"
#include "app/scene_reading.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/print.h"
#include "io/config.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "realism/score_page.h"
#include "realism/score_report.h"
#include "scene/behavior_preset.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

struct ScoreOptions {
  std::vector<std::string> files;
  fs::path output, map;
  std::vector<std::string> methods;
  std::size_t rollouts = 32, free_runs = 0;
  std::optional<std::string> preset;
  bool force = false;
  SceneArguments reading;
};

struct Scored {
  RecordedScene scene;
  std::optional<RecordedRoad> road;
  RecordingScore score;
};

/// A recording scored; nothing where the user interrupts.
std::optional<Scored> score_file(const std::string& file, const ScoreOptions& options,
                                 const ScoreSettings& settings, const CommonOptions& common) {
  Scored scored;
  scored.scene = read_recorded_scene(file, scene_reading(options.reading));
  Workers workers(common.threads);
  ScoreSettings own = settings;
  if (!options.map.empty()) {
    scored.road = put_on_road(options.map, workers, scored.scene);
    own.road = &*scored.road;
  }
  bool stopped = false;
  const auto progress = [&](const std::string& method, std::size_t window, std::size_t windows) {
    stopped = interrupted();
    if (!common.quiet && window == 0)
      print(stderr, "{}: {}, {} windows\n", scored.scene.name, method, windows);
    return !stopped;
  };
  scored.score = score_recording(scored.scene, own, workers, progress);
  if (stopped) return std::nullopt;
  return scored;
}

void write_results(const ScoreOptions& options, const ScoreSettings& settings,
                   const std::vector<Scored>& all, const std::vector<std::string>& left_out) {
  nlohmann::ordered_json json{{"version", SUMOGAMMA_VERSION},
                              {"seed", settings.seed},
                              {"rollouts", settings.rollouts},
                              {"free_runs", settings.free_runs},
                              {"preset", name_of(settings.preset)},
                              {"point", options.reading.point},
                              {"boxes", options.reading.boxes},
                              {"window_s", kScoreStep * kWindowSteps},
                              {"left_out", left_out}};
  json["weights"] = nlohmann::ordered_json::object();
  for (const ScoreFeatureInfo& info : score_features()) json["weights"][info.name] = info.weight;
  json["recordings"] = nlohmann::ordered_json::array();
  std::vector<RecordingScore> scores;
  for (const Scored& one : all) {
    json["recordings"].push_back(score_json(one.scene, one.score));
    if (one.road)
      json["recordings"].back()["map"] = {{"network", one.road->file.filename().string()},
                                          {"people_left_out", one.road->people},
                                          {"bicycles_beside_lanes", one.road->beside_lanes},
                                          {"vehicles_without_a_route", one.road->no_route}};
    scores.push_back(one.score);
  }
  write_file(options.output / "score.csv", score_csv(scores));
  write_file(options.output / "score.html", score_page(scores, SUMOGAMMA_VERSION));
  write_file(options.output / "score.json", json.dump(1) + "\n");
}

void print_results(const std::vector<Scored>& all, std::FILE* out) {
  std::vector<RecordingScore> scores;
  for (const Scored& one : all) {
    print(out, "## {}\n", one.score.name);
    for (const std::string& note : scoring_notes(one.scene, one.score)) print(out, "- {}\n", note);
    if (one.road)
      print(out,
            "- on {}: left out of all methods are {} people, {} bicycles beside the lanes and {} "
            "vehicles without a route\n",
            one.road->file.filename().string(), one.road->people, one.road->beside_lanes,
            one.road->no_route);
    print(out, "\n{}\n", score_table(one.score));
    if (!one.score.free_scores.empty()) print(out, "{}\n", free_table(one.score));
    scores.push_back(one.score);
  }
  if (scores.size() > 1) print(out, "## All\n\n{}\n", mean_table(scores));
}

int score(const ScoreOptions& options, const CommonOptions& common) {
  ScoreSettings settings;
  settings.methods = options.methods;
  if (settings.methods.empty())
    for (const ScoreMethodInfo& info : score_methods())
      if (!info.on_roads || !options.map.empty()) settings.methods.emplace_back(info.name);
  for (const std::string& method : settings.methods) {
    require_score_method(method);
    for (const ScoreMethodInfo& info : score_methods())
      if (method == info.name && info.on_roads && options.map.empty())
        throw Error("--method " + method, "drives on a network: --map NAME.net.xml tells which");
  }
  settings.seed = common.seed;
  settings.rollouts = options.rollouts;
  settings.free_runs = options.free_runs;
  // the last word counts: --preset, --set behavior.preset, what stands without either
  std::vector<std::string> set = common.set;
  if (!options.map.empty())
    set.insert(set.begin(),
               fmt::format("behavior.preset={}", name_of(BehaviorPreset::Interaction)));
  if (options.preset) set.push_back("behavior.preset=" + *options.preset);
  const ScenarioConfig config = read_config({}, set);
  settings.model = config.model;
  settings.behavior = config.types;
  settings.preset = config.preset;
  std::optional<OutputFolder> folder;
  if (!options.output.empty()) {
    require_without(options.output, "score.json", options.force);
    folder.emplace(options.output, options.force);
  }
  std::vector<Scored> all;
  std::vector<std::string> left_out;
  for (const std::string& file : options.files) {
    try {
      std::optional<Scored> scored = score_file(file, options, settings, common);
      if (!scored) return kExitInterrupted;
      all.push_back(std::move(*scored));
    } catch (const Error& error) {
      if (options.files.size() == 1) throw;
      print(stderr, "sumo-gamma: left out: {}\n", error.what());
      left_out.emplace_back(error.what());
    }
  }
  if (all.empty()) throw Error("score", "none of the recordings can be scored");
  print_results(all, common.out);
  if (folder) write_results(options, settings, all, left_out);
  return left_out.empty() ? kExitDone : kExitNotHeld;
}

}  // namespace

CommandRunner add_score_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "score", "how like recordings rollouts are: windows of 8 s, beside simple controls");
  auto options = std::make_shared<ScoreOptions>();
  std::string methods;
  for (const ScoreMethodInfo& info : score_methods())
    methods += fmt::format("{}{} ({})", methods.empty() ? "" : ", ", info.name, info.label);
  command->add_option("RECORDINGS", options->files, "as `predict` reads them")->required();
  command->add_option("-o,--output", options->output,
                      "folder for score.json, score.csv and score.html");
  command->add_option("--map", options->map,
                      "SUMO network of the place in the recording's axes (NAME.net.xml), as "
                      "scene-from --map writes it: GAMMA keeps to the rules of the road there");
  command->add_option("--method", options->methods, "of " + methods + "; default: all that can be")
      ->delimiter(',');
  command
      ->add_option("--seeds", options->rollouts,
                   "rollouts of a window by methods that draw: seeds --seed, --seed + 1 …")
      ->check(whole_number(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--free", options->free_runs,
                   "also drive the whole recording, at most five minutes, freely so many times by "
                   "GAMMA and, with --map, by SUMO's models: distributions, travel times")
      ->check(whole_number(1, 1000));
  command
      ->add_option(
          "--preset", options->preset,
          "how GAMMA's drivers behave, as of run; default: interaction with --map, else compliant")
      ->check(CLI::IsMember(preset_names()));
  command->add_flag("--force", options->force, "write into a folder that holds other results");
  add_scene_reading_options(*command, options->reading);
  return [options](const CommonOptions& common) { return score(*options, common); };
}

}  // namespace sumogamma
