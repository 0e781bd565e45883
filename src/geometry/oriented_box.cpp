#include "geometry/oriented_box.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

std::optional<OrientedBox> as_box(std::span<const Vec2> body_outline) {
  if (body_outline.size() != 4) return std::nullopt;
  Vec2 low = body_outline[0], high = body_outline[0];
  for (const Vec2& vertex : body_outline) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  // four corners on the bounding box, each on another one: opposite ones differ in both coordinates
  for (std::size_t k = 0; k < 4; ++k) {
    const Vec2 &corner = body_outline[k], &opposite = body_outline[(k + 2) % 4];
    if ((corner.x() != low.x() && corner.x() != high.x()) ||
        (corner.y() != low.y() && corner.y() != high.y()) || corner + opposite != low + high)
      return std::nullopt;
  }
  OrientedBox box;
  box.center = 0.5 * (low + high);
  box.half = 0.5 * (high - low);
  return box.half.allFinite() && box.half.minCoeff() > 0 ? std::optional(box) : std::nullopt;
}

double separation(const OrientedBox& a, const OrientedBox& b) {
  const Vec2 offset = b.center - a.center;
  // b's axes in a's: the cosine and sine between them serve all four tests
  const double c = std::abs(a.forward.dot(b.forward)), s = std::abs(cross(a.forward, b.forward));
  const double a_x = std::abs(offset.dot(a.forward)) - a.half.x() - c * b.half.x() - s * b.half.y();
  const double a_y =
      std::abs(cross(a.forward, offset)) - a.half.y() - s * b.half.x() - c * b.half.y();
  const double b_x = std::abs(offset.dot(b.forward)) - b.half.x() - c * a.half.x() - s * a.half.y();
  const double b_y =
      std::abs(cross(b.forward, offset)) - b.half.y() - s * a.half.x() - c * a.half.y();
  return std::max(std::max(a_x, a_y), std::max(b_x, b_y));
}

PolygonDifference box_difference(const OrientedBox& b, const OrientedBox& a) {
  // the axis of b that lies within the quarter turn to the left of a's forward axis, and b's
  // extents along it
  double c = a.forward.dot(b.forward), s = cross(a.forward, b.forward);
  Vec2 axis = b.forward, half = b.half;
  if (c < 0) {
    c = -c;
    s = -s;
    axis = -axis;
  }
  if (s < 0) {
    axis = left_of(axis);
    half = {half.y(), half.x()};
  }
  const Vec2 a_left = left_of(a.forward), axis_left = left_of(axis);
  const Vec2 center = b.center - a.center;

  // edges in order of direction: a.forward, axis, a.left, axis.left, and the same backwards
  PolygonDifference difference;
  difference.count = 8;
  const Vec2 edges[4] = {(2 * a.half.x()) * a.forward, (2 * half.x()) * axis,
                         (2 * a.half.y()) * a_left, (2 * half.y()) * axis_left};
  const Vec2 normals[4] = {-a_left, -axis_left, a.forward, axis};
  Vec2 vertex = -0.5 * (edges[0] + edges[1] + edges[2] + edges[3]);
  for (std::uint32_t k = 0; k < 4; ++k) {
    difference.vertices[k] = center + vertex;
    difference.vertices[k + 4] = center - vertex;
    difference.normals[k] = normals[k];
    difference.normals[k + 4] = -normals[k];
    vertex += edges[k];
  }
  return difference;
}

}  // namespace sumogamma
