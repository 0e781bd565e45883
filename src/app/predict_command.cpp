#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/print.h"
#include "prediction/methods.h"
#include "prediction/plot.h"
#include "prediction/report.h"

namespace sumogamma {

namespace {

struct PredictOptions {
  std::vector<std::string> files;
  std::string protocol = "C";
  std::vector<std::string> methods;
  std::size_t samples = 0;
  double noise = 0;
  bool ablations = false;
  std::string json, plots;
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

int run(const PredictOptions& options, const CommonOptions& common) {
  PredictorParameters parameters = parameters_from(common);
  if (options.list_parameters) {
    for (const NamedParameter& parameter : named_parameters(parameters))
      print(stdout, "predict.{}={:.10g}\n", parameter.name, *parameter.value);
    return kExitDone;
  }
  if (options.files.empty())
    throw Error("predict", "no recording given, expected one or more files");
  if (options.samples == 1)
    throw Error("--samples 1", "one sample is no distribution, expected 0 or at least 2");
  const Protocol protocol = protocol_from_letter(options.protocol);
  const MethodSettings settings{parameters, options.samples, common.seed};
  const std::vector<std::string> names =
      options.methods.empty() ? default_methods(options.ablations) : options.methods;
  std::vector<Evaluation> evaluations;
  for (const std::string& file : options.files) {
    const TrackSet truth = read_track_set(file);
    if (windows_of(truth, protocol).empty())
      throw Error(file,
                  "nobody is there for " + std::to_string(protocol.observed + protocol.steps) +
                      " frames without a gap, as protocol " + std::string(1, protocol.letter) +
                      " needs; check the columns and that frames are a constant step apart");
    const TrackSet seen = options.noise > 0 ? with_noise(truth, options.noise, common.seed) : truth;
    for (const std::string& name : names) {
      if (interrupted()) return kExitInterrupted;
      if (!common.quiet) print(stderr, "{}: {}\n", truth.name, name);
      evaluations.push_back(evaluate(make_method(name, settings, truth), seen, truth, protocol));
    }
  }
  if (!options.plots.empty())
    for (const std::string& file : options.files)
      write_plots(options.plots, read_track_set(file), protocol, settings);
  print(stdout, "{}", to_table(evaluations, protocol, common.seed));
  if (options.json.empty()) return kExitDone;
  nlohmann::ordered_json json = {{"protocol", std::string(1, protocol.letter)},
                                 {"seed", common.seed},
                                 {"samples", options.samples},
                                 {"added_noise_m", options.noise}};
  for (const NamedParameter& parameter : named_parameters(parameters))
    json["parameters"][parameter.name] = *parameter.value;
  json["evaluations"] = nlohmann::ordered_json::array();
  for (const Evaluation& evaluation : evaluations)
    json["evaluations"].push_back(to_json(evaluation, common.seed));
  write_text(options.json, json.dump(2) + "\n");
  return kExitDone;
}

}  // namespace

CommandRunner add_predict_command(CLI::App& parent) {
  CLI::App* command =
      parent.add_subcommand("predict", "the prediction benchmark on recorded trajectories");
  auto options = std::make_shared<PredictOptions>();
  command->add_option("FILES", options->files,
                      "recordings: CSV or the common text format (frame id x y)");
  command
      ->add_option(
          "--protocol", options->protocol,
          "A (the paper's script), B (same windows, 12 true steps) or C (8 seen, 12 predicted)")
      ->capture_default_str();
  command
      ->add_option("--method", options->methods,
                   "predictors to run; default: gamma and all baselines")
      ->delimiter(',');
  command->add_flag("--ablations", options->ablations,
                    "gamma with one part left out at a time, and the bound over its hypotheses");
  command
      ->add_option("--samples", options->samples,
                   "samples a prediction, for best-of-N, likelihood and calibration; 0: none")
      ->check(whole_number(0, 10000))
      ->capture_default_str();
  command
      ->add_option("--noise", options->noise,
                   "disturb what is observed by normal noise of this deviation [m]")
      ->check(finite_number(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--json", options->json, "write all figures to this file");
  command->add_option("--plots", options->plots,
                      "write pictures (SVG) of the fullest frames to this folder");
  command->add_flag("--parameters", options->list_parameters, "print the parameters and end");
  return [options](const CommonOptions& common) { return run(*options, common); };
}

}  // namespace sumogamma
