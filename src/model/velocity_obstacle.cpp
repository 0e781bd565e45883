#include "model/velocity_obstacle.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace sumogamma {

namespace {

// passing on either side counts as equally near within this much of the way travelled during the
// horizon [m]
constexpr double kTie = 1e-3;

/// Bit k is set where edge k faces the origin.
std::uint32_t facing_edges(const PolygonDifference& difference) {
  std::uint32_t facing = 0;
  if (difference.count < 2) return 0;
  for (std::uint32_t k = 0; k < difference.count; ++k)
    facing |= static_cast<std::uint32_t>(difference.normals[k].dot(difference.vertices[k]) < 0)
              << k;
  return facing;
}

/// VO^tau scaled by tau: { s m : m in B - A, s >= 1 }, bounded by the edges of B - A that face the
/// origin and by the legs, the rays from the tangent vertices away from the origin. Convex.
class ScaledObstacle {
 public:
  ScaledObstacle(const PolygonDifference& difference, std::uint32_t facing)
      : difference_(difference) {
    const std::uint32_t count = difference.count;
    if (facing != 0) {
      // the facing edges are one run: it begins where the edge before doesn't face
      const std::uint32_t all = (1u << count) - 1u;
      const std::uint32_t before = ((facing << 1) | (facing >> (count - 1))) & all;
      first_ = static_cast<std::uint32_t>(std::countr_zero(facing & ~before));
      edges_ = static_cast<std::uint32_t>(std::popcount(facing));
    } else {
      // a point, or a segment seen end-on: its nearest vertex stands for all
      for (std::uint32_t k = 1; k < count; ++k)
        if (difference.vertices[k].squaredNorm() < difference.vertices[first_].squaredNorm())
          first_ = k;
    }
    left_along_ = vertex(0).normalized();
    right_along_ = vertex(edges_).normalized();
  }

  struct Line {
    Vec2 point, normal;  ///< outward
    double height;       ///< of x over the line: negative inside
  };

  /// The bounding line that x lies farthest outside of; where x is inside, the nearest one, and the
  /// nearest boundary point lies on it because the set is convex. Ties between the legs go to
  /// `side`.
  Line nearest_line(const Vec2& x, PassingSide side) const {
    const Vec2 left_normal = left_of(left_along_), right_normal = -left_of(right_along_);
    const double left_height = left_normal.dot(x), right_height = right_normal.dot(x);
    const double bias = side == PassingSide::Right ? kTie : -kTie;
    Line line = right_height > left_height - bias ? Line{Vec2::Zero(), right_normal, right_height}
                                                  : Line{Vec2::Zero(), left_normal, left_height};
    for (std::uint32_t k = 0; k < edges_; ++k) {
      const double height = normal(k).dot(x - vertex(k));
      if (height > line.height) line = {vertex(k), normal(k), height};
    }
    return line;
  }

  /// Nearest boundary point to x outside; `outward` becomes the direction from it to x.
  Vec2 nearest_from_outside(const Vec2& x, Vec2& outward) const {
    Vec2 nearest = vertex(0) + std::max((x - vertex(0)).dot(left_along_), 0.0) * left_along_;
    double least = (x - nearest).squaredNorm();
    auto consider = [&](const Vec2& candidate) {
      const double distance = (x - candidate).squaredNorm();
      if (distance >= least) return;
      least = distance;
      nearest = candidate;
    };
    const Vec2& last = vertex(edges_);
    consider(last + std::max((x - last).dot(right_along_), 0.0) * right_along_);
    for (std::uint32_t k = 0; k < edges_; ++k) {
      const Vec2 along = left_of(normal(k));
      const double length = (vertex(k + 1) - vertex(k)).dot(along);
      consider(vertex(k) + std::clamp((x - vertex(k)).dot(along), 0.0, length) * along);
    }
    const double distance = std::sqrt(least);
    if (distance > 1e-9) outward = (x - nearest) / distance;
    return nearest;
  }

 private:
  std::uint32_t wrapped(std::uint32_t k) const {
    const std::uint32_t index = first_ + k;
    return index < difference_.count ? index : index - difference_.count;
  }
  const Vec2& vertex(std::uint32_t k) const { return difference_.vertices[wrapped(k)]; }
  const Vec2& normal(std::uint32_t k) const { return difference_.normals[wrapped(k)]; }

  const PolygonDifference& difference_;
  std::uint32_t first_ = 0, edges_ = 0;
  Vec2 left_along_, right_along_;
};

/// The bodies overlap: out through the nearest edge of (B - A) / time, so that they come apart in
/// `time`.
Escape escape_overlap(const PolygonDifference& difference, const Vec2& relative_velocity,
                      double time) {
  const Vec2 x = relative_velocity * time;
  double height = -std::numeric_limits<double>::infinity();
  Escape escape;
  escape.overlapping = true;
  for (std::uint32_t k = 0; difference.count > 1 && k < difference.count; ++k) {
    const double over = difference.normals[k].dot(x - difference.vertices[k]);
    if (over <= height) continue;
    height = over;
    escape.normal = difference.normals[k];
  }
  // two points in one place: there is no way out that is better than another
  if (!std::isfinite(height)) height = 0;
  escape.change = (-height / time) * escape.normal;
  escape.colliding = height < 0;
  return escape;
}

Escape escape_along(const ScaledObstacle::Line& line, const Vec2& x, double horizon) {
  const double height = line.normal.dot(x - line.point);
  return {(-height / horizon) * line.normal, line.normal, height < 0, false};
}

Escape escape_nearest(const ScaledObstacle& obstacle, const Vec2& x, double horizon,
                      PassingSide side) {
  const ScaledObstacle::Line line = obstacle.nearest_line(x, side);
  if (line.height <= 0) return escape_along(line, x, horizon);
  Vec2 outward = line.normal;
  const Vec2 nearest = obstacle.nearest_from_outside(x, outward);
  return {(nearest - x) / horizon, outward, false, false};
}

/// True where A touches or overlaps B, or where there is no obstacle to speak of.
bool origin_inside(const PolygonDifference& difference, std::uint32_t facing) {
  if (difference.count >= 3) return facing == 0;
  for (std::uint32_t k = 0; k < difference.count; ++k)
    if (!(difference.vertices[k].squaredNorm() > 0)) return true;
  return false;
}

}  // namespace

Escape nearest_escape(const PolygonDifference& difference, const Vec2& relative_velocity,
                      double horizon, double separation_time, PassingSide side) {
  const std::uint32_t facing = facing_edges(difference);
  if (origin_inside(difference, facing))
    return escape_overlap(difference, relative_velocity, separation_time);
  return escape_nearest(ScaledObstacle(difference, facing), relative_velocity * horizon, horizon,
                        side);
}

Escape intended_escape(const PolygonDifference& difference, const Vec2& relative_velocity,
                       const Vec2& intended, double horizon, double separation_time,
                       PassingSide side) {
  const std::uint32_t facing = facing_edges(difference);
  if (origin_inside(difference, facing))
    return escape_overlap(difference, relative_velocity, separation_time);
  const ScaledObstacle obstacle(difference, facing);
  const ScaledObstacle::Line line = obstacle.nearest_line(intended * horizon, side);
  if (line.height > 0) return escape_nearest(obstacle, relative_velocity * horizon, horizon, side);
  return escape_along(line, relative_velocity * horizon, horizon);
}

}  // namespace sumogamma
