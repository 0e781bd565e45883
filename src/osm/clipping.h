#pragma once

#include <clipper.hpp>
#include <cmath>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma::osm {

inline constexpr double kClipperScale = 1000.0;  ///< Clipper works on whole numbers: millimetres

inline ClipperLib::Path to_clipper(const std::vector<Vec2>& points) {
  ClipperLib::Path path;
  for (const Vec2& p : points)
    path.emplace_back(std::llround(p.x() * kClipperScale), std::llround(p.y() * kClipperScale));
  return path;
}

inline std::vector<Vec2> from_clipper(const ClipperLib::Path& path) {
  std::vector<Vec2> points;
  for (const ClipperLib::IntPoint& p : path)
    points.emplace_back(static_cast<double>(p.X) / kClipperScale,
                        static_cast<double>(p.Y) / kClipperScale);
  return points;
}

/// What is left of polygons (filled by even and odd) without others, each with its holes (filled by
/// winding). Many overlapping ones are taken off in portions: Clipper's time grows with the square
/// of those that overlap, and what is left of a polygon is soon little.
ClipperLib::Paths without(ClipperLib::Paths subject,
                          const std::vector<ClipperLib::Paths>& taken_off);

}  // namespace sumogamma::osm
