#include "road/speed_profile.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

/// By how much [rad] a line turns at places `step` [m] apart, to whatever side, summed from its
/// begin on: two bends one after the other don't cancel each other out.
std::vector<double> turning_sums(const Polyline& line, double step, std::size_t count) {
  std::vector<double> sums(count + 1, 0.0);
  // who begins before a kink begins with the direction before it
  Vec2 in = line.direction_at(0.0), here = line.point_at(0.0);
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const Vec2 next = line.point_at(static_cast<double>(i + 1) * step), out = next - here;
    sums[i + 1] = sums[i] + std::abs(std::atan2(cross(in, out), in.dot(out)));
    in = out;
    here = next;
  }
  sums[count] = sums[count - 1];
  return sums;
}

constexpr double kFastest = 100.0;  ///< where nothing bends [m/s]

/// How a path's bends are looked at.
struct BendView {
  double step;    ///< between the places where they are looked at [m]
  double steers;  ///< [s] to each side in which a driver steers into a bend or out of it
};

/// For bicycles finer, and what is left of the map's kinks counts as bends: they turn on less, in
/// hooks of cycle paths, and swing off these where they don't slow down for that. Motorcycles ride
/// where cars drive, and no slower.
BendView bend_view(double turning_radius) {
  constexpr double kStepInRadii = 0.53, kBicycle = 1.5;  // [m]
  if (turning_radius <= 0.0 || turning_radius > kBicycle) return {2.0, 0.6};
  return {kStepInRadii * turning_radius, 0.25};
}

/// Speed [m/s] that the bend at place i leaves: the lateral acceleration is the comfortable one on
/// the mean over the way that the vehicle covers at that speed while it steers into the bend and
/// out of it, since a driver spreads what a map draws as a kink.
double speed_in_bend(const std::vector<double>& sums, const BendView& view, std::size_t i,
                     double lateral_acceleration) {
  constexpr std::size_t kWidest = 6;  // places to each side
  const std::size_t widest = std::min({kWidest, i, sums.size() - 2 - i});
  for (std::size_t k = widest; k > 0; --k) {
    const double reach = (static_cast<double>(k) + 0.5) * view.step;
    const double curvature = (sums[i + k + 1] - sums[i - k]) / (2.0 * reach);
    const double comfortable = std::sqrt(lateral_acceleration / std::max(curvature, 1e-4));
    // who is slower than it takes to cover this way spreads the bend over a shorter one
    const bool covers = comfortable * view.steers > reach - view.step;
    if (covers || k == 1)
      return k < widest ? std::min(comfortable, reach / view.steers) : comfortable;
  }
  return kFastest;
}

/// Speeds [m/s] that a line's bends leave at the places of the view.
std::vector<double> speeds_in_bends(const Polyline& line, const BendView& view,
                                    double lateral_acceleration) {
  const auto count = static_cast<std::size_t>(std::ceil(line.length() / view.step)) + 1;
  const std::vector<double> sums = turning_sums(line, view.step, count);
  std::vector<double> speeds(count);
  for (std::size_t i = 0; i < count; ++i)
    speeds[i] = speed_in_bend(sums, view, i, lateral_acceleration);
  return speeds;
}

/// A speed [m/s] between places `step` [m] apart, linear in its square, so that braking from one to
/// the next is steady.
template <typename Speeds>
double speed_between(const Speeds& speeds, double step, double along) {
  const double place = std::max(along, 0.0) / step;
  const auto index = static_cast<std::size_t>(place);
  if (index + 1 >= speeds.size()) return speeds[speeds.size() - 1];
  const double t = place - static_cast<double>(index);
  const double here = speeds[index], next = speeds[index + 1];
  return std::sqrt((1.0 - t) * here * here + t * next * next);
}

/// Ramps of some time where braking begins and ends, instead of steps: the mean of the squares over
/// the way that is covered in that time, of a profile that holds its lows for a while.
void ease_profile(std::vector<double>& profile) {
  constexpr double kHold = 0.15, kRamp = 0.4;  // to each side [s]
  const std::size_t count = profile.size();
  /// Places to each side that are covered in some time, as far as there are any.
  const auto places = [&](std::size_t i, double time) {
    const std::size_t most = std::min(i, count - 1 - i);
    return std::min(time * profile[i] / Path::kProfileStep, static_cast<double>(most));
  };
  std::vector<double> squares(count), sums(count + 1, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = profile.begin() + static_cast<std::ptrdiff_t>(i);
    const auto reach = static_cast<std::ptrdiff_t>(places(i, kHold));
    const double low = *std::min_element(at - reach, at + reach + 1);
    squares[i] = low * low;
    sums[i + 1] = sums[i] + squares[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    // the outermost ones count in part, so that the window grows with the speed without steps
    const double reach = places(i, kRamp);
    const auto whole = static_cast<std::size_t>(reach);
    const double part = reach - static_cast<double>(whole);
    double sum = sums[i + whole + 1] - sums[i - whole];
    if (part > 0.0) sum += part * (squares[i - whole - 1] + squares[i + whole + 1]);
    profile[i] = std::sqrt(sum / (2.0 * reach + 1.0));
  }
}
}  // namespace

void compute_speed_profile(const PathRequest& request, Path& path) {
  const BendView view = bend_view(request.cornering.turning_radius);
  const double length = path.line.length();
  const auto samples = static_cast<std::size_t>(std::ceil(length / Path::kProfileStep)) + 1;
  const std::vector<double> in_bends =
      path.walking ? std::vector<double>{}
                   : speeds_in_bends(path.line, view, request.max_lateral_acceleration);
  std::vector<double> profile(samples);
  auto stretch = path.stretches.begin();
  for (std::size_t i = 0; i < samples; ++i) {
    const double along = std::min(static_cast<double>(i) * Path::kProfileStep, length);
    while (stretch + 1 != path.stretches.end() && (stretch + 1)->from <= along) ++stretch;
    double speed = std::min(stretch->speed_limit * request.speed_factor, request.max_speed);
    if (!path.walking) speed = std::min(speed, speed_between(in_bends, view.step, along));
    profile[i] = std::max(speed, 1.5);
  }
  for (std::size_t i = samples - 1; !path.walking && i-- > 0;) {
    const double ahead = profile[i + 1];
    const double brake =
        std::sqrt(ahead * ahead + 2.0 * request.comfortable_deceleration * Path::kProfileStep);
    profile[i] = std::min(profile[i], brake);
  }
  if (!path.walking) ease_profile(profile);
  path.speed_profile = PackedValues(profile);
}

double Path::profile_at(double along) const {
  return speed_profile.empty() ? 0.0 : speed_between(speed_profile, kProfileStep, along);
}

}  // namespace sumogamma
