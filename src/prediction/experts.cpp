#include "prediction/experts.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"

namespace sumogamma {

namespace {
constexpr double kTurning = 0.12;  // shorter displacements have no direction [m]
}  // namespace

std::string_view name_of(Expert expert) {
  constexpr std::array<std::string_view, kExperts> kNames = {
      "model",      "walking",      "last_displacement", "mean_displacement",
      "kalman",     "acceleration", "brief_turn",        "long_turn",
      "fresh_turn", "lane_steady",  "lane_changing",     "lane_driven"};
  return kNames[static_cast<std::size_t>(expert)];
}

Vec2 displacement_before(std::span<const Vec2> position, std::size_t j) {
  const std::size_t n = position.size();
  if (n < 2) return Vec2::Zero();
  const std::size_t last = n - 1 - std::min(j, n - 2);
  return position[last] - position[last - 1];
}

Vec2 mean_displacement(std::span<const Vec2> position, std::size_t count) {
  const std::size_t n = position.size(), back = std::min(count, n - 1);
  if (back == 0) return Vec2::Zero();
  return (position[n - 1] - position[n - 1 - back]) / static_cast<double>(back);
}

void straight_path(const Vec2& step, std::span<Vec2> displacement) {
  for (std::size_t k = 0; k < displacement.size(); ++k)
    displacement[k] = static_cast<double>(k + 1) * step;
}

void accelerating_path(std::span<const Vec2> position, std::span<Vec2> displacement) {
  const Vec2 last = displacement_before(position, 0);
  const Vec2 change = (last - displacement_before(position, 2)) / 2.0;
  Vec2 step = last, place = Vec2::Zero();
  bool stopped = false;
  for (Vec2& point : displacement) {
    step += change;
    stopped = stopped || step.dot(last) <= 0;
    if (!stopped) place += step;
    point = place;
  }
}

FadedSteps::FadedSteps(double fade) : array() {
  for (std::size_t k = 0; k < size(); ++k) {
    const double step = static_cast<double>(k + 1);
    (*this)[k] = fade > 0 ? fade * (1.0 - std::exp(-step / fade)) : step;
  }
}

void turning_path(std::span<const Vec2> position, std::size_t lag, const FadedSteps& fade,
                  std::span<Vec2> displacement) {
  const Vec2 last = displacement_before(position, 0), before = displacement_before(position, lag);
  const double known = static_cast<double>(
      std::max<std::size_t>(std::min(lag, position.size() < 2 ? 0 : position.size() - 2), 1));
  const double length = last.norm();
  const double gain = (length - before.norm()) / known;
  const bool turns = length > kTurning && before.norm() > kTurning;
  const double turn = turns ? std::atan2(cross(before, last), before.dot(last)) / known : 0.0;
  const Vec2 forward = length > 1e-9 ? Vec2(last / length) : Vec2(1, 0);
  Vec2 place = Vec2::Zero();
  for (std::size_t k = 0; k < displacement.size(); ++k) {
    const double passed = fade[k];
    place += std::max(0.0, length + gain * passed) * from_body(rotation(turn * passed), forward);
    displacement[k] = place;
  }
}

}  // namespace sumogamma
