#include "road/path_profile.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "road/turnaround.h"

namespace sumogamma {

namespace {
/// Curvature of the circle through three points [1/m], 0 where they are collinear or coincide.
double menger_curvature(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double product = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return product > 1e-9 ? 2.0 * std::abs(cross(b - a, c - b)) / product : 0.0;
}

/// By how much [rad] a line turns at places `step` [m] apart, to whatever side, summed from its
/// begin on: two bends one after the other don't cancel each other out.
std::vector<double> turning_sums(const Polyline& line, double step, std::size_t count) {
  std::vector<double> sums(count + 1, 0.0);
  const auto place = [&](std::size_t i) { return line.point_at(static_cast<double>(i) * step); };
  for (std::size_t i = 0; i < count; ++i) {
    double turn = 0.0;
    if (i + 1 < count) {
      // who begins before a kink begins with the direction before it
      const Vec2 in = i > 0 ? Vec2(place(i) - place(i - 1)) : line.direction_at(0.0);
      const Vec2 out = place(i + 1) - place(i);
      turn = std::abs(std::atan2(cross(in, out), in.dot(out)));
    }
    sums[i + 1] = sums[i] + turn;
  }
  return sums;
}

constexpr double kFastest = 100.0;  ///< where nothing bends [m/s]
constexpr double kTight = 2.5;      ///< radius within which only two-wheelers turn [m]

/// How a path's bends are looked at.
struct BendView {
  double step;    ///< between the places where they are looked at [m]
  double steers;  ///< [s] to each side in which a driver steers into a bend or out of it
};

/// For bicycles finer, and what is left of the map's kinks counts as bends: they turn on less, in
/// hooks of cycle paths, and swing off these where they don't slow down for that. Motorcycles ride
/// where cars drive, and no slower.
BendView bend_view(double turning_radius) {
  constexpr double kStepInRadii = 0.53, kBicycle = 1.5;  // [m]
  if (turning_radius <= 0.0 || turning_radius > kBicycle) return {2.0, 0.6};
  return {kStepInRadii * turning_radius, 0.25};
}

/// Speed [m/s] that the bend at place i leaves: the lateral acceleration is the comfortable one on
/// the mean over the way that the vehicle covers at that speed while it steers into the bend and
/// out of it, since a driver spreads what a map draws as a kink.
double speed_in_bend(const std::vector<double>& sums, const BendView& view, std::size_t i,
                     double lateral_acceleration) {
  constexpr std::size_t kWidest = 6;  // places to each side
  const std::size_t widest = std::min({kWidest, i, sums.size() - 2 - i});
  for (std::size_t k = widest; k > 0; --k) {
    const double reach = (static_cast<double>(k) + 0.5) * view.step;
    const double curvature = (sums[i + k + 1] - sums[i - k]) / (2.0 * reach);
    const double comfortable = std::sqrt(lateral_acceleration / std::max(curvature, 1e-4));
    // who is slower than it takes to cover this way spreads the bend over a shorter one
    const bool covers = comfortable * view.steers > reach - view.step;
    if (covers || k == 1)
      return k < widest ? std::min(comfortable, reach / view.steers) : comfortable;
  }
  return kFastest;
}

/// Speeds [m/s] that a line's bends leave at the places of the view.
std::vector<double> speeds_in_bends(const Polyline& line, const BendView& view,
                                    double lateral_acceleration) {
  const auto count = static_cast<std::size_t>(std::ceil(line.length() / view.step)) + 1;
  const std::vector<double> sums = turning_sums(line, view.step, count);
  std::vector<double> speeds(count);
  for (std::size_t i = 0; i < count; ++i)
    speeds[i] = speed_in_bend(sums, view, i, lateral_acceleration);
  return speeds;
}

/// A speed [m/s] between places `step` [m] apart, linear in its square, so that braking from one to
/// the next is steady.
double speed_between(const std::vector<double>& speeds, double step, double along) {
  const double place = std::max(along, 0.0) / step;
  const auto index = static_cast<std::size_t>(place);
  if (index + 1 >= speeds.size()) return speeds.back();
  const double t = place - static_cast<double>(index);
  const double here = speeds[index], next = speeds[index + 1];
  return std::sqrt((1.0 - t) * here * here + t * next * next);
}

/// Ramps of some time where braking begins and ends, instead of steps: the mean of the squares over
/// the way that is covered in that time, of a profile that holds its lows for a while.
void ease_profile(std::vector<double>& profile) {
  constexpr double kHold = 0.15, kRamp = 0.4;  // to each side [s]
  const std::size_t count = profile.size();
  /// Places to each side that are covered in some time, as far as there are any.
  const auto places = [&](std::size_t i, double time) {
    const std::size_t most = std::min(i, count - 1 - i);
    return std::min(time * profile[i] / Path::kProfileStep, static_cast<double>(most));
  };
  std::vector<double> squares(count), sums(count + 1, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = profile.begin() + static_cast<std::ptrdiff_t>(i);
    const auto reach = static_cast<std::ptrdiff_t>(places(i, kHold));
    const double low = *std::min_element(at - reach, at + reach + 1);
    squares[i] = low * low;
    sums[i + 1] = sums[i] + squares[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    // the outermost ones count in part, so that the window grows with the speed without steps
    const double reach = places(i, kRamp);
    const auto whole = static_cast<std::size_t>(reach);
    const double part = reach - static_cast<double>(whole);
    double sum = sums[i + whole + 1] - sums[i - whole];
    if (part > 0.0) sum += part * (squares[i - whole - 1] + squares[i + whole + 1]);
    profile[i] = std::sqrt(sum / (2.0 * reach + 1.0));
  }
}
}  // namespace

void compute_speed_profile(const PathRequest& request, Path& path) {
  const BendView view = bend_view(request.cornering.turning_radius);
  const double length = path.line.length();
  const auto samples = static_cast<std::size_t>(std::ceil(length / Path::kProfileStep)) + 1;
  const std::vector<double> in_bends =
      path.walking ? std::vector<double>{}
                   : speeds_in_bends(path.line, view, request.max_lateral_acceleration);
  path.speed_profile.resize(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double along = std::min(static_cast<double>(i) * Path::kProfileStep, length);
    double speed =
        std::min(path.stretch_at(along).speed_limit * request.speed_factor, request.max_speed);
    if (!path.walking) speed = std::min(speed, speed_between(in_bends, view.step, along));
    path.speed_profile[i] = std::max(speed, 1.5);
  }
  if (path.walking) return;
  for (std::size_t i = samples - 1; i-- > 0;) {
    const double ahead = path.speed_profile[i + 1];
    const double brake =
        std::sqrt(ahead * ahead + 2.0 * request.comfortable_deceleration * Path::kProfileStep);
    path.speed_profile[i] = std::min(path.speed_profile[i], brake);
  }
  ease_profile(path.speed_profile);
}

namespace {
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

/// Half width [m] of the box filter with which drivers smooth what a map draws with a vertex here
/// and there: as wide as it leaves them close to the line. Long bodies spread a bend towards the
/// kerb over their length and cut it, so that their fronts stay out of the lane beside.
std::vector<double> smoothing_widths(const std::vector<Vec2>& samples,
                                     const std::vector<Vec2>& sums, double step,
                                     const std::vector<double>& cuts, const Cornering& cornering) {
  constexpr double kAside = 0.15, kWidest = 5.0, kRamp = 0.8;
  constexpr double kSpread = 0.6;  // of a body's length, to each side
  const double spread = std::max(kWidest, kSpread * cornering.length);
  const auto widest = static_cast<std::size_t>(spread / step);
  std::vector<double> widths(samples.size(), 0.0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t most = std::min({widest, i, samples.size() - 1 - i});
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
/// Looks along the samples of a line, `near` of them at a time.
struct Heading {
  const std::vector<Vec2>& samples;
  std::size_t near;

  Vec2 into(std::size_t i) const { return samples[i] - samples[i - near]; }
  Vec2 out_of(std::size_t i) const { return samples[i + near] - samples[i]; }
  static double cosine(const Vec2& a, const Vec2& b) {
    return a.dot(b) / std::max(a.norm() * b.norm(), 1e-9);
  }
};

/// The shortest straight piece over a tip, up to `farthest` samples to each side, that leaves the
/// line and joins it again at ease: first and last sample.
std::optional<std::pair<std::size_t, std::size_t>> bridge_over(const Heading& heading,
                                                               std::size_t tip,
                                                               std::size_t farthest) {
  constexpr double kAligned = 0.5;  // cosine between the piece and the line at its ends
  const std::size_t before = std::min(farthest, tip - heading.near);
  const std::size_t after = std::min(farthest, heading.samples.size() - 1 - heading.near - tip);
  for (std::size_t span = 2 * heading.near; span <= before + after; ++span)
    for (std::size_t back = span > after ? span - after : 1; back <= std::min(before, span - 1);
         ++back) {
      const std::size_t from = tip - back, to = from + span;
      const Vec2 piece = heading.samples[to] - heading.samples[from];
      if (Heading::cosine(heading.into(from), piece) >= kAligned &&
          Heading::cosine(piece, heading.out_of(to)) >= kAligned)
        return std::make_pair(from, to);
    }
  return std::nullopt;
}

/// First and last sample of the shortest piece across a tip, up to `farthest` samples from it, on
/// which a body that turns with `radius` [m] comes round from the one branch to the other.
std::optional<std::pair<std::size_t, std::size_t>> turn_before(const std::vector<Vec2>& samples,
                                                               std::size_t tip,
                                                               std::size_t farthest,
                                                               double radius) {
  const std::size_t most = std::min({farthest, tip, samples.size() - 1 - tip});
  for (std::size_t reach = 1; reach <= most; ++reach)
    if ((samples[tip + reach] - samples[tip - reach]).norm() >= 2.0 * radius)
      return std::make_pair(tip - reach, tip + reach);
  return std::nullopt;
}

/// Draws the line straight where it turns back on itself and on again, as between the ends of lanes
/// that overlap: nobody drives to the tip and back. What turns round for good stays, but narrow
/// vehicles turn where the way back is far enough away for that, not at the tip of an acute angle.
/// Whether anything was drawn anew: samples lie closer to each other there.
bool straighten_folds(double step, const Cornering& cornering, std::vector<Vec2>& samples) {
  constexpr double kReversal = -0.35;  // cosine of a turn within kNear
  constexpr double kNear = 1.0;        // [m]
  constexpr double kFarthest = 18.0;   // [m]
  constexpr double kNarrow = 1.2;      // [m]
  const auto farthest = static_cast<std::size_t>(kFarthest / step);
  const auto near = static_cast<std::size_t>(std::max(1.0, kNear / step));
  const Heading heading{samples, near};
  bool any = false;
  for (std::size_t tip = 2 * near; tip + 2 * near < samples.size(); ++tip) {
    if (Heading::cosine(heading.into(tip), heading.out_of(tip)) > kReversal) continue;
    auto bridge = bridge_over(heading, tip, farthest);
    if (!bridge && cornering.width > 0.0 && cornering.width < kNarrow)
      bridge = turn_before(samples, tip, farthest, cornering.turning_radius);
    if (!bridge) continue;
    const auto [from, to] = *bridge;
    const Vec2 begin = samples[from], piece = samples[to] - begin;
    for (std::size_t k = from + 1; k < to; ++k)
      samples[k] = begin + static_cast<double>(k - from) / static_cast<double>(to - from) * piece;
    tip = to;
    any = true;
  }
  return any;
}

/// Leaves out vertices that lie within a centimetre of the chord over them: whoever looks along the
/// line has fewer pieces to look at.
std::vector<Vec2> without_flat_vertices(const std::vector<Vec2>& points) {
  constexpr double kFlat = 0.01;  // [m]
  constexpr std::size_t kMost = 64;
  std::vector<Vec2> kept{points.front()};
  std::size_t last = 0;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 chord = points[i + 1] - points[last];
    const double length = chord.norm();
    bool flat = i - last < kMost && length > 1e-9;
    for (std::size_t k = last + 1; flat && k <= i; ++k)
      flat = std::abs(cross(chord, points[k] - points[last])) < kFlat * length;
    if (flat) continue;
    kept.push_back(points[i]);
    last = i;
  }
  kept.push_back(points.back());
  return kept;
}
}  // namespace

double width_to_kerb(const RoadNetwork& network, const Lane& lane) {
  using namespace vehicle_class;
  const double beside = network.left_hand ? lane.beside_left : lane.beside_right;
  const auto is_carriageway = [](const Lane& outer) {
    return (outer.allowed & (kPassenger | kBus)) != 0 ||
           (outer.allowed & (kPedestrian | kOnRails)) == 0;
  };
  return 0.5 * lane.width + beside + width_beside(network, lane, false, is_carriageway);
}

namespace {
/// A path's line at equal paces of about half a metre, or a fifth of a tighter turning radius.
struct Samples {
  std::vector<Vec2> points;
  double step = 0;  ///< [m]

  Samples(const Polyline& line, double turning_radius) {
    constexpr double kSample = 0.5, kSampleInRadii = 0.2;
    const double sample = std::min(kSample, kSampleInRadii * turning_radius);
    const auto count = static_cast<std::size_t>(line.length() / sample) + 1;
    step = line.length() / static_cast<double>(count);
    for (std::size_t i = 0; i <= count; ++i)
      points.push_back(line.point_at(static_cast<double>(i) * step));
  }
};

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

/// Values at places, increasing from 0 [m], at equal steps instead: the farthest from 0 of each.
std::vector<double> by_steps(const std::vector<double>& places, const std::vector<double>& values,
                             double step) {
  std::vector<double> farthest(static_cast<std::size_t>(places.back() / step) + 1, 0.0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    double& here = farthest[static_cast<std::size_t>(places[i] / step)];
    if (std::abs(values[i]) > std::abs(here)) here = values[i];
  }
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
  const auto& [points, step] = samples;
  const std::size_t count = points.size() - 1;
  std::vector<Vec2> sums(count + 2, Vec2::Zero());
  for (std::size_t i = 0; i <= count; ++i) sums[i + 1] = sums[i] + points[i];
  // wide only where the line bends tighter than the body can: other bends are driven as they lie
  const std::vector<double> widths = filter_widths(points, step, cornering.turning_radius);
  const std::vector<double> cuts = cuts_of(path, count, step, cornering);
  const std::vector<double> smoothing = smoothing_widths(points, sums, step, cuts, cornering);
  std::vector<Vec2> rounded(count + 1);
  for (std::size_t i = 0; i <= count; ++i) {
    // the mean over a window that shrinks towards the ends, by running sums
    const double width = std::max(widths[i], smoothing[i]);
    const std::size_t window = std::min({static_cast<std::size_t>(width / step), i, count - i});
    rounded[i] = (sums[i + window + 1] - sums[i - window]) / static_cast<double>(2 * window + 1);
  }
  const std::vector<double> along = lead_along(rounded, step, path);
  path.lane_middle = by_steps(along, middles_of(points, rounded), Path::kProfileStep);
}

void move_stop_lines(const RoadNetwork& network, Path& path) {
  constexpr double kMost = 6.0, kStep = 0.25;  // [m]
  for (PathLink& link : path.links) {
    const Polyline& lane = network.lane(network.connection(link.connection).from).centerline;
    const Vec2 end = lane.points().back(), forward = lane.direction_at(lane.length());
    const auto passed = [&](double along) {
      return to_body(path.line.point_at(along) - end, forward).x() > 0.05;
    };
    double moved = link.stop_line;
    const double least = std::max(link.stop_line - kMost, 0.0);
    while (moved > least && passed(moved)) moved -= kStep;
    moved = std::max(moved, least);
    link.halt = std::max(link.halt - (link.stop_line - moved), 0.0);
    link.stop_line = moved;
  }
}

void append_span(const Polyline& line, double from, double to, std::vector<Vec2>& points) {
  points.push_back(line.point_at(from));
  const auto& vertices = line.points();
  if (from <= to) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double along = line.along_of_vertex(i);
      if (along > from && along < to) points.push_back(vertices[i]);
    }
  } else {
    for (std::size_t i = vertices.size(); i-- > 0;) {
      const double along = line.along_of_vertex(i);
      if (along < from && along > to) points.push_back(vertices[i]);
    }
  }
  points.push_back(line.point_at(to));
}

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

double Path::profile_at(double along) const {
  return speed_profile.empty() ? 0.0 : speed_between(speed_profile, kProfileStep, along);
}

}  // namespace sumogamma
