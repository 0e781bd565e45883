#include "realism/likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sumogamma {

namespace {

constexpr double kPseudoCount = 0.1, kEventPseudoCount = 0.001;

double exp_mean(double sum, std::size_t count) {
  if (count == 0) return std::numeric_limits<double>::quiet_NaN();
  return std::exp(sum / static_cast<double>(count));
}

double ratio(double of, double to) {
  return to > 0 ? of / to : std::numeric_limits<double>::quiet_NaN();
}

/// The values of one row.
std::span<const double> values_of(const std::vector<double>& values, std::size_t row) {
  return std::span(values).subspan(row * Poses::kSteps, Poses::kSteps);
}

bool leaves_road(const MotionFeatures& features, std::size_t row) {
  const std::span<const double> out = values_of(features.road_edge, row);
  return std::any_of(out.begin(), out.end(), [](double distance) { return distance > 0.0; });
}

bool runs_red(const MotionFeatures& features, std::size_t row) {
  return features.ran_red[row] != 0;
}

/// Is a feature there without a map?
bool needs_map(ScoreFeature feature) { return feature >= ScoreFeature::RoadEdge; }

double way_of(const Poses& poses, std::size_t row, std::size_t present) {
  double way = 0;
  for (std::size_t k = row * Poses::kSteps + 1; k < row * Poses::kSteps + present; ++k)
    way += (poses.position[k] - poses.position[k - 1]).norm();
  return way;
}

double mean_error(const Poses& poses, const Poses& log, std::size_t row, std::size_t present) {
  double sum = 0;
  for (std::size_t k = row * Poses::kSteps + 1; k < row * Poses::kSteps + present; ++k)
    sum += (poses.position[k] - log.position[k]).norm();
  return sum / static_cast<double>(present - 1);
}

/// The values of one row over all rollouts, one after another.
void gather(std::span<const MotionFeatures> features,
            const std::vector<double> MotionFeatures::*values, std::size_t row,
            std::vector<double>& gathered) {
  gathered.clear();
  for (const MotionFeatures& one : features) {
    const std::span<const double> of_row = values_of(one.*values, row);
    gathered.insert(gathered.end(), of_row.begin(), of_row.end());
  }
}

void add_likelihoods(const MotionFeatures& log, std::span<const MotionFeatures> features,
                     std::size_t row, ScoreSums& sums) {
  std::vector<double> gathered;
  for (std::size_t k = 0; k < kScoreFeatures; ++k) {
    const ScoreFeatureInfo& info = score_features()[k];
    if (needs_map(info.feature) && log.road_edge.empty()) continue;
    double mean = 0;
    if (info.happens) {
      const auto happened =
          std::count_if(features.begin(), features.end(),
                        [&](const MotionFeatures& one) { return info.happens(one, row); });
      mean = event_log_likelihood(info.happens(log, row), static_cast<std::size_t>(happened),
                                  features.size());
    } else {
      gather(features, info.values, row, gathered);
      mean = mean_log_likelihood(values_of(log.*info.values, row), gathered, info.bins);
    }
    if (std::isnan(mean)) continue;
    sums.log_likelihood[k] += mean;
    ++sums.agents[k];
  }
}

}  // namespace

const std::array<ScoreFeatureInfo, kScoreFeatures>& score_features() {
  static const std::array<ScoreFeatureInfo, kScoreFeatures> kFeatures{{
      {ScoreFeature::Speed, "speed", {0, 25, 10}, 0.05, &MotionFeatures::speed, nullptr},
      {ScoreFeature::Acceleration,
       "acceleration",
       {-12, 12, 11},
       0.05,
       &MotionFeatures::acceleration,
       nullptr},
      {ScoreFeature::YawRate,
       "yaw_rate",
       {-0.628, 0.628, 11},
       0.05,
       &MotionFeatures::yaw_rate,
       nullptr},
      {ScoreFeature::YawAcceleration,
       "yaw_acceleration",
       {-3.14, 3.14, 11},
       0.05,
       &MotionFeatures::yaw_acceleration,
       nullptr},
      {ScoreFeature::Nearest, "nearest", {-5, 40, 10}, 0.10, &MotionFeatures::nearest, nullptr},
      {ScoreFeature::TimeToCollision,
       "ttc",
       {0, 5, 10},
       0.10,
       &MotionFeatures::time_to_collision,
       nullptr},
      {ScoreFeature::Collision, "collision", {0, 1, 1}, 0.25, nullptr, collides},
      {ScoreFeature::RoadEdge,
       "road_edge",
       {-20, 40, 10},
       0.05,
       &MotionFeatures::road_edge,
       nullptr},
      {ScoreFeature::OffRoad, "off_road", {0, 1, 1}, 0.25, nullptr, leaves_road},
      {ScoreFeature::RedLight, "red_light", {0, 1, 1}, 0.05, nullptr, runs_red},
  }};
  return kFeatures;
}

double mean_log_likelihood(std::span<const double> log, std::span<const double> rollouts,
                           const Bins& bins) {
  std::vector<double> counts(bins.count, kPseudoCount);
  bool any = false;
  for (const double value : rollouts) {
    if (!std::isfinite(value)) continue;
    counts[bins.index(value)] += 1.0;
    any = true;
  }
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  double sum = 0;
  std::size_t valid = 0;
  for (const double value : log) {
    if (!std::isfinite(value)) continue;
    sum += std::log(counts[bins.index(value)] / all);
    ++valid;
  }
  if (!any || valid == 0) return std::numeric_limits<double>::quiet_NaN();
  return sum / static_cast<double>(valid);
}

double event_log_likelihood(bool in_log, std::size_t happened, std::size_t rollouts) {
  const double share = (static_cast<double>(happened) + kEventPseudoCount) /
                       (static_cast<double>(rollouts) + 2.0 * kEventPseudoCount);
  return std::log(in_log ? share : 1.0 - share);
}

void ScoreSums::add(const ScoreSums& other) {
  for (std::size_t k = 0; k < kScoreFeatures; ++k) {
    log_likelihood[k] += other.log_likelihood[k];
    agents[k] += other.agents[k];
  }
  agent_rollouts += other.agent_rollouts;
  colliding += other.colliding;
  apart += other.apart;
  colliding_anew += other.colliding_anew;
  colliding_with_entering += other.colliding_with_entering;
  way += other.way;
  way_of_log += other.way_of_log;
  least_error += other.least_error;
  scored += other.scored;
  colliding_in_log += other.colliding_in_log;
  off_road += other.off_road;
  at_red += other.at_red;
}

ScoreFigures figures_of(const ScoreSums& sums) {
  ScoreFigures figures;
  double weighted = 0, weights = 0;
  for (std::size_t k = 0; k < kScoreFeatures; ++k) {
    figures.likelihood[k] = exp_mean(sums.log_likelihood[k], sums.agents[k]);
    if (std::isnan(figures.likelihood[k])) continue;
    weighted += score_features()[k].weight * figures.likelihood[k];
    weights += score_features()[k].weight;
  }
  figures.composite = ratio(weighted, weights);
  figures.kinematic = 0.25 * (figures.likelihood[0] + figures.likelihood[1] +
                              figures.likelihood[2] + figures.likelihood[3]);
  const auto rollouts = static_cast<double>(sums.agent_rollouts);
  figures.colliding = ratio(static_cast<double>(sums.colliding), rollouts);
  figures.colliding_anew =
      ratio(static_cast<double>(sums.colliding_anew), static_cast<double>(sums.apart));
  figures.colliding_with_entering =
      ratio(static_cast<double>(sums.colliding_with_entering), rollouts);
  figures.progress = ratio(sums.way, sums.way_of_log);
  figures.min_ade = ratio(sums.least_error, static_cast<double>(sums.scored));
  const bool mapped = sums.agents[static_cast<std::size_t>(ScoreFeature::OffRoad)] > 0;
  figures.off_road = ratio(static_cast<double>(sums.off_road), mapped ? rollouts : 0.0);
  figures.at_red = ratio(static_cast<double>(sums.at_red), mapped ? rollouts : 0.0);
  return figures;
}

std::map<std::string, ScoreSums> score_window(const RecordedScene& scene, const ScoreWindow& window,
                                              const MotionFeatures& log,
                                              std::span<const Rollout> rollouts,
                                              std::span<const MotionFeatures> features) {
  std::map<std::string, ScoreSums> by_type;
  for (std::size_t row = 0; row < window.agents.size(); ++row) {
    ScoreSums& sums = by_type[type_of(scene.types, scene.agents[window.agents[row]].type).name];
    const std::size_t present = window.bodies.present[row];
    add_likelihoods(log, features, row, sums);
    double way = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < rollouts.size(); ++r) {
      const bool overlaps = collides(features[r], row);
      const bool apart = features[r].nearest[row * Poses::kSteps] >= 0.0;
      sums.colliding += overlaps;
      if (!features[r].road_edge.empty()) {
        sums.off_road += leaves_road(features[r], row);
        sums.at_red += runs_red(features[r], row);
      }
      sums.apart += apart;
      sums.colliding_anew += apart && overlaps;
      const std::vector<bool>& touches = rollouts[r].touches_entering;
      sums.colliding_with_entering += !touches.empty() && touches[row];
      way += way_of(rollouts[r].poses, row, present);
      least = std::min(least, mean_error(rollouts[r].poses, window.log, row, present));
    }
    sums.agent_rollouts += rollouts.size();
    sums.colliding_in_log += collides(log, row);
    sums.way += way / static_cast<double>(rollouts.size());
    sums.way_of_log += way_of(window.log, row, present);
    sums.least_error += least;
    ++sums.scored;
  }
  return by_type;
}

}  // namespace sumogamma
