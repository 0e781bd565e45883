#include "osm/clipping.h"

#include <algorithm>

namespace sumogamma::osm {
namespace {

constexpr std::size_t kPortion = 16;

struct Bounds {
  ClipperLib::cInt left, right, low, high;
};

/// The box about a path that is not empty.
Bounds bounds_of(const ClipperLib::Path& path) {
  Bounds box{path[0].X, path[0].X, path[0].Y, path[0].Y};
  for (const ClipperLib::IntPoint& p : path) {
    box.left = std::min(box.left, p.X);
    box.right = std::max(box.right, p.X);
    box.low = std::min(box.low, p.Y);
    box.high = std::max(box.high, p.Y);
  }
  return box;
}

bool meet(const Bounds& a, const Bounds& b) {
  return a.left <= b.right && b.left <= a.right && a.low <= b.high && b.low <= a.high;
}

std::vector<Bounds> bounds_of_all(const ClipperLib::Paths& paths) {
  std::vector<Bounds> boxes;
  for (const ClipperLib::Path& path : paths)
    if (!path.empty()) boxes.push_back(bounds_of(path));
  return boxes;
}

bool any_meet(const std::vector<Bounds>& some, const std::vector<Bounds>& others) {
  return std::any_of(some.begin(), some.end(), [&](const Bounds& box) {
    return std::any_of(others.begin(), others.end(),
                       [&](const Bounds& other) { return meet(box, other); });
  });
}

}  // namespace

ClipperLib::Paths without(ClipperLib::Paths subject,
                          const std::vector<ClipperLib::Paths>& taken_off) {
  for (std::size_t next = 0; next < taken_off.size() && !subject.empty();) {
    const std::vector<Bounds> boxes = bounds_of_all(subject);
    ClipperLib::Clipper clipper;
    std::size_t added = 0;
    for (; next < taken_off.size() && added < kPortion; ++next) {
      if (!any_meet(bounds_of_all(taken_off[next]), boxes)) continue;
      clipper.AddPaths(taken_off[next], ClipperLib::ptClip, true);
      ++added;
    }
    if (added == 0) break;
    clipper.AddPaths(subject, ClipperLib::ptSubject, true);
    ClipperLib::Paths left;
    clipper.Execute(ClipperLib::ctDifference, left, ClipperLib::pftEvenOdd, ClipperLib::pftNonZero);
    subject = std::move(left);
  }
  return subject;
}

}  // namespace sumogamma::osm
