#include "ego/closed_loop_score.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "ego/ego_metrics.h"

namespace sumogamma {

namespace {

constexpr double kWeightTime = 5, kWeightProgress = 5, kWeightSpeed = 4, kWeightComfort = 2;

/// More than 1 m against the lane's direction within 1 s?
bool drives_against(std::span<const EgoSample> samples, double step) {
  constexpr double kMost = 1.0;  // [m]
  const auto window = static_cast<std::size_t>(std::lround(1.0 / step));
  double sum = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    sum += samples[k].against;
    if (k >= window) sum -= samples[k - window].against;
    if (sum > kMost) return true;
  }
  return false;
}

double speed_part(std::span<const EgoSample> samples, double step) {
  constexpr double kMostExcess = 2.23;  // [m/s]
  if (samples.empty()) return 1.0;
  double excess = 0;
  for (const EgoSample& sample : samples)
    excess += std::max(sample.speed - sample.limit, 0.0) * step;
  const double duration = static_cast<double>(samples.size()) * step;
  return std::max(0.0, 1.0 - excess / (kMostExcess * duration));
}

bool is_comfortable(std::span<const EgoSample> samples, double step) {
  for (const Motion& motion : motions_of(samples, step))
    if (motion.along < -4.05 || motion.along > 2.40 || std::abs(motion.across) > 4.89 ||
        std::abs(motion.yaw_rate) > 0.95 || std::abs(motion.yaw_acceleration) > 1.93 ||
        std::abs(motion.jerk_along) > 4.13 || motion.jerk > 8.37)
      return false;
  return true;
}

}  // namespace

double ClosedLoopScore::total() const {
  const double mean = (kWeightTime * time_to_collision + kWeightProgress * progress +
                       kWeightSpeed * speed_limit + kWeightComfort * comfort) /
                      (kWeightTime + kWeightProgress + kWeightSpeed + kWeightComfort);
  return no_fault * drivable_area * driving_direction * making_progress * mean;
}

double ClosedLoopScore::without_comfort() const {
  const double mean =
      (kWeightTime * time_to_collision + kWeightProgress * progress + kWeightSpeed * speed_limit) /
      (kWeightTime + kWeightProgress + kWeightSpeed);
  return no_fault * drivable_area * driving_direction * making_progress * mean;
}

ClosedLoopScore closed_loop_score(std::span<const EgoSample> samples,
                                  const std::optional<EgoContact>& contact, double reference,
                                  double step) {
  constexpr double kLeastTime = 0.95;  // [s]
  constexpr double kLeastWay = 0.1;    // [m]
  constexpr double kLeastProgress = 0.2;
  ClosedLoopScore score;
  if (contact && is_at_fault(*contact)) score.no_fault = 0;
  double way = 0;
  for (const EgoSample& sample : samples) {
    way += sample.progress;
    if (sample.off_area) score.drivable_area = 0;
    if (sample.time_to_collision < kLeastTime) score.time_to_collision = 0;
  }
  if (drives_against(samples, step)) score.driving_direction = 0;
  score.progress = samples.empty()
                       ? 0.0
                       : std::min(1.0, std::max(way, kLeastWay) / std::max(reference, kLeastWay));
  if (score.progress < kLeastProgress) score.making_progress = 0;
  score.speed_limit = speed_part(samples, step);
  score.comfort = is_comfortable(samples, step) ? 1 : 0;
  return score;
}

}  // namespace sumogamma
