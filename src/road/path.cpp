#include "road/path.h"

#include <algorithm>

namespace sumogamma {

const PathStretch& Path::stretch_at(double along) const {
  auto after = std::upper_bound(
      stretches.begin(), stretches.end(), along,
      [](double value, const PathStretch& stretch) { return value < stretch.from; });
  return after == stretches.begin() ? stretches.front() : *(after - 1);
}

Cut Path::cut_between(double from, double to) const {
  Cut cut;
  const auto first = static_cast<std::size_t>(std::max(from, 0.0) / kProfileStep);
  const auto last = static_cast<std::size_t>(std::max(to, 0.0) / kProfileStep);
  for (std::size_t i = first; i <= last && i < lane_middle.size(); ++i) {
    cut.left = std::max(cut.left, -lane_middle[i]);
    cut.right = std::max(cut.right, lane_middle[i]);
  }
  return cut;
}

}  // namespace sumogamma
