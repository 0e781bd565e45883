#include "road/smoothing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "road/folds.h"
#include "road/path_pieces.h"
#include "road/turnaround.h"

namespace sumogamma {

namespace {

constexpr double kTight = 2.5;  ///< radius within which only two-wheelers turn [m]

/// Curvature of the circle through three points [1/m], 0 where they are collinear or coincide.
double menger_curvature(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double product = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return product > 1e-9 ? 2.0 * std::abs(cross(b - a, c - b)) / product : 0.0;
}

/// Is the circle through three points larger than `radius` for sure? Tells it without roots.
bool bends_less(const Vec2& a, const Vec2& b, const Vec2& c, double radius) {
  constexpr double kSure = 0.99;
  const double twice = 2.0 * cross(b - a, c - b) * radius;
  return twice * twice <
         kSure * (b - a).squaredNorm() * (c - b).squaredNorm() * (c - a).squaredNorm();
}

/// Half width [m] of the box filter at each sample: enough for the radius around bends that are too
/// tight, 0 elsewhere, with ramps between. A right angle filtered over +-w turns with radius w /
/// sqrt(2) at its tightest and is cut by a third of w, so long bodies don't get all they want: they
/// must not cut over the kerb.
std::vector<double> filter_widths(const std::vector<Vec2>& samples, double step,
                                  double turning_radius) {
  constexpr double kWidest = 4.0, kReach = 2.0, kReachInRadii = 0.53, kRamp = 0.8;
  const double width = std::min(std::sqrt(2.0) * turning_radius, kWidest);
  // over as long a chord a corner seems as wide as a bicycle turns
  const double chord = std::min(kReach, kReachInRadii * turning_radius);
  const auto reach = static_cast<std::size_t>(std::max(1.0, chord / step));
  std::vector<double> widths(samples.size(), 0.0);
  for (std::size_t i = reach; i + reach < samples.size(); ++i) {
    if (bends_less(samples[i - reach], samples[i], samples[i + reach], turning_radius)) continue;
    const double turns =
        menger_curvature(samples[i - reach], samples[i], samples[i + reach]) * turning_radius;
    if (turns <= 1.0) continue;
    if (turning_radius > kTight) {
      widths[i] = width;
      continue;
    }
    // two-wheelers have the room for the whole of a window, which turns by an angle with radius
    // w / (2 sin(angle / 2)), and little room in their lane before a corner
    const double needed = std::min(turns * static_cast<double>(reach) * step, width);
    const auto held = static_cast<std::size_t>(needed / step);
    const std::size_t last = std::min(i + held + 1, widths.size());
    for (std::size_t k = i - std::min(i, held); k < last; ++k)
      widths[k] = std::max(widths[k], needed);
  }
  for (std::size_t i = 1; i < widths.size(); ++i)
    widths[i] = std::max(widths[i], widths[i - 1] - kRamp * step);
  for (std::size_t i = widths.size() - 1; i-- > 0;)
    widths[i] = std::max(widths[i], widths[i + 1] - kRamp * step);
  return widths;
}
/// By how much a long body may cut a bend towards the kerb at each sample [m]: as far as its sides
/// stay off the kerb over its whole length.
std::vector<double> cuts_of(const Path& path, std::size_t count, double step,
                            const Cornering& cornering) {
  constexpr double kMost = 1.0, kOffKerb = 0.3;  // [m]
  std::vector<double> cuts(count + 1, 0.0);
  if (cornering.length <= kLongBody || path.stretches.empty()) return cuts;
  std::vector<double> free(count + 1);
  for (std::size_t i = 0; i <= count; ++i)
    free[i] = path.stretch_at(static_cast<double>(i) * step).kerb - 0.5 * cornering.width;
  const auto reach = static_cast<std::size_t>(0.5 * cornering.length / step);
  for (std::size_t i = 0; i <= count; ++i) {
    const auto begin = free.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, reach));
    const auto end = free.begin() + static_cast<std::ptrdiff_t>(std::min(i + reach, count) + 1);
    cuts[i] = std::clamp(*std::min_element(begin, end) - kOffKerb, 0.0, kMost);
  }
  return cuts;
}

/// A path's line at equal paces of about half a metre, or a fifth of a tighter turning radius.
struct Samples {
  std::vector<Vec2> points;
  std::vector<std::size_t> pieces;  ///< of the line, on which they lie
  double step = 0;                  ///< [m]

  Samples(const Polyline& line, double turning_radius) {
    constexpr double kSample = 0.5, kSampleInRadii = 0.2;
    const double sample = std::min(kSample, kSampleInRadii * turning_radius);
    const auto count = static_cast<std::size_t>(line.length() / sample) + 1;
    step = line.length() / static_cast<double>(count);
    points.reserve(count + 1);
    pieces.reserve(count + 1);
    for (std::size_t i = 0; i <= count; ++i) {
      points.push_back(line.point_at(static_cast<double>(i) * step));
      pieces.push_back(line.segment_at(static_cast<double>(i) * step));
    }
  }
};

/// Half width [m] of the box filter with which drivers smooth what a map draws with a vertex here
/// and there: as wide as it leaves them close to the line. Long bodies spread a bend towards the
/// kerb over their length and cut it, so that their fronts stay out of the lane beside.
std::vector<double> smoothing_widths(const Samples& line, const std::vector<Vec2>& sums,
                                     const std::vector<double>& cuts, const Cornering& cornering) {
  constexpr double kAside = 0.15, kWidest = 5.0, kRamp = 0.8;
  constexpr double kSpread = 0.6;  // of a body's length, to each side
  const auto& [samples, pieces, step] = line;
  const double spread = std::max(kWidest, kSpread * cornering.length);
  const auto widest = static_cast<std::size_t>(spread / step);
  std::size_t usual = 0;
  while (static_cast<double>(usual + 1) * step <= kWidest) ++usual;
  std::vector<double> widths(samples.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t most = std::min({widest, i, samples.size() - 1 - i});
    // on a straight piece every mean lies on the line
    if (cuts[i] == 0.0) {
      const std::size_t straight = std::min(most, usual);
      if (pieces[i - straight] == pieces[i + straight]) {
        widths[i] = static_cast<double>(straight) * step;
        continue;
      }
    }
    std::size_t window = 0;
    for (std::size_t wider = 1; wider <= most; ++wider) {
      const Vec2 mean =
          (sums[i + wider + 1] - sums[i - wider]) / static_cast<double>(2 * wider + 1);
      const Vec2 chord = samples[i + wider] - samples[i - wider];
      const bool to_kerb = (cross(chord, mean - samples[i]) > 0.0) == cornering.keep_left;
      const double cut = to_kerb ? cuts[i] : 0.0, aside = kAside + cut;
      const double reach = cut > 0.0 ? spread : kWidest;
      if ((mean - samples[i]).squaredNorm() > aside * aside ||
          static_cast<double>(wider) * step > reach)
        break;
      window = wider;
    }
    widths[i] = static_cast<double>(window) * step;
  }
  for (std::size_t i = 1; i < widths.size(); ++i)
    widths[i] = std::min(widths[i], widths[i - 1] + kRamp * step);
  for (std::size_t i = widths.size() - 1; i-- > 0;)
    widths[i] = std::min(widths[i], widths[i + 1] + kRamp * step);
  return widths;
}

/// Points of a line from one that is kept on, and how far they lie off a direction at most: tells
/// without a look at each of them whether all lie close to a chord.
struct Strip {
  Vec2 begin, direction;
  double reach = 0.0, off = 0.0;  ///< [m]

  Strip(const Vec2& from, const Vec2& towards) : begin(from), direction(towards - from) {
    reach = direction.norm();
    direction /= reach;
  }
  /// Goes on to the next point. False from where on that isn't sure to leave all within `most` [m]
  /// of the chord to it.
  bool extend(const Vec2& point, double most) {
    const Vec2 way = to_body(point - begin, direction);
    // the chord is off the direction by a share of |y| that grows from 0 to 1
    const bool sure = way.x() >= reach && off + std::abs(way.y()) <= most;
    off = sure ? std::max(off, std::abs(way.y())) : std::numeric_limits<double>::infinity();
    reach = way.x();
    return sure;
  }
};

/// Do the points between two of a line lie within kFlat of the chord?
bool is_flat(const std::vector<Vec2>& points, std::size_t from, std::size_t to) {
  constexpr double kFlat = 0.01;  // [m]
  const Vec2 chord = points[to] - points[from];
  const double length = chord.norm();
  bool flat = length > 1e-9;
  for (std::size_t k = from + 1; flat && k < to; ++k)
    flat = std::abs(cross(chord, points[k] - points[from])) < kFlat * length;
  return flat;
}

/// Leaves out vertices that lie within a centimetre of the chord over them: whoever looks along the
/// line has fewer pieces to look at.
std::vector<Vec2> without_flat_vertices(const std::vector<Vec2>& points) {
  constexpr double kSure = 0.009;  // [m]
  constexpr std::size_t kMost = 64;
  std::vector<Vec2> kept{points.front()};
  std::size_t last = 0;
  Strip strip(points[0], points[1]);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    if (i - last < kMost && (strip.extend(points[i + 1], kSure) || is_flat(points, last, i + 1)))
      continue;
    kept.push_back(points[i]);
    last = i;
    strip = Strip(points[i], points[i + 1]);
  }
  kept.push_back(points.back());
  return kept;
}

/// Leads the path along points that stand for its samples, and its places with them. Returns how
/// far along the path the points lie [m].
std::vector<double> lead_along(const std::vector<Vec2>& points, double step, Path& path) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < points.size(); ++i)
    along.push_back(along[i - 1] + (points[i] - points[i - 1]).norm());
  const std::size_t count = points.size() - 1;
  carry_places(path, [&](double& place) {
    const double index = std::clamp(place / step, 0.0, static_cast<double>(count));
    const auto i = std::min(static_cast<std::size_t>(index), count - 1);
    place = along[i] + (index - static_cast<double>(i)) * (along[i + 1] - along[i]);
  });
  path.line = Polyline(without_flat_vertices(points));
  return along;
}

/// How far to the left of each sample of a rounded line the one lies that it was made from [m].
std::vector<double> middles_of(const std::vector<Vec2>& points, const std::vector<Vec2>& rounded) {
  std::vector<double> middles(points.size(), 0.0);
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 chord = rounded[i + 1] - rounded[i - 1];
    middles[i] = cross(chord, points[i] - rounded[i]) / std::max(chord.norm(), 1e-9);
  }
  return middles;
}

/// Values at places, increasing from 0 [m], by pieces of the path instead: the farthest from 0 of
/// each, where that is far enough.
std::vector<LaneMiddle> by_pieces(const std::vector<double>& places,
                                  const std::vector<double>& values) {
  std::vector<LaneMiddle> farthest;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (std::abs(values[i]) < Path::kLeastCut) continue;
    const auto piece = static_cast<std::uint32_t>(places[i] / Path::kProfileStep);
    if (farthest.empty() || farthest.back().piece != piece)
      farthest.push_back({piece, values[i]});
    else if (std::abs(values[i]) > std::abs(farthest.back().offset))
      farthest.back().offset = values[i];
  }
  farthest.shrink_to_fit();
  return farthest;
}
}  // namespace

void round_corners(const Cornering& cornering, Path& path) {
  if (cornering.turning_radius <= 0.0 || path.line.length() < 2.0) return;
  Samples samples(path.line, cornering.turning_radius);
  if (straighten_folds(samples.step, cornering, samples.points)) {
    lead_along(samples.points, samples.step, path);
    samples = Samples(path.line, cornering.turning_radius);
  }
  if (open_turnarounds(samples.step, cornering.turning_radius, samples.points)) {
    lead_along(samples.points, samples.step, path);
    samples = Samples(path.line, cornering.turning_radius);
  }
  const auto& [points, pieces, step] = samples;
  const std::size_t count = points.size() - 1;
  std::vector<Vec2> sums(count + 2, Vec2::Zero());
  for (std::size_t i = 0; i <= count; ++i) sums[i + 1] = sums[i] + points[i];
  // wide only where the line bends tighter than the body can: other bends are driven as they lie
  const std::vector<double> widths = filter_widths(points, step, cornering.turning_radius);
  const std::vector<double> cuts = cuts_of(path, count, step, cornering);
  const std::vector<double> smoothing = smoothing_widths(samples, sums, cuts, cornering);
  std::vector<Vec2> rounded(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    // the mean over a window that shrinks towards the ends, by running sums
    const double width = std::max(widths[i], smoothing[i]);
    const std::size_t window = std::min({static_cast<std::size_t>(width / step), i, count - i});
    rounded[i] = (sums[i + window + 1] - sums[i - window]) / static_cast<double>(2 * window + 1);
  }
  const std::vector<double> along = lead_along(rounded, step, path);
  path.lane_middle = by_pieces(along, middles_of(points, rounded));
}

}  // namespace sumogamma
