// Whatever outlines come in: unit normals, finite escapes, and a box difference that is the
// polygons' difference.
#include "model/velocity_obstacle.h"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "geometry/oriented_box.h"
#include "geometry/rotation.h"

using namespace sumogamma;

namespace {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  double between(double low, double high) {
    std::uint16_t value = 0;
    const std::size_t left = std::min(sizeof value, size_);
    std::memcpy(&value, data_, left);
    data_ += left;
    size_ -= left;
    return low + (high - low) * value / 65535.0;
  }

  /// Braces: in this order with every compiler.
  Vec2 vector(double most) { return Vec2{between(-most, most), between(-most, most)}; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

void check(const Escape& escape) {
  if (!escape.change.allFinite() || std::abs(escape.normal.norm() - 1) > 1e-6) std::abort();
}

std::vector<Vec2> outline(Bytes& bytes) {
  const auto corners = static_cast<std::size_t>(bytes.between(0, 8.99));
  const double length = bytes.between(0, 6), width = bytes.between(0, 3);
  std::vector<Vec2> points;
  for (std::size_t k = 0; k < corners; ++k) {
    const Vec2 turned = rotation(6.28318 * static_cast<double>(k) / static_cast<double>(corners));
    points.push_back({length * turned.x(), width * turned.y()});
  }
  return points;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const Vec2 forward_a = rotation(bytes.between(-3.2, 3.2)),
             forward_b = rotation(bytes.between(-3.2, 3.2));
  const Vec2 offset = bytes.vector(12), velocity = bytes.vector(9), intended = bytes.vector(9);
  const double horizon = bytes.between(0.1, 6), margin = bytes.between(0, 0.5);
  const ConvexPolygon a = place_polygon(outline(bytes), forward_a, {margin, margin, margin});
  const ConvexPolygon b = place_polygon(outline(bytes), forward_b);
  const PolygonDifference difference = minkowski_difference(b, a, offset);
  if (difference.count == 0 || difference.count > 16) std::abort();
  const NearSide near = near_side(difference);
  if (near.inside) {
    check(overlap_escape(difference, velocity, horizon));
  } else {
    const Escape escape = nearest_escape(near, velocity, horizon);
    check(escape);
    check(intended_escape(near, velocity, intended, horizon));
    // the boundary is reached: from there the way out is no longer than what counts as a tie
    // between the sides
    const Escape again = nearest_escape(near, velocity + escape.change, horizon);
    if (again.change.norm() > 2e-3 / horizon + 1e-6) std::abort();
  }

  const OrientedBox box_a{Vec2(0, 0), forward_a,
                          Vec2(bytes.between(0.05, 6), bytes.between(0.05, 3))};
  const OrientedBox box_b{offset, forward_b, Vec2(bytes.between(0.05, 6), bytes.between(0.05, 3))};
  const BoxDifference boxes(box_b, box_a);
  const NearSide quick = boxes.near_side();
  if (quick.inside != (separation(box_a, box_b) <= 0)) {
    if (std::abs(separation(box_a, box_b)) > 1e-9) std::abort();
  } else if (!quick.inside) {
    check(nearest_escape(quick, velocity, horizon));
    check(intended_escape(quick, velocity, intended, horizon));
  }
  return 0;
}
