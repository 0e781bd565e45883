#include "realism/score.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>

#include "base/edit_distance.h"
#include "base/error.h"
#include "base/random.h"
#include "realism/controls.h"
#include "realism/map_features.h"
#include "realism/sumo_free_run.h"
#include "realism/sumo_loop.h"

namespace sumogamma {

namespace {

constexpr int kPart = 3000;               // five minutes [steps]
constexpr std::size_t kResamples = 1000;  // of the interval

constexpr std::array<ScoreMethodInfo, 9> kMethods{{
    {"log", "replay of the recording"},
    {"stand", "everybody stands"},
    {"cv", "constant velocity"},
    {"cv-fan", "fan of constant velocity"},
    {"gamma", "GAMMA in closed loop"},
    {"sumo-krauss", "SUMO, Krauss", true},
    {"sumo-idm", "SUMO, IDM", true},
    {"sumo-eidm", "SUMO, EIDM", true},
    {"sumo-sublane", "SUMO, Krauss, sublane", true},
}};

/// What all windows of a recording share.
struct Scoring {
  const RecordedScene& scene;
  const ScoreSettings& settings;
  const std::vector<ScoreWindow>& windows;
  const std::vector<MotionFeatures>& log;  ///< by window
  const ClosedLoop& loop;
  const RoadLoop* roads;   ///< null: open ground
  const SumoLoop* sumo;    ///< likewise
  const MapFeatures* map;  ///< likewise
  Workers& workers;
};

std::vector<Rollout> rollouts_of(const Scoring& scoring, const ScoreWindow& window,
                                 MethodScore& score) {
  const ScoreSettings& settings = scoring.settings;
  if (score.name == "log") return replay_log(scoring.scene, window);
  if (score.name == "stand") return stand_still(scoring.scene, window);
  if (score.name == "cv") return keep_velocity(scoring.scene, window);
  if (score.name == "cv-fan")
    return fan_out(scoring.scene, window, settings.seed, settings.rollouts);
  if (score.name != "gamma" && scoring.sumo)
    return scoring.sumo->drive(window, score.name, settings.seed, settings.rollouts, score.entries);
  std::vector<Rollout> rollouts;
  for (std::size_t r = 0; r < settings.rollouts; ++r)
    rollouts.push_back(scoring.roads
                           ? scoring.roads->drive(window, settings.seed + r, score.entries)
                           : scoring.loop.drive(window, settings.seed + r, score.entries));
  return rollouts;
}

void add_window(const Scoring& scoring, std::size_t index, MethodScore& score) {
  const ScoreWindow& window = scoring.windows[index];
  const std::vector<Rollout> rollouts = rollouts_of(scoring, window, score);
  score.rollouts = rollouts.size();
  std::vector<MotionFeatures> features(rollouts.size());
  std::vector<MotionCounts> counts(rollouts.size());
  scoring.workers.for_each_range(
      rollouts.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t r = begin; r < end; ++r) {
          const Poses& poses = rollouts[r].poses;
          features[r] = features_of(poses, window.bodies);
          if (scoring.map) scoring.map->add(window, scoring.scene.first, poses, features[r]);
          counts[r].add_motion(features[r]);
          counts[r].add_encroachments(poses, window.bodies);
        }
      });
  for (const MotionCounts& one : counts) score.counts.add(one);
  ScoreSums all;
  for (const auto& [type, sums] :
       score_window(scoring.scene, window, scoring.log[index], rollouts, features)) {
    score.by_type[type].add(sums);
    all.add(sums);
  }
  score.sums.add(all);
  score.by_window.push_back(all);
}

FreeRun free_run_of(const Scoring& scoring, const SumoFreeRuns* sumo, const std::string& method,
                    std::uint64_t seed) {
  if (method != "gamma" && sumo) return sumo->drive(method, seed);
  return scoring.roads ? scoring.roads->drive_freely(seed) : scoring.loop.drive_freely(seed);
}

/// All methods' free runs; those so far where `progress` ends them.
void drive_all_freely(const Scoring& scoring, const ScoreProgress& progress,
                      RecordingScore& result) {
  const ScoreSettings& settings = scoring.settings;
  if (settings.free_runs == 0) return;
  result.free_log = count_motion(scoring.scene);
  std::vector<std::size_t> everybody(scoring.scene.agents.size());
  std::iota(everybody.begin(), everybody.end(), std::size_t{0});
  result.free_lateral_deviation = settings.road
                                      ? lateral_deviation(*settings.road, scoring.scene, everybody)
                                      : std::numeric_limits<double>::quiet_NaN();
  std::optional<SumoFreeRuns> sumo;
  if (settings.road) sumo.emplace(scoring.scene, *settings.road);
  for (const std::string& name : settings.methods) {
    if (!drives_by_itself(name)) continue;
    std::vector<FreeRun> runs;
    for (std::size_t k = 0; k < settings.free_runs; ++k) {
      if (progress && !progress(name + ", freely", k, settings.free_runs)) return;
      runs.push_back(free_run_of(scoring, sumo ? &*sumo : nullptr, name, settings.seed + k));
    }
    result.free_scores.push_back(score_free_runs(scoring.scene, settings.road, name, runs));
  }
}

/// The composite's interval: windows are drawn with repetition.
void find_interval(std::uint64_t seed, MethodScore& score) {
  const std::size_t windows = score.by_window.size();
  score.composite_low = score.composite_high = std::numeric_limits<double>::quiet_NaN();
  if (windows < 2) return;
  std::vector<double> composites;
  for (std::size_t sample = 0; sample < kResamples; ++sample) {
    ScoreSums sums;
    for (std::size_t k = 0; k < windows; ++k) {
      const double draw = random_uniform(seed, sample, k, Draw::Bootstrap);
      sums.add(score.by_window[static_cast<std::size_t>(draw * static_cast<double>(windows))]);
    }
    composites.push_back(figures_of(sums).composite);
  }
  std::sort(composites.begin(), composites.end());
  score.composite_low = composites[kResamples / 40];
  score.composite_high = composites[kResamples - 1 - kResamples / 40];
}

/// The recording's own distributions, of all of it and of its parts of five minutes.
std::vector<MotionCounts> count_log(const Scoring& scoring, MotionCounts& all) {
  std::vector<MotionCounts> parts;
  const int whole = (scoring.scene.last - scoring.scene.first) / kPart;
  if (whole > 0) parts.resize(static_cast<std::size_t>(whole));
  for (std::size_t k = 0; k < scoring.windows.size(); ++k) {
    const ScoreWindow& window = scoring.windows[k];
    MotionCounts counts;
    counts.add_motion(scoring.log[k]);
    counts.add_encroachments(window.log, window.bodies);
    all.add(counts);
    const auto part = static_cast<std::size_t>((window.start - scoring.scene.first) / kPart);
    if (part < parts.size()) parts[part].add(counts);
  }
  return parts;
}

}  // namespace

std::vector<ScoreMethodInfo> score_methods() { return {kMethods.begin(), kMethods.end()}; }

bool drives_by_itself(const std::string& method) {
  return method == "gamma" || method.starts_with("sumo-");
}

void require_score_method(const std::string& name) {
  std::string known;
  for (const ScoreMethodInfo& info : kMethods) {
    if (name == info.name) return;
    known += (known.empty() ? "" : ", ") + std::string(info.name);
  }
  const auto nearest =
      nearest_named(name, kMethods, [](const ScoreMethodInfo& info) { return info.name; });
  throw Error("--method " + name, "is no method of scores, did you mean " +
                                      std::string(nearest->name) + "? There are " + known);
}

RecordingScore score_recording(const RecordedScene& scene, const ScoreSettings& settings,
                               Workers& workers, const ScoreProgress& progress) {
  const Windows found = windows_of(scene);
  std::vector<MotionFeatures> log;
  const ClosedLoop loop(scene, settings.model, settings.behavior, workers);
  std::optional<RoadLoop> roads;
  std::optional<SumoLoop> sumo;
  std::optional<MapFeatures> map;
  if (settings.road) {
    map.emplace(*settings.road);
    roads.emplace(scene, *settings.road, settings.model, settings.behavior, workers);
    sumo.emplace(scene, *settings.road);
  }
  for (const ScoreWindow& window : found.windows) {
    log.push_back(features_of(window.log, window.bodies));
    if (map) map->add(window, scene.first, window.log, log.back());
  }
  const Scoring scoring{scene,
                        settings,
                        found.windows,
                        log,
                        loop,
                        roads ? &*roads : nullptr,
                        sumo ? &*sumo : nullptr,
                        map ? &*map : nullptr,
                        workers};
  RecordingScore result;
  result.name = scene.name;
  result.windows = found.windows.size();
  result.left_out = found.left_out;
  for (const ScoreWindow& window : found.windows) result.scored += window.agents.size();
  const std::vector<MotionCounts> parts = count_log(scoring, result.log);
  result.parts = parts.size();
  result.noise_floor = noise_floor(parts);
  for (const std::string& name : settings.methods) {
    MethodScore score;
    score.name = name;
    for (std::size_t k = 0; k < found.windows.size(); ++k) {
      if (progress && !progress(name, k, found.windows.size())) return result;
      add_window(scoring, k, score);
    }
    find_interval(settings.seed, score);
    result.methods.push_back(std::move(score));
  }
  drive_all_freely(scoring, progress, result);
  return result;
}

}  // namespace sumogamma
