#include "realism/recorded_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "prediction/track_set.h"
#include "realism/smoothing.h"

namespace sumogamma {

namespace {

constexpr double kCoarsest = 0.5;   // frames farther apart say nothing of motion at 10 Hz [s]
constexpr double kMoving = 0.5;     // slower than this a velocity has no direction [m/s]
constexpr double kRolls = 2.0;      // from this speed on wheels roll where they point [m/s]
constexpr double kMostSlip = 60.0;  // of a heading from that direction [degrees]
constexpr double kKnown = 1.0;      // what is known of somebody at the start of a window [s]
constexpr double kSame = 1e-6;      // of two times [s]

/// Headings without jumps by a whole turn.
std::vector<double> unwrapped(std::vector<double> heading) {
  for (std::size_t k = 1; k < heading.size(); ++k)
    heading[k] = heading[k - 1] + wrap_angle(heading[k] - heading[k - 1]);
  return heading;
}

/// The direction of motion where there is one; before the first motion its direction.
std::vector<double> headings_of(std::span<const Vec2> velocity) {
  std::vector<double> heading(velocity.size(), 0.0);
  bool known = false;
  for (std::size_t k = 0; k < velocity.size(); ++k) {
    const bool moves = velocity[k].norm() > kMoving;
    if (moves) heading[k] = heading_of(velocity[k]);
    if (!moves && k > 0) heading[k] = heading[k - 1];
    if (moves && !known) std::fill_n(heading.begin(), k, heading[k]);
    known = known || moves;
  }
  return unwrapped(std::move(heading));
}

/// Poses at whole steps between points a period apart.
void bring_to_steps(const SmoothedTrack& track, std::span<const double> heading, double begin,
                    double period, RecordedAgent& agent) {
  const double end = begin + period * static_cast<double>(track.position.size() - 1);
  agent.first = static_cast<int>(std::ceil(begin / kScoreStep - kSame));
  const int last = static_cast<int>(std::floor(end / kScoreStep + kSame));
  for (int step = agent.first; step <= last; ++step) {
    const double place = std::max(0.0, (step * kScoreStep - begin) / period);
    const auto k = std::min(static_cast<std::size_t>(place), track.position.size() - 2);
    const double x = place - static_cast<double>(k), y = 1.0 - x;
    const Vec2 &from = track.position[k], &to = track.position[k + 1];
    const Vec2 leave = period * track.velocity[k], arrive = period * track.velocity[k + 1];
    agent.position.emplace_back(y * y * (1.0 + 2.0 * x) * from + x * x * (3.0 - 2.0 * x) * to +
                                x * y * (y * leave - x * arrive));
    agent.velocity.emplace_back(
        (6.0 * x * y * (to - from) + y * (1.0 - 3.0 * x) * leave - x * (2.0 - 3.0 * x) * arrive) /
        period);
    agent.heading.push_back(y * heading[k] + x * heading[k + 1]);
  }
}

/// Can a body on wheels that moves so point there?
bool can_point(double heading, const Vec2& velocity) {
  return velocity.norm() < kRolls ||
         std::abs(wrap_angle(heading - heading_of(velocity))) < radians(kMostSlip);
}

/// Annotated headings as far as they can be: wheels don't roll across, and nobody drives that fast
/// backwards, but detectors guess a direction before they see motion. `mended`: those replaced by
/// the direction of motion.
std::vector<double> rolling_headings(const std::vector<double>& annotated,
                                     std::span<const Vec2> velocity, std::size_t& mended) {
  std::vector<double> heading = annotated;
  for (std::size_t k = 0; k < heading.size(); ++k) {
    if (can_point(heading[k], velocity[k])) continue;
    heading[k] = heading_of(velocity[k]);
    ++mended;
  }
  return unwrapped(std::move(heading));
}

RecordedAgent scored_agent(const Track& track, const TrackSet& set, RecordedPoint point,
                           const AgentTypeTable& types, std::size_t& mended) {
  const AgentType& type = type_of(types, track.type);
  RecordedAgent agent;
  agent.id = track.id;
  agent.type = track.type;
  agent.default_box = !(track.length > 0 && track.width > 0);
  agent.length = agent.default_box ? type.length : track.length;
  agent.width = agent.default_box ? type.width : track.width;
  agent.seen_from = set.period * track.first;
  agent.seen_period = set.period;
  agent.seen = track.position;
  if (point == RecordedPoint::RearAxle)
    for (std::size_t k = 0; k < agent.seen.size(); ++k)
      agent.seen[k] += type.rear_axle_to_center * direction_of(track.heading[k]);
  const SmoothedTrack smooth = smoothed(agent.seen, set.period);
  const bool on_wheels = type.kinematics != Kinematics::Holonomic;
  std::vector<double> heading = !track.annotated ? headings_of(smooth.velocity)
                                : on_wheels
                                    ? rolling_headings(track.heading, smooth.velocity, mended)
                                    : unwrapped(track.heading);
  if (track.annotated) agent.seen_heading = unwrapped(track.heading);
  agent.on_wheels = on_wheels;
  bring_to_steps(smooth, heading, agent.seen_from, set.period, agent);
  return agent;
}

/// The program's own type that a recorded one drives as.
std::string_view driving_name(std::string_view recorded) {
  return recorded == "moped" ? "motorcycle" : recorded;
}

TrackSet read_tracks(const std::filesystem::path& path, ReadOptions options) {
  options.sample = kScoreStep;
  TrackSet set = read_track_set(path, options);
  if (set.assumed_period)
    throw Error(path.string(),
                "tells no rate, without which no speed is known; --fps or --period says what it is "
                "(of CROSS and UTOWN: --period 0.4)");
  if (set.own_period > kCoarsest + kSame)
    throw Error(path.string(),
                fmt::format("has a frame every {:.3g} s, expected one every {} s at the least: "
                            "motion can't be told at 10 Hz; --fps or --period says what it is",
                            set.own_period, kCoarsest));
  // between far frames nothing is seen that would have to be smoothed
  options.sample = set.own_period;
  if (set.own_period > 1.5 * kScoreStep) set = read_track_set(path, options);
  return set;
}

}  // namespace

MotionState RecordedAgent::at(int step) const {
  const auto k = static_cast<std::size_t>(step - first);
  return {position[k], velocity[k], heading[k]};
}

MotionState RecordedAgent::known_at(int step) const {
  const double now = kScoreStep * step;
  std::vector<double> times;
  std::vector<Vec2> places;
  std::size_t latest = 0;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const double time = seen_from + seen_period * static_cast<double>(k) - now;
    if (time > kSame) break;
    latest = k;
    if (time < -kKnown - kSame && time < -2.0 * seen_period - kSame) continue;
    times.push_back(time);
    places.push_back(seen[k]);
  }
  const auto [place, slope] = value_and_slope(times, places);
  MotionState state{place, slope, 0.0};
  // who stands shows where it last went
  const int before = std::max(first, step - static_cast<int>(std::lround(kKnown / kScoreStep)));
  state.heading = slope.norm() > kMoving ? heading_of(slope)
                                         : heading[static_cast<std::size_t>(before - first)];
  const bool told = !seen_heading.empty() && (!on_wheels || can_point(seen_heading[latest], slope));
  if (told) state.heading = seen_heading[latest];
  return state;
}

AgentTypeTable scored_agent_types() {
  const AgentTypeTable known = default_agent_types();
  AgentTypeTable types;
  for (const AgentType& recorded : recorded_agent_types()) {
    AgentType type = type_of(known, find_agent_type(known, driving_name(recorded.name)));
    type.name = recorded.name;
    if (type.name == "moped") {
      type.length = 1.74;
      type.width = 0.78;
      type.wheelbase = 1.2;
      type.rear_axle_to_center = 0.55;
    }
    types.push_back(std::move(type));
  }
  return types;
}

AgentTypeTable behaving_as(const AgentTypeTable& scored, const AgentTypeTable& behavior) {
  AgentTypeTable types;
  for (const AgentType& body : scored) {
    AgentType type = type_of(behavior, find_agent_type(behavior, driving_name(body.name)));
    type.name = body.name;
    type.length = body.length;
    type.width = body.width;
    type.wheelbase = body.wheelbase;
    type.rear_axle_to_center = body.rear_axle_to_center;
    types.push_back(std::move(type));
  }
  return types;
}

RecordedScene read_recorded_scene(const std::filesystem::path& path, const SceneReading& reading) {
  const TrackSet set = read_tracks(path, reading.tracks);
  RecordedScene scene;
  scene.name = set.name;
  scene.file = path.string();
  scene.format = set.format;
  scene.types = scored_agent_types();
  for (const auto& [name, size] : reading.boxes) {
    AgentType& type = scene.types[static_cast<std::size_t>(find_agent_type(scene.types, name))];
    type.length = size.x();
    type.width = size.y();
  }
  scene.obstacles = set.obstacles;
  scene.own_period = set.own_period;
  scene.notes = set.notes;
  if (set.filled_gaps > 0)
    scene.notes.push_back(
        fmt::format("{} gaps filled ({} points)", set.filled_gaps, set.filled_steps));
  if (set.split_gaps > 0)
    scene.notes.push_back(
        fmt::format("{} gaps are too long to fill: tracks end and begin there", set.split_gaps));
  std::size_t mended = 0;
  for (const Track& track : set.tracks) {
    if (track.position.size() < kLeastPoints) {
      ++scene.too_short;
      continue;
    }
    scene.agents.push_back(scored_agent(track, set, reading.point, scene.types, mended));
    scene.default_boxes += scene.agents.back().default_box;
  }
  if (mended > 0)
    scene.notes.push_back(fmt::format(
        "{} annotated headings of who rolls at {} m/s and more are over {} degrees off its motion, "
        "whose direction is taken instead",
        mended, kRolls, kMostSlip));
  if (scene.agents.empty())
    throw Error(path.string(), fmt::format("holds nobody for {} frames on end", kLeastPoints));
  scene.first = scene.agents.front().first;
  for (const RecordedAgent& agent : scene.agents) {
    scene.first = std::min(scene.first, agent.first);
    scene.last = std::max(scene.last, agent.last());
  }
  return scene;
}

}  // namespace sumogamma
