#include "geometry/half_plane_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sumogamma {

namespace {

// two lines whose directions differ by less than this sine never meet in practice
constexpr double kParallel = 1e-9;
// two opposite planes that leave a gap of no more than this share a line [m/s]
constexpr double kSameLine = 1e-9;
// likewise along a line
constexpr double kSamePoint = 1e-9;
// how far outside the disc a line may pass, as a share of the squared radius
constexpr double kTouching = 1e-12;
// how far above the least violation the answer may stay, so that it moves continuously with its
// input [m/s]
constexpr double kViolationSlack = 0.01;

bool is_finite(const HalfPlane& plane) {
  return plane.point.allFinite() && plane.normal.allFinite();
}

/// What to look for within the planes: the point nearest to `target`, or the farthest along
/// `target` (a direction).
struct Objective {
  Vec2 target;
  bool is_direction;

  Vec2 start(double radius) const {
    const double length = target.norm();
    if (is_direction) return length > 0 ? Vec2(target * (radius / length)) : Vec2(Vec2::Zero());
    return length > radius ? Vec2(target * (radius / length)) : target;
  }

  /// Best parameter within [low, high] on the line point + t * direction.
  double best(const Vec2& point, const Vec2& direction, double low, double high) const {
    if (is_direction) return target.dot(direction) > 0 ? high : low;
    return std::clamp((target - point).dot(direction), low, high);
  }
};

/// The best point on the boundary of planes[index] within all earlier planes and the disc. False
/// where there is none.
bool best_on_line(std::span<const HalfPlane> planes, std::size_t index, double radius,
                  const Objective& objective, Vec2& answer) {
  const HalfPlane& line = planes[index];
  const Vec2 direction = left_of(line.normal);
  const double middle = -line.point.dot(direction);
  const double offset = line.point.dot(line.normal);
  const double half_chord = radius * radius - offset * offset;
  // a line that touches the disc shares a point with it, whatever rounding says
  if (half_chord < -kTouching * radius * radius) return false;
  const double half = std::sqrt(std::max(half_chord, 0.0));
  double low = middle - half, high = middle + half;
  for (std::size_t k = 0; k < index; ++k) {
    const HalfPlane& other = planes[k];
    const double along = direction.dot(other.normal);
    const double gap = slack(other, line.point);
    if (std::abs(along) <= kParallel) {
      if (gap < -kSameLine) return false;
      continue;
    }
    const double t = -gap / along;
    if (along > 0)
      low = std::max(low, t);
    else
      high = std::min(high, t);
    if (low > high + kSamePoint) return false;
  }
  // three lines through one point, as the faces of a hull that is a single point: what is left of
  // it is rounding
  if (low > high) low = high = 0.5 * (low + high);
  answer = line.point + objective.best(line.point, direction, low, high) * direction;
  return true;
}

/// Incremental program in two dimensions: returns planes.size(), or the first plane that leaves
/// nothing; `answer` is then the best point of those before it.
std::size_t solve(std::span<const HalfPlane> planes, double radius, const Objective& objective,
                  Vec2& answer, int& binding) {
  answer = objective.start(radius);
  binding = -1;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    // a comparison that is false for NaN ignores a plane that is not finite
    if (!(slack(planes[k], answer) < 0)) continue;
    Vec2 moved;
    if (!best_on_line(planes, k, radius, objective, moved)) return k;
    answer = moved;
    binding = static_cast<int>(k);
  }
  return planes.size();
}

/// Least greatest violation of the soft planes within the hard ones, from a point that is best for
/// those before `first`.
double least_violation(std::span<const HalfPlane> planes, std::size_t hard_count, std::size_t first,
                       double radius, Vec2 point, ProgramScratch& scratch) {
  double violation = 0;
  for (std::size_t k = first; k < planes.size(); ++k) {
    if (!(slack(planes[k], point) < -violation)) continue;
    // the optimum has plane k tight: move along its normal where no earlier soft plane is violated
    // more
    scratch.projected.assign(planes.begin(),
                             planes.begin() + static_cast<std::ptrdiff_t>(hard_count));
    for (std::size_t j = hard_count; j < k; ++j) {
      const Vec2 difference = planes[j].normal - planes[k].normal;
      const double length = difference.norm();
      if (length <= kParallel) continue;
      const Vec2 normal = difference / length;
      const double offset =
          (planes[j].point.dot(planes[j].normal) - planes[k].point.dot(planes[k].normal)) / length;
      scratch.projected.push_back({offset * normal, normal});
    }
    Vec2 moved;
    int unused;
    const Objective along{planes[k].normal, true};
    if (solve(scratch.projected, radius, along, moved, unused) == scratch.projected.size())
      point = moved;
    violation = std::max(violation, -slack(planes[k], point));
  }
  return violation;
}

}  // namespace

ProgramResult closest_point(std::span<const HalfPlane> planes, std::size_t hard_count,
                            const Vec2& target, double radius, ProgramScratch& scratch) {
  ProgramResult result;
  if (!(radius > 0) || !std::isfinite(radius)) return result;
  const Objective nearest{target.allFinite() ? target : Vec2(Vec2::Zero()), false};
  const std::size_t stopped = solve(planes, radius, nearest, result.point, result.binding);
  if (stopped == planes.size()) {
    if (!result.point.allFinite()) result.point = Vec2::Zero();
    return result;
  }
  if (stopped < hard_count) {
    result.point = Vec2::Zero();
    result.binding = static_cast<int>(stopped);
    for (std::size_t k = hard_count; k < planes.size(); ++k)
      if (is_finite(planes[k]))
        result.violation = std::max(result.violation, -slack(planes[k], result.point));
    return result;
  }

  // the soft planes can't all hold: relax them just as far as it takes
  scratch.relaxed.clear();
  for (const HalfPlane& plane : planes)
    scratch.relaxed.push_back(is_finite(plane) ? plane
                                               : HalfPlane{Vec2(-2.0 * radius, 0), Vec2(1, 0)});
  result.violation =
      least_violation(scratch.relaxed, hard_count, stopped, radius, result.point, scratch);
  for (std::size_t k = hard_count; k < scratch.relaxed.size(); ++k)
    scratch.relaxed[k].point -= (result.violation + kViolationSlack) * scratch.relaxed[k].normal;
  Vec2 point;
  int binding;
  const std::size_t relaxed_stop = solve(scratch.relaxed, radius, nearest, point, binding);
  result.point = point.allFinite() ? point : Vec2(Vec2::Zero());
  result.binding = relaxed_stop == planes.size() ? binding : static_cast<int>(relaxed_stop);
  return result;
}

}  // namespace sumogamma
