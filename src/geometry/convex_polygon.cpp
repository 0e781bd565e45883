#include "geometry/convex_polygon.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace sumogamma {

namespace {

// shorter edges carry no direction worth a constraint [m]
constexpr double kLeastEdge = 1e-9;

using BodyOutline = std::array<Vec2, 8>;

/// Distinct corners of the outline in body axes; collinear ones dropped so that every edge has its
/// own normal.
std::uint32_t clean_outline(std::span<const Vec2> outline, BodyOutline& clean) {
  std::uint32_t count = 0;
  for (const Vec2& vertex : outline.first(std::min<std::size_t>(outline.size(), clean.size()))) {
    if (!vertex.allFinite()) continue;
    if (count > 0 && (vertex - clean[count - 1]).norm() <= kLeastEdge) continue;
    clean[count++] = vertex;
  }
  while (count > 1 && (clean[count - 1] - clean[0]).norm() <= kLeastEdge) --count;
  for (std::uint32_t k = 0; count > 2 && k < count;) {
    const Vec2 before = clean[k] - clean[(k + count - 1) % count];
    const Vec2 after = clean[(k + 1) % count] - clean[k];
    if (cross(before, after) > 1e-12 * (before.norm() * after.norm())) {
      ++k;
      continue;
    }
    std::copy(clean.begin() + k + 1, clean.begin() + count, clean.begin() + k);
    --count;
    k = 0;
  }
  if (count == 0) clean[count++] = Vec2::Zero();
  return count;
}

double margin_along(const Margins& margins, const Vec2& normal) {
  const double along = normal.x() > 0 ? margins.front : margins.rear;
  return along * normal.x() * normal.x() + margins.side * normal.y() * normal.y();
}

/// Moves every edge outwards; a point or segment becomes the box around it.
std::uint32_t inflate(const Margins& margins, BodyOutline& outline, std::uint32_t count) {
  if (margins.front <= 0 && margins.rear <= 0 && margins.side <= 0) return count;
  if (count < 3) {
    Vec2 low = outline[0], high = outline[0];
    for (std::uint32_t k = 1; k < count; ++k) {
      low = low.cwiseMin(outline[k]);
      high = high.cwiseMax(outline[k]);
    }
    low -= Vec2(margins.rear, margins.side);
    high += Vec2(margins.front, margins.side);
    outline[0] = {high.x(), low.y()};
    outline[1] = high;
    outline[2] = {low.x(), high.y()};
    outline[3] = low;
    return 4;
  }
  BodyOutline normals, moved;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec2 edge = outline[(k + 1) % count] - outline[k];
    normals[k] = Vec2(edge.y(), -edge.x()) / edge.norm();
  }
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec2 &before = normals[(k + count - 1) % count], &after = normals[k];
    const double m1 = margin_along(margins, before), m2 = margin_along(margins, after);
    const double turn = cross(before, after);
    // the corner where the two moved edges meet; almost straight on, the mean shift is the same to
    // rounding
    if (turn > 1e-6)
      moved[k] = outline[k] +
                 Vec2(m1 * after.y() - m2 * before.y(), m2 * before.x() - m1 * after.x()) / turn;
    else
      moved[k] = outline[k] + 0.5 * (m1 + m2) * after;
  }
  outline = moved;
  return count;
}

}  // namespace

ConvexPolygon place_polygon(std::span<const Vec2> body_outline, const Vec2& forward,
                            const Margins& margins) {
  BodyOutline body;
  std::uint32_t count = clean_outline(body_outline, body);
  count = inflate(margins, body, count);
  const Vec2 axis = forward.allFinite() ? forward : Vec2(1, 0);

  BodyOutline world;
  std::uint32_t lowest = 0;
  for (std::uint32_t k = 0; k < count; ++k) {
    world[k] = from_body(body[k], axis);
    const Vec2 &p = world[k], &low = world[lowest];
    if (p.y() < low.y() || (p.y() == low.y() && p.x() < low.x())) lowest = k;
  }
  ConvexPolygon polygon;
  polygon.count = count;
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t from = lowest + k < count ? lowest + k : lowest + k - count;
    polygon.vertices[k] = world[from];
    const Vec2 &p = world[from], &high = polygon.vertices[polygon.highest];
    if (p.y() > high.y() || (p.y() == high.y() && p.x() > high.x())) polygon.highest = k;
  }
  for (std::uint32_t k = 0; count > 1 && k < count; ++k) {
    const Vec2 edge = polygon.vertices[k + 1 < count ? k + 1 : 0] - polygon.vertices[k];
    polygon.normals[k] = Vec2(edge.y(), -edge.x()) / edge.norm();
  }
  return polygon;
}

PolygonDifference minkowski_difference(const ConvexPolygon& b, const ConvexPolygon& a,
                                       const Vec2& offset) {
  // -A starts at A's highest vertex, and its edges and normals are A's, negated
  const std::uint32_t edges_b = b.count > 1 ? b.count : 0, edges_a = a.count > 1 ? a.count : 0;
  PolygonDifference difference;
  Vec2 vertex = offset + b.vertices[0] - a.vertices[a.highest];
  std::uint32_t i = 0, j = 0, ja = a.highest, count = 0;
  while (i < edges_b || j < edges_a) {
    const Vec2& nb = b.normals[i < edges_b ? i : 0];
    const Vec2& na = a.normals[ja];
    // turn from B's next edge to that of -A: positive where B's comes first
    double turn = 1.0;
    if (i == edges_b)
      turn = -1.0;
    else if (j < edges_a)
      turn = -cross(nb, na);
    difference.vertices[count] = vertex;
    const bool take_b = turn > -1e-12, take_a = j < edges_a && turn < 1e-12;
    difference.normals[count++] = take_b ? nb : Vec2(-na);
    if (take_b) {
      const std::uint32_t next = i + 1 < edges_b ? i + 1 : 0;
      vertex += b.vertices[next] - b.vertices[i];
      ++i;
    }
    if (take_a) {
      const std::uint32_t next = ja + 1 < edges_a ? ja + 1 : 0;
      vertex -= a.vertices[next] - a.vertices[ja];
      ja = next;
      ++j;
    }
  }
  if (count == 0) difference.vertices[count++] = vertex;
  difference.count = count;
  return difference;
}

NearSide near_side(const PolygonDifference& difference) {
  const std::uint32_t count = difference.count;
  NearSide side;
  std::uint32_t facing = 0;
  for (std::uint32_t k = 0; count > 1 && k < count; ++k)
    facing |= static_cast<std::uint32_t>(difference.normals[k].dot(difference.vertices[k]) < 0)
              << k;
  if (facing == 0) {
    side.inside = count > 2;
    side.vertices[0] = difference.vertices[0];
    for (std::uint32_t k = 1; k < count; ++k)
      if (difference.vertices[k].squaredNorm() < side.vertices[0].squaredNorm())
        side.vertices[0] = difference.vertices[k];
    const double distance = side.vertices[0].norm();
    side.inside |= !(distance > 0);
    if (side.inside) return side;
    // a vertex seen end-on: an edge of no length across the line of sight
    side.edges = 1;
    side.vertices[1] = side.vertices[0];
    side.normals[0] = -side.vertices[0] / distance;
    side.heights[0] = -distance;
    return side;
  }
  // the facing edges are one run: it begins where the edge before doesn't face
  std::uint32_t k = static_cast<std::uint32_t>(
      std::countr_zero(facing & ~((facing << 1) | (facing >> (count - 1)))));
  side.edges = static_cast<std::uint32_t>(std::popcount(facing));
  for (std::uint32_t edge = 0; edge <= side.edges; ++edge) {
    side.vertices[edge] = difference.vertices[k];
    side.normals[edge] = difference.normals[k];
    side.heights[edge] = difference.normals[k].dot(difference.vertices[k]);
    k = k + 1 < count ? k + 1 : 0;
  }
  return side;
}

double overlap_depth(const ConvexPolygon& a, const ConvexPolygon& b, const Vec2& offset) {
  double depth = std::numeric_limits<double>::infinity();
  if (a.count < 2 && b.count < 2) return -(offset + b.vertices[0] - a.vertices[0]).norm();
  auto along_edges = [&](const ConvexPolygon& p, const ConvexPolygon& q, const Vec2& shift) {
    for (std::uint32_t k = 0; p.count > 1 && k < p.count && depth > 0; ++k) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::uint32_t m = 0; m < q.count; ++m)
        nearest = std::min(nearest, p.normals[k].dot(q.vertices[m]));
      const double gap = nearest + p.normals[k].dot(shift - p.vertices[k]);
      depth = std::min(depth, -gap);
    }
  };
  along_edges(a, b, offset);
  along_edges(b, a, -offset);
  return depth;
}

}  // namespace sumogamma
