#include "prediction/distribution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace sumogamma {

PointScore score_point(std::span<const Vec2> samples, const Vec2& truth) {
  constexpr double kLeastWidth = 0.01;  // [m]
  const double n = static_cast<double>(samples.size());
  Vec2 mean = Vec2::Zero();
  for (const Vec2& sample : samples) mean += sample / n;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (const Vec2& sample : samples)
    covariance += (sample - mean) * (sample - mean).transpose() / (n - 1.0);
  const double scott = std::pow(n, -1.0 / 6.0);
  const Eigen::Matrix2d kernel =
      scott * scott * covariance + kLeastWidth * kLeastWidth * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d precision = kernel.inverse();
  const double scale = 1.0 / (2.0 * kPi * std::sqrt(kernel.determinant()));
  auto bump = [&](const Vec2& d) { return scale * std::exp(-0.5 * d.dot(precision * d)); };

  PointScore score;
  double density = 0, distance = 0, spread = 0;
  std::vector<double> own(samples.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    density += bump(truth - samples[i]) / n;
    distance += (truth - samples[i]).norm() / n;
    for (std::size_t j = i + 1; j < samples.size(); ++j) {
      const Vec2 apart = samples[i] - samples[j];
      const double b = bump(apart) / (n - 1.0);
      own[i] += b;
      own[j] += b;
      spread += 2.0 * apart.norm() / (n * n);
    }
  }
  constexpr double kLeastDensity = 1e-12;
  score.log_loss = -std::log(std::max(density, kLeastDensity));
  score.energy = distance - 0.5 * spread;
  std::size_t denser = 0;
  for (const double d : own) denser += d > density;
  // the truth is one more point among n: its rank is even over 0..n if it comes from the same cloud
  score.inside_50 = static_cast<double>(denser) < 0.5 * (n + 1.0) ? 1.0 : 0.0;
  score.inside_90 = static_cast<double>(denser) < 0.9 * (n + 1.0) ? 1.0 : 0.0;
  return score;
}

}  // namespace sumogamma
