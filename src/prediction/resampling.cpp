#include "prediction/resampling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.h"

namespace sumogamma {

namespace {

constexpr double kAssumedStep = 0.4;  // of files that tell no rate [s]
constexpr double kGap = 1.5;          // of the file's own steps
constexpr double kMostSteps = 1e7;
constexpr double kSlowestCrowd =
    0.2;  // upper quartile of speeds that no rate assumed may give [m/s]

/// The file's own step between frames, in frames: the greatest divisor of all, or the median of
/// times.
double own_step(const RawRecording& raw, const std::vector<RawPoint>& points) {
  std::int64_t divisor = 0;
  std::vector<double> steps;
  for (std::size_t k = 1; k < points.size(); ++k) {
    const double off = std::abs(points[k].frame - points.front().frame);
    if (!raw.times) divisor = std::gcd(divisor, static_cast<std::int64_t>(off));
    if (points[k].id == points[k - 1].id) steps.push_back(points[k].frame - points[k - 1].frame);
  }
  if (!raw.times) return static_cast<double>(std::max<std::int64_t>(divisor, 1));
  if (steps.empty()) return 1.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// Seconds of one frame, and where that had to be assumed.
double unit_of(const RawRecording& raw, const ReadOptions& options, double step, bool& assumed) {
  assumed = false;
  if (options.period > 0 && !raw.times) return options.period;
  if (raw.unit > 0) return raw.unit;
  if (raw.step > 0) return raw.step / step;
  assumed = true;
  return kAssumedStep / step;
}

/// One track being made of an agent's observations, in seconds.
struct Sampler {
  std::span<const RawPoint> points;
  double unit, begin;  ///< seconds a frame; time of the recording's first observation
  double gap;          ///< wider than this, what is between two points is filled in [s]
  double period;       ///< of the track [s]
  int offset;          ///< of the recording's first observation [steps]

  double time(std::size_t k) const { return points[k].frame * unit - begin; }

  /// Appends the steps within [first, last] of the points to a track.
  void sample(std::size_t first, std::size_t last, TrackSet& set, std::vector<double>& annotated,
              Track& track) const {
    constexpr double kSame = 1e-6;  // [steps]
    const auto from = static_cast<int>(std::ceil(time(first) / period - kSame));
    const auto to = static_cast<int>(std::floor(time(last) / period + kSame));
    track.first = from + offset;
    std::size_t k = first;
    for (int step = from; step <= to; ++step) {
      const double now = step * period;
      while (k < last && time(k + 1) <= now + kSame * period) ++k;
      bool filled = false;
      Vec2 position = points[k].position;
      if (k < last && now - time(k) > kSame * period) {
        const double width = time(k + 1) - time(k), share = (now - time(k)) / width;
        position += share * (points[k + 1].position - points[k].position);
        filled = width > gap;
      }
      track.position.push_back(position);
      track.filled.push_back(filled);
      annotated.push_back(points[k].heading);
      set.filled_steps += filled;
    }
  }
};

void check_speeds(const TrackSet& set, const std::string& file) {
  std::vector<double> speed;
  for (const Track& track : set.tracks)
    for (std::size_t k = 1; k < track.position.size(); ++k)
      speed.push_back((track.position[k] - track.position[k - 1]).norm() / set.period);
  if (speed.size() < 20) return;
  const auto upper = speed.begin() + static_cast<std::ptrdiff_t>(3 * speed.size() / 4);
  std::nth_element(speed.begin(), upper, speed.end());
  if (*upper > 0.01 && *upper < kSlowestCrowd)
    throw Error(file, fmt::format("tells no rate, and a frame every 0.4 s would make three of four "
                                  "speeds less than {:.2f} m/s; --fps or --period says what it is",
                                  *upper));
}

/// How a recording is sampled.
struct Sampling {
  double unit, step;   ///< seconds a frame; frames from one observation to the next
  double begin, fill;  ///< time of the first observation; the longest gap that is filled [s]
  double period;       ///< of the tracks [s]
  const AgentTypeTable& types;
};

void append_agent_tracks(std::span<const RawPoint> points, const Sampling& how, TrackSet& set,
                         std::uint32_t& fresh) {
  const double gap = kGap * how.step * how.unit;
  const Sampler sampler{points, how.unit,   how.begin,
                        gap,    how.period, static_cast<int>(std::llround(how.begin / how.period))};
  std::size_t first = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const bool ends = k + 1 == points.size();
    const double width = ends ? 0.0 : sampler.time(k + 1) - sampler.time(k);
    if (!ends && width > gap && width <= how.fill + 1e-9) ++set.filled_gaps;
    if (!ends && (width <= gap || width <= how.fill + 1e-9)) continue;
    Track track{first == 0 ? points[0].id : ++fresh, points[0].type, 0, {}, {}};
    std::vector<double> annotated;
    sampler.sample(first, k, set, annotated, track);
    if (!ends) ++set.split_gaps;
    const std::size_t from = std::exchange(first, k + 1);
    if (track.position.empty()) continue;
    for (const RawPoint& point : points.subspan(from, k + 1 - from)) {
      if (!(point.length > 0 && point.width > 0)) continue;
      track.length = point.length;
      track.width = point.width;
      break;
    }
    point_track(how.types, annotated, track);
    set.tracks.push_back(std::move(track));
  }
}

}  // namespace

TrackSet resampled_tracks(const RawRecording& raw, const ReadOptions& options,
                          const AgentTypeTable& types, const std::string& file) {
  std::vector<RawPoint> points = raw.points;
  std::stable_sort(points.begin(), points.end(), [](const RawPoint& a, const RawPoint& b) {
    return a.id != b.id ? a.id < b.id : a.frame < b.frame;
  });
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k].id == points[k - 1].id && points[k].frame == points[k - 1].frame)
      throw Error(file,
                  fmt::format("agent {} is twice in frame {}", points[k].id, points[k].frame));
  TrackSet set;
  set.name = raw.name;
  set.format = raw.format;
  set.notes = raw.notes;
  set.period = options.sample;
  const double step = own_step(raw, points);
  bool assumed = false;
  const double unit = unit_of(raw, options, step, assumed);
  if (assumed) set.notes.emplace_back("tells no rate: a step every 0.4 s is assumed");
  set.own_period = unit * step;
  set.assumed_period = assumed;
  const auto [earliest, latest] =
      std::minmax_element(points.begin(), points.end(),
                          [](const RawPoint& a, const RawPoint& b) { return a.frame < b.frame; });
  if ((latest->frame - earliest->frame) * unit / options.sample > kMostSteps)
    throw Error(file, fmt::format("frames reach from {} to {}, expected counted steps, not times",
                                  earliest->frame, latest->frame));
  const double begin = earliest->frame * unit;
  const Sampling how{unit, step, begin, options.fill, options.sample, types};
  std::uint32_t fresh = points.back().id;
  for (std::size_t first = 0; first < points.size();) {
    std::size_t last = first;
    while (last < points.size() && points[last].id == points[first].id) ++last;
    append_agent_tracks(std::span(points).subspan(first, last - first), how, set, fresh);
    first = last;
  }
  if (assumed) check_speeds(set, file);
  return set;
}

}  // namespace sumogamma
