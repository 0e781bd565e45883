#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geometry/vec2.h"

namespace sumogamma {

/// How far to move the edges of an outline outwards, by the side of the body they face [m].
struct Margins {
  double front = 0, rear = 0, side = 0;
};

/// A convex outline in world axes relative to its own reference point [m]: counter-clockwise,
/// starting at its lowest vertex (the leftmost of them), with the outward unit normal of every edge
/// (k to k+1). No zero-length edges, so a point has one vertex and no edge, a segment two vertices
/// and two edges. Fixed capacity: no allocation, ever.
template <std::size_t Capacity>
struct ConvexOutline {
  std::uint32_t count = 0;
  std::uint32_t highest = 0;  ///< index of the highest vertex (the rightmost of them)
  std::array<Vec2, Capacity> vertices;
  std::array<Vec2, Capacity> normals;
};

/// Outline of one body.
using ConvexPolygon = ConvexOutline<8>;
/// Minkowski difference of two of them.
using PolygonDifference = ConvexOutline<16>;

/// The part of a convex outline that the origin sees: the run of edges that face it, from the left
/// tangent vertex to the right one. A point, or a segment seen end-on, has one edge of no length
/// across the line of sight. None where the origin is inside.
// the arrays are filled as far as they count
// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
struct NearSide {
  std::uint32_t edges = 0;
  bool inside = false;             ///< the origin lies in the outline or on its boundary
  std::array<Vec2, 16> vertices;   ///< edges + 1 of them
  std::array<Vec2, 16> normals;    ///< outward, of the edges
  std::array<double, 16> heights;  ///< of the edges' lines over the origin, < 0 [m]
};

/// The body-axes outline (at most 8 vertices, convex, counter-clockwise) turned so that its x axis
/// points along `forward` (unit), its edges moved outwards by the margins. Coinciding and collinear
/// vertices are dropped; a point or segment with a positive margin becomes a box. Not finite in: a
/// point at the reference.
ConvexPolygon place_polygon(std::span<const Vec2> body_outline, const Vec2& forward,
                            const Margins& margins = {});

/// B - A = { b + offset - a } of Eq. 3, with `offset` the position of B's reference point seen from
/// A's, by merging the edges of B and -A in order of direction: O(|A| + |B|), no hull. Parallel
/// edges join.
PolygonDifference minkowski_difference(const ConvexPolygon& b, const ConvexPolygon& a,
                                       const Vec2& offset);

/// The near side of a difference.
NearSide near_side(const PolygonDifference& difference);

/// Depth of the overlap of A at the origin and B at `offset` [m]: the least displacement that
/// separates them (separating axis theorem over the edges' normals); <= 0 where they are apart,
/// then a lower bound of the distance.
double overlap_depth(const ConvexPolygon& a, const ConvexPolygon& b, const Vec2& offset);

}  // namespace sumogamma
