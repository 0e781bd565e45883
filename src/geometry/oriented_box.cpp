#include "geometry/oriented_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "geometry/segment.h"

namespace sumogamma {

std::optional<OrientedBox> as_box(std::span<const Vec2> body_outline) {
  if (body_outline.size() != 4) return std::nullopt;
  // almost always: centred, as box_footprint makes it
  const Vec2 half = body_outline[1];
  if (half.x() > 0 && half.y() > 0 && body_outline[0] == Vec2(half.x(), -half.y()) &&
      body_outline[2] == Vec2(-half.x(), half.y()) && body_outline[3] == -half && half.allFinite())
    return OrientedBox{Vec2::Zero(), Vec2(1, 0), half};
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

namespace {

std::array<Vec2, 4> corners_of(const OrientedBox& box) {
  const Vec2 along = box.half.x() * box.forward, aside = box.half.y() * left_of(box.forward);
  return {Vec2(box.center + along - aside), Vec2(box.center + along + aside),
          Vec2(box.center - along + aside), Vec2(box.center - along - aside)};
}

}  // namespace

double distance(const OrientedBox& a, const OrientedBox& b) {
  if (separation(a, b) <= 0.0) return 0.0;
  const std::array<Vec2, 4> one = corners_of(a), other = corners_of(b);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < one.size(); ++i)
    for (std::size_t k = 0; k < other.size(); ++k)
      least = std::min(
          least, distance_of_segments(one[i], one[(i + 1) % 4], other[k], other[(k + 1) % 4]));
  return least;
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

BoxDifference::BoxDifference(const OrientedBox& b, const OrientedBox& a)
    : center_(b.center - a.center) {
  // the axis of b that lies within the quarter turn to the left of a's forward axis, and b's
  // extents along it
  double c = a.forward.dot(b.forward), s = cross(a.forward, b.forward);
  const bool swapped = (c < 0) != (s < 0);
  const Vec2 ahead = c < 0 ? Vec2(-b.forward) : b.forward;
  c = std::abs(c);
  s = std::abs(s);
  if (swapped) std::swap(c, s);
  const Vec2 axis = swapped ? left_of(ahead) : ahead, axis_left = left_of(axis),
             a_left = left_of(a.forward);
  const double x = swapped ? b.half.y() : b.half.x(), y = swapped ? b.half.x() : b.half.y();
  half_edges_ = {a.half.x() * a.forward, x * axis, a.half.y() * a_left, y * axis_left};
  normals_ = {-a_left, -axis_left, a.forward, axis};
  extents_ = {a.half.y() + s * x + c * y, y + s * a.half.x() + c * a.half.y(),
              a.half.x() + c * x + s * y, x + c * a.half.x() + s * a.half.y()};
  gap_ = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    along_[k] = normals_[k].dot(center_);
    const double gap = std::abs(along_[k]) - extents_[k];
    if (gap <= gap_) continue;
    gap_ = gap;
    axis_ = along_[k] < 0 ? Vec2(-normals_[k]) : normals_[k];
  }
}

/// Where edge k begins, from the centre: the generators before it are passed, it and those after
/// are still to come.
Vec2 BoxDifference::corner(std::uint32_t k) const {
  const auto& e = half_edges_;
  Vec2 at;
  switch (k & 3u) {
    case 0:
      at = -e[0] - e[1] - e[2] - e[3];
      break;
    case 1:
      at = e[0] - e[1] - e[2] - e[3];
      break;
    case 2:
      at = e[0] + e[1] - e[2] - e[3];
      break;
    default:
      at = e[0] + e[1] + e[2] - e[3];
      break;
  }
  return k < 4 ? at : Vec2(-at);
}

NearSide BoxDifference::near_side() const {
  NearSide side;
  // a bit for every edge that faces the origin
  const auto bit = [](bool faces, unsigned k) { return static_cast<std::uint32_t>(faces) << k; };
  const std::uint32_t facing = bit(along_[0] < -extents_[0], 0) | bit(along_[1] < -extents_[1], 1) |
                               bit(along_[2] < -extents_[2], 2) | bit(along_[3] < -extents_[3], 3) |
                               bit(along_[0] > extents_[0], 4) | bit(along_[1] > extents_[1], 5) |
                               bit(along_[2] > extents_[2], 6) | bit(along_[3] > extents_[3], 7);
  if (facing == 0) {
    side.inside = true;
    return side;
  }
  // they are one run: it begins where the edge before doesn't face
  std::uint32_t k = 0;
  for (const std::uint32_t begins = facing & ~((facing << 1) | (facing >> 7)); !(begins >> k & 1u);)
    ++k;
  Vec2 vertex = center_ + corner(k);
  side.vertices[0] = vertex;
  for (; side.edges < 4 && (facing >> k & 1u); k = (k + 1) & 7u) {
    const std::uint32_t m = k & 3u, edge = side.edges++;
    const double sign = k < 4 ? 1.0 : -1.0;
    side.normals[edge] = sign * normals_[m];
    side.heights[edge] = sign * along_[m] + extents_[m];
    vertex += (2.0 * sign) * half_edges_[m];
    side.vertices[edge + 1] = vertex;
  }
  return side;
}

PolygonDifference BoxDifference::polygon() const {
  PolygonDifference difference;
  difference.count = 8;
  for (std::uint32_t k = 0; k < 4; ++k) {
    const Vec2 from_center = corner(k);
    difference.vertices[k] = center_ + from_center;
    difference.vertices[k + 4] = center_ - from_center;
    difference.normals[k] = normals_[k];
    difference.normals[k + 4] = -normals_[k];
  }
  return difference;
}

}  // namespace sumogamma
