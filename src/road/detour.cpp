#include "road/detour.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "road/path_pieces.h"
#include "road/speed_profile.h"

namespace sumogamma {

namespace {

std::uint32_t piece_at(double along) {
  return static_cast<std::uint32_t>(std::max(along, 0.0) / Path::kProfileStep);
}

/// Where the lane's middle lies beside the new line: as it did, and beside the detour by as much as
/// that is off the old line.
std::vector<LaneMiddle> middles_with(const Path& old, const Polyline& line, double from, double to,
                                     double end) {
  std::vector<LaneMiddle> middles;
  for (const LaneMiddle& middle : old.lane_middle)
    if (middle.piece < piece_at(from)) middles.push_back(middle);
  for (std::uint32_t piece = piece_at(from); piece <= piece_at(end); ++piece) {
    const double along = std::clamp((piece + 0.5) * Path::kProfileStep, from, end);
    const PolylinePosition place = old.line.project(line.point_at(along), from, to);
    const Cut cut = old.cut_between(place.along, place.along);
    const double offset = cut.right - cut.left - place.offset;
    if (std::abs(offset) >= Path::kLeastCut) middles.push_back({piece, offset});
  }
  const double later = end - to;
  for (const LaneMiddle& middle : old.lane_middle) {
    const std::uint32_t piece = piece_at((middle.piece + 0.5) * Path::kProfileStep + later);
    if (middle.piece > piece_at(to) && piece > piece_at(end))
      middles.push_back({piece, middle.offset});
  }
  return middles;
}

}  // namespace

Path with_detour(const Path& path, double from, double to, std::span<const Vec2> points) {
  Path changed = path;
  std::vector<Vec2> line;
  append_span(path.line, 0.0, from, line);
  line.insert(line.end(), points.begin(), points.end());
  const double end = Polyline(line).length();
  append_span(path.line, to, path.line.length(), line);
  changed.line = Polyline(line);
  const double scale = (end - from) / (to - from);
  const auto carried = [&](double place) {
    if (place <= from) return place;
    return place < to ? from + scale * (place - from) : end + (place - to);
  };
  carry_places(changed, [&](double& place) { place = carried(place); });
  changed.arrival = carried(path.arrival);
  changed.lane_middle = middles_with(path, changed.line, from, to, end);
  compute_speed_profile(path.trip->request, changed);
  return changed;
}

}  // namespace sumogamma
