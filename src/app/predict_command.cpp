#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/prediction_export.h"
#include "app/reading_options.h"
#include "app/recording_map.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/print.h"
#include "prediction/methods.h"
#include "prediction/plot.h"
#include "prediction/report.h"
#include "prediction/spread_training.h"
#include "prediction/walking_training.h"

namespace sumogamma {

namespace {

struct PredictOptions {
  std::vector<std::string> files;
  std::string protocol = "C";
  std::string memory = "strict";
  std::vector<std::string> methods;
  std::size_t samples = 0;
  double noise = 0;
  bool ablations = false;
  std::string draws = "independent";
  bool calibration = false;
  std::string json, plots, walking_rows, spread_rows, exported;
  ReadingArguments reading;
  MapArguments map;
  bool list_parameters = false;
};

PredictorParameters parameters_from(const CommonOptions& common) {
  PredictorParameters parameters = default_predictor_parameters();
  constexpr std::string_view kPrefix = "predict.";
  for (const std::string& assignment : common.set) {
    if (!assignment.starts_with(kPrefix))
      throw Error("--set " + assignment, "predict knows keys that begin with predict.");
    set_parameter(parameters, std::string_view(assignment).substr(kPrefix.size()));
  }
  return parameters;
}

void write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path);
  file << text;
  if (!file.flush()) throw Error(path, "cannot be written");
}

/// Pictures of the fullest frames, apart from each other by a tenth of the recording.
void write_plots(const std::string& folder, const TrackSet& set, const Protocol& protocol,
                 const MethodSettings& settings) {
  constexpr std::size_t kPictures = 4;
  std::vector<int> counts(static_cast<std::size_t>(set.last_frame - set.first_frame + 1), 0);
  for (const Window& window : windows_of(set, protocol))
    ++counts[static_cast<std::size_t>(window.frame - set.first_frame)];
  std::vector<int> frames;
  const int apart = std::max(1, (set.last_frame - set.first_frame) / 10);
  while (frames.size() < kPictures) {
    const auto most = std::max_element(counts.begin(), counts.end());
    if (*most == 0) break;
    const int at = static_cast<int>(most - counts.begin());
    frames.push_back(set.first_frame + at);
    for (int k = std::max(0, at - apart); k < std::min(static_cast<int>(counts.size()), at + apart);
         ++k)
      counts[static_cast<std::size_t>(k)] = 0;
  }
  std::filesystem::create_directories(folder);
  const Method method = make_method("gamma", settings, set);
  for (int frame = set.first_frame; frame <= set.last_frame; ++frame) {
    const ObservedScene scene = observe(set, frame);
    method.observe(scene);
    if (std::find(frames.begin(), frames.end(), frame) == frames.end()) continue;
    const auto steps = static_cast<std::size_t>(protocol.steps);
    const Forecast forecast = method.predict(scene, steps);
    const std::vector<Forecast> samples =
        method.sample ? method.sample(scene, steps) : std::vector<Forecast>{};
    write_text(folder + "/" + set.name + "_" + std::to_string(frame) + ".svg",
               forecast_svg(set, scene, forecast, samples));
  }
}

/// Recordings that can be used, and what is wrong with the others.
struct Batch {
  std::unique_ptr<const RecordingMap> map;  ///< under all of them; null: none is known
  std::vector<TrackSet> sets;
  std::vector<MapFit> fits;  ///< of these on the map; empty without one
  std::vector<std::pair<std::string, std::string>> left_out;  ///< file and why
};

void say_how_it_was_read(const TrackSet& set) {
  print(stderr, "{}: read as {}, {} tracks, a frame every {:.4g} s\n", set.name, set.format,
        set.tracks.size(), set.own_period);
  for (const std::string& note : set.notes) print(stderr, "{}: {}\n", set.name, note);
  if (set.filled_gaps > 0)
    print(stderr, "{}: {} gaps filled ({} steps of 0.4 s)\n", set.name, set.filled_gaps,
          set.filled_steps);
  if (set.split_gaps > 0)
    print(stderr, "{}: {} gaps are too long to fill: tracks end and begin there\n", set.name,
          set.split_gaps);
}

/// Throws Error where the map is of no use to a recording.
void put_on_map(const TrackSet& set, bool quiet, Batch& batch) {
  if (batch.map == nullptr) return;
  const MapFit fit = check_fit(batch.map->under(set), set);
  batch.fits.push_back(fit);
  if (quiet) return;
  print(stderr, "{}: {} of {} agents on wheels lie on {}'s lanes{}\n", set.name, fit.on_map,
        fit.wheeled, batch.map->map.name,
        fit.on_map < fit.wheeled ? "; the others are predicted as without it" : "");
}

Batch read_batch(const PredictOptions& options, const Protocol& protocol,
                 const CommonOptions& common) {
  const bool quiet = common.quiet;
  const ReadOptions read = read_options(options.reading);
  Batch batch;
  Workers workers(common.threads);
  batch.map = read_recording_map(options.map, workers);
  for (const std::string& file : options.files) {
    try {
      TrackSet set = read_track_set(file, read);
      if (!quiet) say_how_it_was_read(set);
      if (windows_of(set, protocol).empty())
        throw Error(file,
                    "nobody is there for " + std::to_string(protocol.observed + protocol.steps) +
                        " frames without a gap, as protocol " + std::string(1, protocol.letter) +
                        " needs; check the columns and that frames are a constant step apart");
      put_on_map(set, quiet, batch);
      batch.sets.push_back(std::move(set));
    } catch (const Error& error) {
      if (options.files.size() == 1) throw;
      print(stderr, "sumo-gamma: left out: {}\n", error.what());
      batch.left_out.emplace_back(file, error.what());
    }
  }
  if (batch.sets.empty()) throw Error("predict", "none of the recordings can be used");
  return batch;
}

int write_training(const PredictOptions& options, const MethodSettings& settings,
                   const Batch& batch) {
  std::ostringstream walking, spread;
  for (const TrackSet& set : batch.sets) {
    const bool first = &set == &batch.sets.front();
    if (!options.walking_rows.empty()) write_walking_rows(walking, set, first);
    if (options.spread_rows.empty()) continue;
    const TrackSet seen = options.noise > 0 ? with_noise(set, options.noise, settings.seed) : set;
    write_spread_rows(spread, seen, set, settings.parameters, first);
  }
  if (!options.walking_rows.empty()) write_text(options.walking_rows, walking.str());
  if (!options.spread_rows.empty()) write_text(options.spread_rows, spread.str());
  return kExitDone;
}

nlohmann::ordered_json recording_json(const TrackSet& set, const MapFit* fit) {
  nlohmann::ordered_json on_map;
  if (fit != nullptr) on_map = {{"agents_on_wheels", fit->wheeled}, {"on_map", fit->on_map}};
  return {{"set", set.name},
          {"format", set.format},
          {"content", hash_text(content_of(set))},
          {"own_period_s", set.own_period},
          {"tracks", set.tracks.size()},
          {"filled_gaps", set.filled_gaps},
          {"filled_steps", set.filled_steps},
          {"split_gaps", set.split_gaps},
          {"notes", set.notes},
          {"map", on_map}};
}

void write_json(const PredictOptions& options, const CommonOptions& common, const Batch& batch,
                const std::vector<Evaluation>& evaluations) {
  PredictorParameters parameters = parameters_from(common);
  nlohmann::ordered_json json = {{"protocol", options.protocol},
                                 {"memory", options.memory},
                                 {"seed", common.seed},
                                 {"samples", options.samples},
                                 {"draws", options.draws},
                                 {"added_noise_m", options.noise},
                                 {"map", map_json(batch.map.get())}};
  for (const NamedParameter& parameter : named_parameters(parameters))
    json["parameters"][parameter.name] = *parameter.value;
  json["recordings"] = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < batch.sets.size(); ++k)
    json["recordings"].push_back(
        recording_json(batch.sets[k], batch.map ? &batch.fits[k] : nullptr));
  json["left_out"] = nlohmann::ordered_json::array();
  for (const auto& [file, why] : batch.left_out)
    json["left_out"].push_back({{"file", file}, {"why", why}});
  json["evaluations"] = nlohmann::ordered_json::array();
  for (const Evaluation& evaluation : evaluations)
    json["evaluations"].push_back(to_json(evaluation, evaluations, common.seed));
  write_text(options.json, json.dump(2) + "\n");
}

/// What is told to an export, where there is one.
ForecastSink export_sink(ExportTable* table, const ExportLabels& labels) {
  if (table == nullptr) return {};
  return [table, labels](const ScoredForecast& told) { table->add(labels, told); };
}

/// The settings for a recording, on the map that lies under it where there is one.
MethodSettings settings_for(const MethodSettings& settings, const TrackSet& set, const Batch& batch,
                            PredictionMap& map) {
  MethodSettings own = settings;
  if (batch.map == nullptr) return own;
  map = batch.map->under(set);
  own.map = &map;
  return own;
}

int run(const PredictOptions& options, const CommonOptions& common) {
  PredictorParameters parameters = parameters_from(common);
  if (options.list_parameters) {
    for (const NamedParameter& parameter : named_parameters(parameters))
      print(common.out, "predict.{}={:.10g}\n", parameter.name, *parameter.value);
    return kExitDone;
  }
  if (options.files.empty())
    throw Error("predict", "no recording given, expected one or more files");
  if (options.samples == 1)
    throw Error("--samples 1", "one sample is no distribution, expected 0 or at least 2");
  if (options.calibration && options.samples == 0)
    throw Error("--calibration", "is measured on samples, expected --samples N, too");
  const Protocol protocol = protocol_from_letter(options.protocol);
  const Memory memory = memory_from_name(options.memory);
  const MethodSettings settings{parameters, options.samples, common.seed,
                                draws_from_name(options.draws)};
  const std::vector<std::string> names =
      options.methods.empty() ? default_methods(options.ablations, memory, !options.map.map.empty())
                              : options.methods;
  const Batch batch = read_batch(options, protocol, common);
  if (!options.walking_rows.empty() || !options.spread_rows.empty())
    return write_training(options, settings, batch);
  const std::unique_ptr<ExportTable> exported =
      options.exported.empty() ? nullptr : make_export_table(options.exported);
  std::vector<Evaluation> evaluations;
  for (const TrackSet& truth : batch.sets) {
    const TrackSet seen = options.noise > 0 ? with_noise(truth, options.noise, common.seed) : truth;
    PredictionMap map;
    const MethodSettings own = settings_for(settings, truth, batch, map);
    for (const std::string& name : names) {
      if (interrupted()) return kExitInterrupted;
      if (!common.quiet) print(stderr, "{}: {}\n", truth.name, name);
      evaluations.push_back(
          evaluate(make_method(name, own, truth), seen, truth, protocol, memory,
                   export_sink(exported.get(), {truth.name, options.memory, name})));
    }
  }
  if (exported) exported->close();
  if (!options.plots.empty())
    for (const TrackSet& set : batch.sets) {
      PredictionMap map;
      write_plots(options.plots, set, protocol, settings_for(settings, set, batch, map));
    }
  print(common.out, "{}", to_table(evaluations, protocol, common.seed));
  if (options.calibration) print(common.out, "{}", calibration_table(evaluations));
  if (!options.json.empty()) write_json(options, common, batch, evaluations);
  return batch.left_out.empty() ? kExitDone : kExitNotHeld;
}

}  // namespace

CommandRunner add_predict_command(CLI::App& parent) {
  CLI::App* command =
      parent.add_subcommand("predict", "the prediction benchmark on recorded trajectories");
  auto options = std::make_shared<PredictOptions>();
  command->add_option("FILES", options->files,
                      "recordings; formats are told by looking: " + recording_formats());
  add_reading_options(*command, options->reading);
  add_map_options(*command, options->map);
  command
      ->add_option(
          "--protocol", options->protocol,
          "A (the paper's script), B (same windows, 12 true steps) or C (8 seen, 12 predicted)")
      ->capture_default_str();
  command
      ->add_option(
          "--memory", options->memory,
          "strict (each window by itself, as published methods are measured) or online (the "
          "recording so far may teach, everybody by the same means)")
      ->capture_default_str();
  command
      ->add_option("--method", options->methods,
                   "predictors to run; default: gamma and all baselines. Known: " + all_methods())
      ->delimiter(',');
  command->add_flag("--ablations", options->ablations,
                    "gamma with one part left out at a time, and the bound over its hypotheses");
  command
      ->add_option("--samples", options->samples,
                   "samples a prediction, for best-of-N, likelihood and calibration; 0: none")
      ->check(whole_number(0, 10000))
      ->capture_default_str();
  command
      ->add_option(
          "--draws", options->draws,
          "how samples are drawn: independent, or even (a sunflower over the distribution, "
          "which flatters the best of few)")
      ->capture_default_str();
  command->add_flag(
      "--calibration", options->calibration,
      "with --samples: how often the truth lies in the 50 and 90 % regions, by class, "
      "speed and step");
  command
      ->add_option("--noise", options->noise,
                   "disturb what is observed by normal noise of this deviation [m]")
      ->check(finite_number(0.0, 10.0))
      ->capture_default_str();
  command->add_option(
      "--export", options->exported,
      "write a row for each agent, window, step and sample to this file: Parquet where "
      "its name ends so, or else CSV");
  command->add_option("--json", options->json, "write all figures to this file");
  command->add_option("--plots", options->plots,
                      "write pictures (SVG) of the fullest frames to this folder");
  command->add_option("--walking-rows", options->walking_rows,
                      "write what tools/train_walking_model.py learns from to this file and end");
  command->add_option("--spread-rows", options->spread_rows,
                      "write what tools/train_spread.py learns from to this file and end");
  command->add_flag("--parameters", options->list_parameters, "print the parameters and end");
  return [options](const CommonOptions& common) { return run(*options, common); };
}

}  // namespace sumogamma
