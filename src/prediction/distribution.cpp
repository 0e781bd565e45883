#include "prediction/distribution.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/units.h"

namespace sumogamma {

namespace {

/// Normal kernel shaped as a cloud's covariance.
class Kernel {
 public:
  explicit Kernel(std::span<const Vec2> points) {
    constexpr double kLeastWidth = 0.01;  // [m]
    const double n = static_cast<double>(points.size());
    Vec2 mean = Vec2::Zero();
    for (const Vec2& point : points) mean += point / n;
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    for (const Vec2& point : points)
      covariance += (point - mean) * (point - mean).transpose() / (n - 1.0);
    const double scott = std::pow(n, -1.0 / 6.0);
    const Eigen::Matrix2d width =
        scott * scott * covariance + kLeastWidth * kLeastWidth * Eigen::Matrix2d::Identity();
    precision_ = width.inverse();
    scale_ = 1.0 / (2.0 * kPi * std::sqrt(width.determinant()));
  }
  double operator()(const Vec2& d) const { return scale_ * std::exp(-0.5 * d.dot(precision_ * d)); }

 private:
  Eigen::Matrix2d precision_;
  double scale_;
};

/// How many of the points lie denser among all others than the last one does.
std::size_t denser_than_last(std::span<const Vec2> points) {
  const Kernel bump(points);
  std::vector<double> density(points.size(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      const double b = bump(points[i] - points[j]);
      density[i] += b;
      density[j] += b;
    }
  std::size_t denser = 0;
  for (const double d : density) denser += d > density.back();
  return denser;
}

}  // namespace

PointScore score_point(std::span<const Vec2> samples, const Vec2& truth) {
  const double n = static_cast<double>(samples.size());
  const Kernel bump(samples);
  PointScore score;
  double density = 0, distance = 0, spread = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    density += bump(truth - samples[i]) / n;
    distance += (truth - samples[i]).norm() / n;
    for (std::size_t j = i + 1; j < samples.size(); ++j)
      spread += 2.0 * (samples[i] - samples[j]).norm() / (n * n);
  }
  constexpr double kLeastDensity = 1e-12;
  score.log_loss = -std::log(std::max(density, kLeastDensity));
  score.energy = distance - 0.5 * spread;
  // the truth is one more point among n: of the n + 1 ranks, even if it comes from the same cloud,
  // the one that the region's border runs through counts in part
  std::vector<Vec2> all(samples.begin(), samples.end());
  all.push_back(truth);
  const double rank = static_cast<double>(denser_than_last(all));
  score.inside_50 = std::clamp(0.5 * (n + 1.0) - rank, 0.0, 1.0);
  score.inside_90 = std::clamp(0.9 * (n + 1.0) - rank, 0.0, 1.0);
  return score;
}

}  // namespace sumogamma
