#include "prediction/evaluation.h"

#include <algorithm>

#include "base/cpu_time.h"
#include "prediction/predictor_parameters.h"

namespace sumogamma {

namespace {

constexpr double kMiss = 2.0;  // [m]

void score_samples(const Track& truth, int frame, std::size_t row,
                   const std::vector<Forecast>& samples, const Protocol& protocol,
                   WindowScore& score) {
  score.best_average = score.best_final = 1e300;
  for (const Forecast& sample : samples) {
    const WindowError error = window_error(truth, frame, sample.row(row), protocol);
    score.best_average = std::min(score.best_average, error.average);
    score.best_final = std::min(score.best_final, error.final);
  }
  const auto now = static_cast<std::size_t>(frame - truth.first);
  const std::size_t steps =
      static_cast<std::size_t>(protocol.steps) - (protocol.counts_present ? 1 : 0);
  std::vector<Vec2> points(samples.size());
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t s = 0; s < samples.size(); ++s) points[s] = samples[s].row(row)[k];
    const PointScore point = score_point(points, truth.position[now + 1 + k]);
    score.log_loss += point.log_loss;
    score.energy += point.energy;
    score.inside_50 += point.inside_50;
    score.inside_90 += point.inside_90;
    score.by_step.push_back(point);
  }
  const double n = static_cast<double>(steps);
  score.log_loss /= n;
  score.energy /= n;
  score.inside_50 /= n;
  score.inside_90 /= n;
}

/// Rows of the scene's agents that have been seen long enough, and their tracks.
struct Predicted {
  std::vector<std::size_t> rows, tracks;
};

Predicted predicted_agents(const TrackSet& set, const ObservedScene& scene,
                           const Protocol& protocol) {
  Predicted predicted;
  std::size_t track = 0;
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    while (set.tracks[track].id != scene.agents[row].id) ++track;
    if (static_cast<int>(scene.agents[row].position.size()) < protocol.observed) continue;
    predicted.rows.push_back(row);
    predicted.tracks.push_back(track);
  }
  return predicted;
}

/// All that was predicted at a frame.
struct Told {
  const ObservedScene& scene;
  const Predicted& predicted;
  const Forecast& forecast;
  const std::vector<Forecast>& samples;
  const Protocol& protocol;
  const ForecastSink& sink;
};

WindowScore score_window(const TrackSet& truth, const Window& window, const Told& told) {
  const Track& track = truth.tracks[window.track];
  const std::vector<std::size_t>& tracks = told.predicted.tracks;
  const auto at = std::find(tracks.begin(), tracks.end(), window.track);
  const std::size_t row = told.predicted.rows[static_cast<std::size_t>(at - tracks.begin())];
  WindowScore score;
  score.track = window.track;
  score.frame = window.frame;
  score.type = track.type;
  score.speed = told.scene.agents[row].last_velocity(told.scene.period).norm();
  score.error = window_error(track, window.frame, told.forecast.row(row), told.protocol);
  if (!told.samples.empty())
    score_samples(track, window.frame, row, told.samples, told.protocol, score);
  if (!told.sink) return score;
  const auto scored = static_cast<std::size_t>(told.protocol.steps - told.protocol.counts_present);
  told.sink({track, window.frame, 0, 1.0, told.forecast.row(row).first(scored)});
  for (std::size_t s = 0; s < told.samples.size(); ++s)
    told.sink({track, window.frame, s + 1, 1.0 / static_cast<double>(told.samples.size()),
               told.samples[s].row(row).first(scored)});
  return score;
}

/// Lets a method know only the frames [first, last] of a recording.
void show_window(const Method& method, const TrackSet& window) {
  if (method.forget) method.forget();
  if (!method.observe && !method.observe_in_window) return;
  for (int frame = window.first_frame; frame <= window.last_frame; ++frame) {
    const ObservedScene scene = observe(window, frame);
    if (method.observe_in_window)
      method.observe_in_window(scene, static_cast<std::size_t>(window.last_frame - frame));
    else
      method.observe(scene);
  }
}

}  // namespace

Evaluation evaluate(const Method& method, const TrackSet& set, const TrackSet& truth,
                    const Protocol& protocol, Memory memory, const ForecastSink& sink) {
  const AgentTypeTable types = recorded_agent_types();
  const std::vector<Window> windows = windows_of(set, protocol);
  const std::size_t steps = static_cast<std::size_t>(protocol.steps);
  const std::size_t scored = steps - (protocol.counts_present ? 1 : 0);
  Evaluation result;
  result.set = set.name;
  result.method = method.name;
  result.title = method.title;
  result.memory = memory;
  result.in_training = trained_on(content_of(truth));
  result.has_samples = static_cast<bool>(method.sample);
  result.draws = method.draws;
  std::size_t next = 0;
  for (int frame = set.first_frame; frame <= set.last_frame; ++frame) {
    const bool strict = memory == Memory::Strict;
    const TrackSet window =
        strict ? window_of(set, frame - protocol.observed + 1, frame) : TrackSet{};
    const ObservedScene scene = observe(strict ? window : set, frame);
    const Predicted predicted = predicted_agents(set, scene, protocol);
    if (strict && predicted.rows.empty()) continue;
    const double begin = process_cpu_seconds();
    if (strict)
      show_window(method, window);
    else if (method.observe)
      method.observe(scene);
    Forecast forecast;
    if (!predicted.rows.empty()) forecast = method.predict(scene, steps);
    result.cpu_seconds += process_cpu_seconds() - begin;
    if (predicted.rows.empty()) continue;
    result.predictions += static_cast<std::int64_t>(predicted.rows.size());
    result.collisions.add(count_collisions(types, scene, forecast, predicted.rows, scored));
    result.true_collisions.add(
        count_true_collisions(types, truth, frame, predicted.tracks, scored));
    if (next >= windows.size() || windows[next].frame != frame) continue;
    std::vector<Forecast> samples;
    if (method.sample) samples = method.sample(scene, steps);
    for (const Forecast& sample : samples)
      result.sample_collisions.add(count_collisions(types, scene, sample, predicted.rows, scored));
    const Told told{scene, predicted, forecast, samples, protocol, sink};
    for (; next < windows.size() && windows[next].frame == frame; ++next)
      result.windows.push_back(score_window(truth, windows[next], told));
  }
  return result;
}

Summary summarize(const Evaluation& evaluation,
                  const std::function<bool(const WindowScore&)>& chosen) {
  Summary sum;
  for (const WindowScore& window : evaluation.windows) {
    if (chosen && !chosen(window)) continue;
    ++sum.windows;
    sum.average += window.error.average;
    sum.final += window.error.final;
    sum.miss_rate += window.error.final > kMiss ? 1.0 : 0.0;
    sum.best_average += window.best_average;
    sum.best_final += window.best_final;
    sum.log_loss += window.log_loss;
    sum.energy += window.energy;
    sum.inside_50 += window.inside_50;
    sum.inside_90 += window.inside_90;
  }
  if (sum.windows == 0) return sum;
  for (double* value :
       {&sum.average, &sum.final, &sum.miss_rate, &sum.best_average, &sum.best_final, &sum.log_loss,
        &sum.energy, &sum.inside_50, &sum.inside_90})
    *value /= static_cast<double>(sum.windows);
  return sum;
}

std::vector<PointScore> summarize_steps(const Evaluation& evaluation,
                                        const std::function<bool(const WindowScore&)>& chosen) {
  std::vector<PointScore> mean;
  double windows = 0;
  for (const WindowScore& window : evaluation.windows) {
    if (window.by_step.empty() || (chosen && !chosen(window))) continue;
    windows += 1;
    mean.resize(window.by_step.size());
    for (std::size_t k = 0; k < mean.size(); ++k) {
      mean[k].log_loss += window.by_step[k].log_loss;
      mean[k].energy += window.by_step[k].energy;
      mean[k].inside_50 += window.by_step[k].inside_50;
      mean[k].inside_90 += window.by_step[k].inside_90;
    }
  }
  for (PointScore& step : mean)
    for (double* value : {&step.log_loss, &step.energy, &step.inside_50, &step.inside_90})
      *value /= windows;
  return mean;
}

}  // namespace sumogamma
