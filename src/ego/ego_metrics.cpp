#include "ego/ego_metrics.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/rotation.h"

namespace sumogamma {

std::vector<Motion> motions_of(std::span<const EgoSample> samples, double step) {
  constexpr double kSpan = 0.1;  // [s]
  const auto stride = static_cast<std::size_t>(std::max(std::lround(kSpan / step), 1L));
  const double span = static_cast<double>(stride) * step;
  std::vector<Vec2> velocities;  // over each span
  std::vector<double> rates;
  for (std::size_t k = 0; k + stride < samples.size(); k += stride) {
    velocities.push_back((samples[k + stride].position - samples[k].position) / span);
    rates.push_back(wrap_angle(samples[k + stride].heading - samples[k].heading) / span);
  }
  std::vector<Motion> motions;
  Vec2 last = Vec2::Zero();
  for (std::size_t k = 0; k + 1 < velocities.size(); ++k) {
    const Vec2 acceleration = (velocities[k + 1] - velocities[k]) / span;
    const Vec2 forward = direction_of(samples[(k + 1) * stride].heading);
    const Vec2 body = to_body(acceleration, forward);
    Motion motion{body.x(), body.y(), rates[k + 1], (rates[k + 1] - rates[k]) / span, 0.0, 0.0};
    if (k > 0) {
      const Vec2 jerk = (acceleration - last) / span;
      motion.jerk_along = jerk.dot(forward);
      motion.jerk = jerk.norm();
    }
    last = acceleration;
    motions.push_back(motion);
  }
  return motions;
}

EgoMetrics metrics_of(std::span<const EgoSample> samples, double step, double period) {
  constexpr double kDrop = 0.2;      // [m/s]
  constexpr double kLeastWay = 0.1;  // [m]
  EgoMetrics metrics;
  metrics.least_gap = std::numeric_limits<double>::infinity();
  if (samples.empty()) return metrics;
  metrics.time = samples.back().time - samples.front().time;
  double change = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const EgoSample& sample = samples[k];
    metrics.progress += sample.progress;
    metrics.least_gap = std::min(metrics.least_gap, sample.gap);
    metrics.braking_of_others += step * sample.braking_others;
    metrics.delay_of_others += sample.delay_of_others;
    if (k == 0) continue;
    metrics.driven += (sample.position - samples[k - 1].position).norm();
    change += std::abs(sample.speed - samples[k - 1].speed);
  }
  metrics.mean_speed = metrics.time > 0.0 ? metrics.driven / metrics.time : 0.0;
  metrics.speed_change = change / std::max(metrics.driven, kLeastWay);
  metrics.acceleration = metrics.time > 0.0 ? change / metrics.time : 0.0;
  const std::vector<Motion> motions = motions_of(samples, step);
  for (const Motion& motion : motions)
    metrics.jerk += std::abs(motion.jerk_along) / static_cast<double>(motions.size());
  const auto ticks = static_cast<std::size_t>(std::max(std::lround(period / step), 1L));
  std::size_t periods = 0, drops = 0;
  for (std::size_t k = ticks; k < samples.size(); k += ticks, ++periods)
    drops += samples[k - ticks].speed - samples[k].speed > kDrop ? 1 : 0;
  metrics.braking_share =
      periods > 0 ? static_cast<double>(drops) / static_cast<double>(periods) : 0.0;
  return metrics;
}

}  // namespace sumogamma
