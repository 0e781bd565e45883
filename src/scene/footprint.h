#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geometry/vec2.h"

namespace sumogamma {

/// Convex outline of an agent in body axes (x forward, y left) about its centre [m],
/// counter-clockwise, at most kCapacity vertices, stored inline so that a scene copies without
/// allocation.
struct Footprint {
  static constexpr std::size_t kCapacity = 8;
  std::array<Vec2, kCapacity> vertices{};
  std::uint32_t count = 0;
  double radius = 0;  ///< of the circumscribed disc about the centre [m]

  std::span<const Vec2> outline() const { return {vertices.data(), count}; }
};

/// Box of the given length (along the heading) and width [m].
Footprint box_footprint(double length, double width);

}  // namespace sumogamma
