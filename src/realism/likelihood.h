#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "realism/motion_features.h"
#include "study/distribution_distance.h"

namespace sumogamma {

/// What the composite is made of: the features of the 2025 challenge, the last three with a map
/// alone.
enum class ScoreFeature : std::uint8_t {
  Speed,
  Acceleration,
  YawRate,
  YawAcceleration,
  Nearest,
  TimeToCollision,
  Collision,
  RoadEdge,
  OffRoad,
  RedLight,
};
inline constexpr std::size_t kScoreFeatures = 10;

struct ScoreFeatureInfo {
  ScoreFeature feature;
  const char* name;
  Bins bins;                                    ///< none of what happens or doesn't
  double weight;                                ///< of 1
  std::vector<double> MotionFeatures::*values;  ///< null for what happens or doesn't
  /// Whether it happens to a row in the window; null for what has values.
  bool (*happens)(const MotionFeatures& features, std::size_t row);
};
/// In the order of the enumeration. Bins and weights: challenge_2025_sim_agents_config.textproto of
/// the Waymo Open Dataset.
const std::array<ScoreFeatureInfo, kScoreFeatures>& score_features();

/// log of the share that the rollouts' values give to each value of the log, mean over those: a
/// histogram of all rollouts' finite values over the bins, with 0.1 added to each count. NaN where
/// either has no finite value.
double mean_log_likelihood(std::span<const double> log, std::span<const double> rollouts,
                           const Bins& bins);

/// log likelihood of whether something happened to somebody in the log (a collision), by the share
/// of the rollouts in which it did, with 0.001 added to both counts.
double event_log_likelihood(bool in_log, std::size_t happened, std::size_t rollouts);

/// Sums over agents from which a score is made; sums can be added up.
struct ScoreSums {
  std::array<double, kScoreFeatures> log_likelihood{};
  std::array<std::size_t, kScoreFeatures> agents{};  ///< that have the feature
  std::size_t agent_rollouts = 0, colliding = 0, colliding_with_entering = 0;
  std::size_t apart = 0,
              colliding_anew = 0;  ///< of the rollouts: where it overlaps nobody at first
  double way = 0, way_of_log = 0;  ///< [m], the way of a rollout as a mean over rollouts
  double least_error = 0;          ///< of the best rollout of each agent, mean over its steps [m]
  std::size_t scored = 0;          ///< agents
  std::size_t colliding_in_log = 0;
  std::size_t off_road = 0, at_red = 0;  ///< of the agents' rollouts, with a map alone

  void add(const ScoreSums& other);
};

/// The figures of a score.
struct ScoreFigures {
  std::array<double, kScoreFeatures> likelihood{};  ///< geometric means over agents
  double composite = 0;       ///< weighted mean of these, the weights made to add up to 1
  double kinematic = 0;       ///< mean of the first four
  double colliding = 0;       ///< share of agents that overlap another scored one in a rollout
  double colliding_anew = 0;  ///< likewise, of those who overlap nobody at the beginning
  double colliding_with_entering = 0;  ///< that overlap one who came later
  double progress = 0;                 ///< way of all in the rollouts over that in the log
  double min_ade = 0;               ///< mean over agents of the least mean error of a rollout [m]
  double off_road = 0, at_red = 0;  ///< shares of agents and rollouts; NaN without a map
};
ScoreFigures figures_of(const ScoreSums& sums);

/// One of the futures of a window.
struct Rollout {
  Poses poses;
  std::vector<bool> touches_entering{};  ///< by row; empty: nobody comes
};

/// Sums of one window by the name of a type.
std::map<std::string, ScoreSums> score_window(const RecordedScene& scene, const ScoreWindow& window,
                                              const MotionFeatures& log,
                                              std::span<const Rollout> rollouts,
                                              std::span<const MotionFeatures> features);

}  // namespace sumogamma
