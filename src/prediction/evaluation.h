#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prediction/accuracy.h"
#include "prediction/distribution.h"
#include "prediction/observed_scene.h"
#include "prediction/protocol.h"

namespace sumogamma {

/// A predictor as the evaluation calls it: `observe` once a frame in order (may be empty), then
/// `predict` for the same scene, then `sample` (may be empty) for its distribution. `forget` (may
/// be empty) makes it as new: nothing of what was observed may remain.
struct Method {
  std::string name, title;
  std::function<void(const ObservedScene&)> observe;
  std::function<Forecast(const ObservedScene&, std::size_t steps)> predict;
  std::function<std::vector<Forecast>(const ObservedScene&, std::size_t steps)> sample;
  std::function<void()> forget;
  /// Where given, it is called in place of `observe` in strict windows, with the number of frames
  /// of the window that are still to come.
  std::function<void(const ObservedScene&, std::size_t later)> observe_in_window = {};
  std::string draws = {};  ///< how samples are drawn
};

/// The method that is gamma but for the map.
inline constexpr const char* kWithoutMap = "gamma-no-map";

/// Scores of one window.
struct WindowScore {
  std::size_t track = 0;
  int frame = 0;
  AgentTypeId type{};
  double speed = 0;                         ///< of the last displacement [m/s]
  WindowError error;                        ///< of the prediction [m]
  double best_average = 0, best_final = 0;  ///< least over the samples, each by itself [m]
  double log_loss = 0;                      ///< mean negative log density over the steps [nat]
  double energy = 0;                        ///< mean energy score over the steps [m]
  double inside_50 = 0, inside_90 = 0;      ///< share of the steps whose truth lies in the region
  std::vector<PointScore> by_step;          ///< of the samples, where there are any
};

/// One method on one recording.
struct Evaluation {
  std::string set, method, title;
  Memory memory = Memory::Strict;
  std::vector<WindowScore> windows;
  CollisionCount collisions, true_collisions;
  CollisionCount sample_collisions;  ///< within each sample, all samples together
  bool has_samples = false;
  std::string draws;             ///< how samples were drawn
  bool in_training = false;      ///< parameters were chosen on these very tracks
  double cpu_seconds = 0;        ///< in observe and predict, without samples
  std::int64_t predictions = 0;  ///< agents predicted with a full history
};

/// What is told of every scored window: its track, its present frame, which sample (0: the
/// prediction itself, then 1, 2, ...), the sample's weight, and the scored positions.
struct ScoredForecast {
  const Track& truth;
  int frame;
  std::size_t sample;
  double weight;
  std::span<const Vec2> predicted;
};
using ForecastSink = std::function<void(const ScoredForecast&)>;

/// Runs a method over a recording and scores all windows. Online: frame by frame from the
/// beginning. Strict: for every frame anew, from the frames that the protocol lets be seen and no
/// others. `set` is what the method sees, `truth` what it is scored against (the same recording,
/// unless noise was added). `sink`, where given, gets everything that is scored.
Evaluation evaluate(const Method& method, const TrackSet& set, const TrackSet& truth,
                    const Protocol& protocol, Memory memory, const ForecastSink& sink = {});

/// Means over the windows for which `chosen` holds; null for none.
struct Summary {
  std::size_t windows = 0;
  double average = 0, final = 0, miss_rate = 0;  ///< miss: final error over 2 m
  double best_average = 0, best_final = 0, log_loss = 0, energy = 0, inside_50 = 0, inside_90 = 0;
};
Summary summarize(const Evaluation& evaluation,
                  const std::function<bool(const WindowScore&)>& chosen = {});

/// Means by step over the windows for which `chosen` holds; empty for none or without samples.
std::vector<PointScore> summarize_steps(const Evaluation& evaluation,
                                        const std::function<bool(const WindowScore&)>& chosen);

}  // namespace sumogamma
