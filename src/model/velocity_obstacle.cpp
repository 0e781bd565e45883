#include "model/velocity_obstacle.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

namespace {

// passing on either side counts as equally near within this much of the way travelled during the
// horizon [m]
constexpr double kTie = 1e-3;

/// VO^tau scaled by tau: { s m : m in B - A, s >= 1 }, bounded by the edges of B - A that face the
/// origin and by the legs, the rays from the tangent vertices away from the origin. Convex.
class ScaledObstacle {
 public:
  explicit ScaledObstacle(const NearSide& near) : near_(near) {
    const Vec2 &left = near.vertices[0], &right = near.vertices[near.edges];
    left_length_ = left.norm();
    right_length_ = right.norm();
    left_along_ = left / left_length_;
    right_along_ = right / right_length_;
  }

  /// A bounding line: a leg or a near edge.
  struct Line {
    Vec2 normal;         ///< outward
    double offset;       ///< normal . p for its points p
    double height;       ///< of x over the line: negative inside
    std::uint32_t part;  ///< 0 .. edges - 1: that edge; edges: left leg; edges + 1: right leg
  };

  /// The bounding line that x lies farthest outside of; where x is inside, the nearest one, and the
  /// nearest boundary point lies on it because the set is convex. Ties between the legs go to
  /// `side`.
  Line nearest_line(const Vec2& x, PassingSide side) const {
    const double left_height = cross(left_along_, x), right_height = cross(x, right_along_);
    const double bias = side == PassingSide::Right ? kTie : -kTie;
    Line line =
        right_height > left_height - bias
            ? Line{Vec2(right_along_.y(), -right_along_.x()), 0.0, right_height, near_.edges + 1}
            : Line{left_of(left_along_), 0.0, left_height, near_.edges};
    for (std::uint32_t k = 0; k < near_.edges; ++k) {
      const double height = near_.normals[k].dot(x) - near_.heights[k];
      if (height > line.height) line = {near_.normals[k], near_.heights[k], height, k};
    }
    return line;
  }

  /// True where the foot of x on a bounding line belongs to the boundary.
  bool has_foot(const Line& line, const Vec2& x) const {
    if (line.part == near_.edges) return x.dot(left_along_) >= left_length_;
    if (line.part == near_.edges + 1) return x.dot(right_along_) >= right_length_;
    const Vec2 along = left_of(line.normal);
    return along.dot(x - near_.vertices[line.part]) >= 0 &&
           along.dot(x - near_.vertices[line.part + 1]) <= 0;
  }

  /// Nearest vertex to x.
  Vec2 nearest_vertex(const Vec2& x) const {
    Vec2 nearest = near_.vertices[0];
    for (std::uint32_t k = 1; k <= near_.edges; ++k)
      if ((near_.vertices[k] - x).squaredNorm() < (nearest - x).squaredNorm())
        nearest = near_.vertices[k];
    return nearest;
  }

  /// The bounding line whose foot of x belongs to the boundary and is nearest; none where a vertex
  /// is nearer than all.
  bool nearest_foot(const Vec2& x, Line& line) const {
    line.height = -1;
    auto consider = [&](const Line& candidate) {
      if (candidate.height >= 0 && (line.height < 0 || candidate.height < line.height) &&
          has_foot(candidate, x))
        line = candidate;
    };
    consider({left_of(left_along_), 0.0, cross(left_along_, x), near_.edges});
    consider(
        {Vec2(right_along_.y(), -right_along_.x()), 0.0, cross(x, right_along_), near_.edges + 1});
    for (std::uint32_t k = 0; k < near_.edges; ++k)
      consider({near_.normals[k], near_.heights[k], near_.normals[k].dot(x) - near_.heights[k], k});
    return line.height >= 0;
  }

 private:
  const NearSide& near_;
  Vec2 left_along_, right_along_;
  double left_length_, right_length_;
};

Escape escape_along(const ScaledObstacle::Line& line, const Vec2& x, double horizon) {
  const double height = line.normal.dot(x) - line.offset;
  return {(-height / horizon) * line.normal, line.normal, height < 0, false};
}

Escape escape_nearest(const ScaledObstacle& obstacle, const Vec2& x, double horizon,
                      PassingSide side) {
  ScaledObstacle::Line line = obstacle.nearest_line(x, side);
  // inside, or outside of one line only: its foot is the nearest point
  if (line.height <= 0 || obstacle.has_foot(line, x)) return escape_along(line, x, horizon);
  const Vec2 away = x - obstacle.nearest_vertex(x);
  const double distance = away.norm();
  if (obstacle.nearest_foot(x, line) && line.height <= distance)
    return escape_along(line, x, horizon);
  if (!(distance > 1e-9)) return escape_along(obstacle.nearest_line(x, side), x, horizon);
  return {(-1.0 / horizon) * away, away / distance, false, false};
}

}  // namespace

Escape nearest_escape(const NearSide& near, const Vec2& relative_velocity, double horizon,
                      PassingSide side) {
  return escape_nearest(ScaledObstacle(near), relative_velocity * horizon, horizon, side);
}

Escape intended_escape(const NearSide& near, const Vec2& relative_velocity, const Vec2& intended,
                       double horizon, PassingSide side) {
  const ScaledObstacle obstacle(near);
  const ScaledObstacle::Line line = obstacle.nearest_line(intended * horizon, side);
  const Vec2 x = relative_velocity * horizon;
  return line.height <= 0 ? escape_along(line, x, horizon)
                          : escape_nearest(obstacle, x, horizon, side);
}

Escape overlap_escape(const PolygonDifference& difference, const Vec2& relative_velocity,
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

}  // namespace sumogamma
