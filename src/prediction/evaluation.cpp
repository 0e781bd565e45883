#include "prediction/evaluation.h"

#include <time.h>

#include <algorithm>

#include "prediction/distribution.h"

namespace sumogamma {

namespace {

constexpr double kMiss = 2.0;  // [m]

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

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

}  // namespace

Evaluation evaluate(const Method& method, const TrackSet& set, const TrackSet& truth,
                    const Protocol& protocol) {
  const AgentTypeTable types = recorded_agent_types();
  const std::vector<Window> windows = windows_of(set, protocol);
  const std::size_t steps = static_cast<std::size_t>(protocol.steps);
  const std::size_t scored = steps - (protocol.counts_present ? 1 : 0);
  Evaluation result;
  result.set = set.name;
  result.method = method.name;
  result.title = method.title;
  result.has_samples = static_cast<bool>(method.sample);
  std::size_t next = 0;
  for (int frame = set.first_frame; frame <= set.last_frame; ++frame) {
    const ObservedScene scene = observe(set, frame);
    const Predicted predicted = predicted_agents(set, scene, protocol);
    const double begin = cpu_seconds();
    if (method.observe) method.observe(scene);
    Forecast forecast;
    if (!predicted.rows.empty()) forecast = method.predict(scene, steps);
    result.cpu_seconds += cpu_seconds() - begin;
    if (predicted.rows.empty()) continue;
    result.predictions += static_cast<std::int64_t>(predicted.rows.size());
    result.collisions.add(count_collisions(types, scene, forecast, predicted.rows, scored));
    result.true_collisions.add(
        count_true_collisions(types, truth, frame, predicted.tracks, scored));
    if (next >= windows.size() || windows[next].frame != frame) continue;
    std::vector<Forecast> samples;
    if (method.sample) samples = method.sample(scene, steps);
    for (; next < windows.size() && windows[next].frame == frame; ++next) {
      const Track& track = truth.tracks[windows[next].track];
      const auto at =
          std::find(predicted.tracks.begin(), predicted.tracks.end(), windows[next].track);
      const std::size_t row =
          predicted.rows[static_cast<std::size_t>(at - predicted.tracks.begin())];
      WindowScore score;
      score.track = windows[next].track;
      score.frame = frame;
      score.type = track.type;
      score.speed = scene.agents[row].last_velocity(scene.period).norm();
      score.error = window_error(track, frame, forecast.row(row), protocol);
      if (!samples.empty()) score_samples(track, frame, row, samples, protocol, score);
      result.windows.push_back(score);
    }
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

}  // namespace sumogamma
