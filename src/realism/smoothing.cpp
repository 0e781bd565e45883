#include "realism/smoothing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

/// Coefficients of the parabola through 2 * half + 1 points one unit apart, about the middle one.
struct Parabola {
  Vec2 constant, linear, quadratic;
};

Parabola parabola_through(std::span<const Vec2> points) {
  const auto half = static_cast<double>(points.size() / 2);
  double second = 0, fourth = 0;
  Vec2 sum = Vec2::Zero(), first_moment = Vec2::Zero(), second_moment = Vec2::Zero();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double x = static_cast<double>(k) - half;
    second += x * x;
    fourth += x * x * x * x;
    sum += points[k];
    first_moment += x * points[k];
    second_moment += x * x * points[k];
  }
  const auto count = static_cast<double>(points.size());
  const double scale = 1.0 / (count * fourth - second * second);
  return {scale * (fourth * sum - second * second_moment), first_moment / second,
          scale * (count * second_moment - second * sum)};
}

}  // namespace

SmoothedTrack smoothed(std::span<const Vec2> points, double period, double window) {
  constexpr std::size_t kLeast = 5;
  std::size_t width =
      std::max(kLeast, static_cast<std::size_t>(std::max(1.0, std::round(window / period))) | 1U);
  if (points.size() < width) width = points.size() - (points.size() % 2 == 0 ? 1 : 0);
  const std::size_t half = width / 2, last = points.size() - 1 - half;
  SmoothedTrack track;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t middle = std::clamp(k, half, last);
    const Parabola fit = parabola_through(points.subspan(middle - half, width));
    const double x = static_cast<double>(k) - static_cast<double>(middle);
    track.position.emplace_back(fit.constant + x * fit.linear + x * x * fit.quadratic);
    track.velocity.emplace_back((fit.linear + 2.0 * x * fit.quadratic) / period);
  }
  return track;
}

std::pair<Vec2, Vec2> value_and_slope(std::span<const double> times, std::span<const Vec2> values) {
  if (times.size() == 1) return {values[0], Vec2::Zero()};
  const Eigen::Index rows = static_cast<Eigen::Index>(times.size());
  const Eigen::Index terms = times.size() >= 5 ? 3 : 2;
  Eigen::MatrixXd powers(rows, terms), wanted(rows, 2);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const double time = times[static_cast<std::size_t>(k)];
    for (Eigen::Index power = 0; power < terms; ++power)
      powers(k, power) = power == 0 ? 1.0 : powers(k, power - 1) * time;
    wanted.row(k) = values[static_cast<std::size_t>(k)].transpose();
  }
  const Eigen::MatrixXd fit = powers.colPivHouseholderQr().solve(wanted);
  return {fit.row(0).transpose(), fit.row(1).transpose()};
}

}  // namespace sumogamma
