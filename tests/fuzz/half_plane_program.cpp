// Whatever planes come in: the answer is finite and within the speed disc, and hard planes that
// admit the null vector hold.
#include "geometry/half_plane_program.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <vector>

using namespace sumogamma;

namespace {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
  double number() {
    double value = 0;
    take(&value, sizeof value);
    return value;
  }
  unsigned small(unsigned count) {
    std::uint8_t value = 0;
    take(&value, 1);
    return value % count;
  }
  /// A number of everyday size on most inputs, any bits at all on the others.
  double velocity() {
    if (small(8) == 0) return number();
    std::int16_t value = 0;
    take(&value, sizeof value);
    return value / 2048.0;
  }

 private:
  void take(void* to, std::size_t count) {
    const std::size_t left = std::min(count, size_);
    std::memcpy(to, data_, left);
    data_ += left;
    size_ -= left;
  }
  const std::uint8_t* data_;
  std::size_t size_;
};

bool everyday(const HalfPlane& plane) {
  return plane.point.allFinite() && plane.point.norm() < 1e3 &&
         std::abs(plane.normal.norm() - 1) < 1e-9;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const std::size_t count = bytes.small(16), hard = bytes.small(8);
  std::vector<HalfPlane> planes;
  bool lawful = true;
  for (std::size_t k = 0; k < count; ++k) {
    HalfPlane plane{{bytes.velocity(), bytes.velocity()}, {bytes.velocity(), bytes.velocity()}};
    if (bytes.small(4) != 0 && plane.normal.norm() > 1e-6 && plane.normal.allFinite() &&
        plane.normal.norm() < 1e6)
      plane.normal /= plane.normal.norm();
    lawful = lawful && everyday(plane) && (k >= hard || slack(plane, Vec2(0, 0)) >= 0);
    planes.push_back(plane);
  }
  const Vec2 target{bytes.velocity(), bytes.velocity()};
  const double radius = bytes.velocity();
  ProgramScratch scratch;
  const ProgramResult result =
      closest_point(planes, std::min(hard, count), target, radius, scratch);
  if (!result.point.allFinite()) std::abort();
  if (!lawful || !(radius > 0) || radius > 100) return 0;
  if (result.point.norm() > radius + 1e-6) std::abort();
  for (std::size_t k = 0; k < std::min(hard, count); ++k)
    if (slack(planes[k], result.point) < -1e-6) std::abort();
  return 0;
}
