#include "model/velocity_obstacle.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

namespace {

// the two ways round count as equally near within this share of the horizon's distance; the passing
// side is then taken [m]
constexpr double kTie = 1e-3;

struct Nearest {
  Vec2 point, normal;
};

/// Nearest point to x on the segment or ray from a along `along` (unit) up to `length`.
Vec2 foot_on(const Vec2& a, const Vec2& along, double length, const Vec2& x) {
  return a + std::clamp((x - a).dot(along), 0.0, length) * along;
}

Escape make_escape(const Vec2& nearest, const Vec2& normal, const Vec2& relative_velocity,
                   double time, bool inside) {
  Escape escape;
  escape.change = nearest / time - relative_velocity;
  escape.normal = normal;
  escape.colliding = inside;
  return escape;
}

/// The bodies overlap: out through the nearest edge, at a speed that separates them in `time`.
Escape escape_overlap(const PolygonDifference& difference, const Vec2& relative_velocity,
                      double time) {
  const Vec2 x = relative_velocity * time;
  double nearest = -std::numeric_limits<double>::infinity();
  Vec2 normal(1, 0);
  for (std::uint32_t k = 0; k < difference.count; ++k) {
    const double height = difference.normals[k].dot(x - difference.vertices[k]);
    if (height > nearest) {
      nearest = height;
      normal = difference.normals[k];
    }
  }
  if (!std::isfinite(nearest)) nearest = 0;
  Escape escape;
  escape.change = (-nearest / time) * normal;
  escape.normal = normal;
  escape.colliding = nearest < 0;
  escape.overlapping = true;
  return escape;
}

bool origin_is_inside(const PolygonDifference& difference) {
  if (difference.count < 3) return false;
  for (std::uint32_t k = 0; k < difference.count; ++k)
    if (difference.normals[k].dot(difference.vertices[k]) < 0) return false;
  return true;
}

/// The chain of edges that face the origin, from the left tangent vertex to the right one.
struct NearSide {
  std::uint32_t first = 0, edges = 0;
};

NearSide near_side(const PolygonDifference& difference) {
  const std::uint32_t count = difference.count;
  auto faces = [&](std::uint32_t k) {
    return difference.normals[k].dot(difference.vertices[k]) < 0;
  };
  NearSide side;
  if (count == 1) return side;
  std::uint32_t k = 0;
  // back to the start of the run that holds edge 0, or on to the next run
  if (faces(0)) {
    while (faces(k == 0 ? count - 1 : k - 1)) k = k == 0 ? count - 1 : k - 1;
  } else {
    while (k < count && !faces(k)) ++k;
    // seen edge-on (a segment towards the origin): no edge faces it, the nearest vertex stands for
    // all
    if (k == count) {
      for (std::uint32_t m = 0; m < count; ++m)
        if (difference.vertices[m].squaredNorm() < difference.vertices[side.first].squaredNorm())
          side.first = m;
      return side;
    }
  }
  side.first = k;
  while (side.edges < count && faces(k)) {
    ++side.edges;
    k = k + 1 < count ? k + 1 : 0;
  }
  return side;
}

}  // namespace

Escape nearest_escape(const PolygonDifference& difference, const Vec2& relative_velocity,
                      double horizon, double separation_time, PassingSide side) {
  if (origin_is_inside(difference))
    return escape_overlap(difference, relative_velocity, separation_time);
  const std::uint32_t count = difference.count;
  const NearSide near = near_side(difference);
  auto vertex = [&](std::uint32_t k) -> const Vec2& {
    return difference.vertices[(near.first + k) % count];
  };
  const Vec2 &left = vertex(0), &right = vertex(near.edges);
  const double left_length = left.norm(), right_length = right.norm();
  if (!(left_length > 0) || !(right_length > 0))
    return escape_overlap(difference, relative_velocity, separation_time);
  const Vec2 left_along = left / left_length, right_along = right / right_length;
  const Vec2 left_normal = left_of(left_along), right_normal = -left_of(right_along);

  // scaled by the horizon, VO^tau is { s m : m in B - A, s >= 1 }: the near edges and the two legs
  // bound it
  const Vec2 x = relative_velocity * horizon;
  const bool to_right = side == PassingSide::Right;
  const double left_height = left_normal.dot(x) - (to_right ? kTie : 0.0);
  const double right_height = right_normal.dot(x) - (to_right ? 0.0 : kTie);
  double height = std::max(left_height, right_height);
  Vec2 normal = left_height > right_height ? left_normal : right_normal;
  double true_height = normal.dot(x);
  for (std::uint32_t k = 0; k < near.edges; ++k) {
    const Vec2& n = difference.normals[(near.first + k) % count];
    const double edge_height = n.dot(x - vertex(k));
    if (edge_height > height) {
      height = true_height = edge_height;
      normal = n;
    }
  }
  // inside a convex set the nearest boundary point lies on the nearest line
  if (near.edges > 0 && true_height <= 0)
    return make_escape(x - true_height * normal, normal, relative_velocity, horizon, true);

  // outside: the nearest of the legs and near edges
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Nearest best{foot_on(left, left_along, kFar, x), left_normal};
  auto consider = [&](const Vec2& point, const Vec2& outward) {
    if ((point - x).squaredNorm() < (best.point - x).squaredNorm()) best = {point, outward};
  };
  consider(foot_on(right, right_along, kFar, x), right_normal);
  for (std::uint32_t k = 0; k < near.edges; ++k) {
    const Vec2 edge = vertex(k + 1) - vertex(k);
    const double length = edge.norm();
    consider(foot_on(vertex(k), edge / length, length, x),
             difference.normals[(near.first + k) % count]);
  }
  const Vec2 away = x - best.point;
  const double distance = away.norm();
  if (distance > 1e-9) best.normal = away / distance;
  return make_escape(best.point, best.normal, relative_velocity, horizon, false);
}

}  // namespace sumogamma
