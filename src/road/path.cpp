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
  auto middle =
      std::lower_bound(lane_middle.begin(), lane_middle.end(), first,
                       [](const LaneMiddle& one, std::size_t piece) { return one.piece < piece; });
  for (; middle != lane_middle.end() && middle->piece <= last; ++middle) {
    cut.left = std::max(cut.left, -middle->offset);
    cut.right = std::max(cut.right, middle->offset);
  }
  return cut;
}

}  // namespace sumogamma
