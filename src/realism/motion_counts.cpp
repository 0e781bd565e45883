#include "realism/motion_counts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "scene/scene.h"
#include "study/safety/encroachment.h"

namespace sumogamma {

namespace {

constexpr std::size_t kLookEvery = 5;  // steps from one look to the next
constexpr double kAccelerates = 0.5, kTurns = 1.0, kFollows = 2.0;  // from these speeds on [m/s]
constexpr double kLongestGap = 6.0;                                 // [s]

/// Everybody who is there at a step.
Scene scene_at(const Poses& poses, const Bodies& bodies, std::size_t step) {
  Scene scene;
  scene.time = kScoreStep * static_cast<double>(step);
  for (std::size_t row = 0; row < poses.rows(); ++row) {
    if (step >= bodies.present[row]) continue;
    const std::size_t at = row * Poses::kSteps + step;
    const Vec2 velocity = step == 0
                              ? Vec2(Vec2::Zero())
                              : Vec2((poses.position[at] - poses.position[at - 1]) / kScoreStep);
    append_body(scene, row, {poses.position[at], velocity, poses.heading[at]}, bodies.size[row]);
  }
  return scene;
}

}  // namespace

const std::array<CountedMeasureInfo, kCountedMeasures>& counted_measures() {
  static constexpr std::array<CountedMeasureInfo, kCountedMeasures> kMeasures{{
      {"speed", "m/s", {0, 16, 32}},
      {"acceleration", "m/s²", {-4, 4, 16}},
      {"yaw_rate", "rad/s", {-0.628, 0.628, 11}},
      {"nearest", "m", {-5, 40, 45}},
      {"ttc", "s", {0, 5, 10}},
      {"time_gap", "s", {0, 6, 12}},
      {"pet", "s", {0, 10, 10}},
  }};
  return kMeasures;
}

MotionCounts::MotionCounts() {
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    counts[k].assign(counted_measures()[k].bins.count, 0.0);
}

void MotionCounts::add(const MotionCounts& other) {
  for (std::size_t k = 0; k < kCountedMeasures; ++k)
    std::transform(counts[k].begin(), counts[k].end(), other.counts[k].begin(), counts[k].begin(),
                   std::plus<>());
}

double MotionCounts::total(CountedMeasure measure) const {
  const std::vector<double>& of = counts[static_cast<std::size_t>(measure)];
  return std::accumulate(of.begin(), of.end(), 0.0);
}

void MotionCounts::add_motion(const MotionFeatures& features) {
  const auto count = [&](CountedMeasure measure, double value) {
    const auto k = static_cast<std::size_t>(measure);
    if (std::isfinite(value)) counts[k][counted_measures()[k].bins.index(value)] += 1.0;
  };
  for (std::size_t row = 0; row < features.speed.size(); row += Poses::kSteps)
    for (std::size_t at = row + kLookEvery; at < row + Poses::kSteps; at += kLookEvery) {
      const double speed = features.speed[at];
      count(CountedMeasure::Speed, speed);
      if (speed > kAccelerates) count(CountedMeasure::Acceleration, features.acceleration[at]);
      if (speed > kTurns) count(CountedMeasure::YawRate, features.yaw_rate[at]);
      count(CountedMeasure::Nearest, features.nearest[at]);
      count(CountedMeasure::TimeToCollision, features.time_to_collision[at]);
      const double time_gap = features.gap[at] / speed;
      if (speed > kFollows && time_gap < kLongestGap) count(CountedMeasure::TimeGap, time_gap);
    }
}

void MotionCounts::add_encroachments(const Poses& poses, const Bodies& bodies) {
  add_encroachments(
      Poses::kSteps, [&](std::size_t step) { return scene_at(poses, bodies, step); },
      EncroachmentMonitor::kLongest);
}

void MotionCounts::add_encroachments(std::size_t steps,
                                     const std::function<Scene(std::size_t step)>& scene_at,
                                     double longest) {
  EncroachmentMonitor monitor(kScoreStep, longest);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> least;
  for (std::size_t step = 0; step < steps; ++step) {
    const Scene scene = scene_at(step);
    for (const Encroachment& found : monitor.add(scene)) {
      const auto [pair, first] =
          least.try_emplace({scene.id[found.row].value, found.before.value}, found.time);
      pair->second = std::min(pair->second, found.time);
    }
  }
  constexpr auto kPet = static_cast<std::size_t>(CountedMeasure::PostEncroachment);
  for (const auto& [pair, time] : least)
    counts[kPet][counted_measures()[kPet].bins.index(time)] += 1.0;
}

void append_body(Scene& scene, std::size_t row, const MotionState& state, const Vec2& size) {
  AgentState agent;
  agent.id = {static_cast<std::uint32_t>(row)};
  agent.footprint = box_footprint(size.x(), size.y());
  agent.position = state.position;
  agent.heading = state.heading;
  append_agent(scene, agent);
  scene.velocity.back() = state.velocity;
}

std::array<double, kCountedMeasures> hellinger(const MotionCounts& a, const MotionCounts& b) {
  std::array<double, kCountedMeasures> distances{};
  for (std::size_t k = 0; k < kCountedMeasures; ++k) {
    const auto measure = static_cast<CountedMeasure>(k);
    distances[k] = a.total(measure) > 0 && b.total(measure) > 0
                       ? distance_of(a.counts[k], b.counts[k], 1.0).hellinger
                       : std::numeric_limits<double>::quiet_NaN();
  }
  return distances;
}

std::vector<double> noise_floor(const std::vector<MotionCounts>& parts) {
  if (parts.size() < 2) return {};
  std::vector<double> sums(kCountedMeasures, 0.0), pairs(kCountedMeasures, 0.0);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      const std::array<double, kCountedMeasures> apart = hellinger(parts[i], parts[j]);
      for (std::size_t k = 0; k < kCountedMeasures; ++k) {
        if (std::isnan(apart[k])) continue;
        sums[k] += apart[k];
        pairs[k] += 1.0;
      }
    }
  for (std::size_t k = 0; k < kCountedMeasures; ++k) sums[k] /= pairs[k];
  return sums;
}

}  // namespace sumogamma
