#include "prediction/track_set.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "prediction/resampling.h"

namespace sumogamma {

namespace {

/// {"polygons": [{"vertices_m": [[x, y], ...]}, ...]}
std::vector<Obstacle> read_polygons(const std::filesystem::path& path) {
  std::vector<Obstacle> obstacles;
  std::ifstream file(path);
  try {
    const nlohmann::json json = nlohmann::json::parse(file);
    for (const auto& polygon : json.at("polygons")) {
      Obstacle obstacle;
      for (const auto& vertex : polygon.at("vertices_m"))
        obstacle.outline.emplace_back(vertex.at(0).get<double>(), vertex.at(1).get<double>());
      if (obstacle.outline.size() < 3) throw Error(path.string(), "a polygon has under 3 vertices");
      obstacles.push_back(std::move(obstacle));
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(path.string(), "expected polygons with vertices_m: " + std::string(error.what()));
  }
  return obstacles;
}

/// Direction of the last motion at every position; 0 before the first motion, for what comes later
/// must not tell. `begin`: first position that was reached by a motion.
std::vector<double> directions_of_motion(const std::vector<Vec2>& position, std::size_t& begin) {
  std::vector<double> heading(position.size(), 0.0);
  begin = position.size();
  for (std::size_t k = 1; k < position.size(); ++k) {
    const Vec2 step = position[k] - position[k - 1];
    heading[k] = heading[k - 1];
    if (step.squaredNorm() < 1e-16) continue;
    heading[k] = heading_of(step);
    begin = std::min(begin, k);
  }
  return heading;
}

}  // namespace

void point_track(const AgentTypeTable& types, std::span<const double> annotated, Track& track) {
  std::size_t begin = 0;
  track.heading = directions_of_motion(track.position, begin);
  // a box on wheels shows how it stands; files give people who haven't moved yet the direction
  // in which they will
  if (type_of(types, track.type).kinematics != Kinematics::Holonomic) begin = 0;
  for (std::size_t k = begin; k < annotated.size(); ++k) {
    if (std::isnan(annotated[k])) continue;
    track.heading[k] = annotated[k];
    track.annotated = true;
  }
}

AgentTypeTable recorded_agent_types() {
  // boxes from the reference point, wheelbases, tracking errors, horizons: the published
  // predictor's class constants; limits of motion: default_agent_types
  struct Row {
    const char *name, *like;
    double front, half_width, back, wheelbase, tracking_error, horizon, max_speed;
    double attention_front;
  };
  constexpr Row kRows[] = {
      {"pedestrian", "pedestrian", 0.10, 0.22, 0.10, 0.20, 0.1, 3, 5, 6},
      {"moped", "motorcycle", 1.25, 0.60, 0.40, 1.00, 0.5, 5, 10, 8},
      {"bicycle", "bicycle", 1.25, 0.50, 0.40, 1.00, 0.5, 5, 5, 8},
      {"electric_tricycle", "electric_tricycle", 1.25, 0.80, 0.40, 1.00, 0.5, 5, 8, 8},
      {"car", "car", 3.80, 1.00, 1.00, 2.70, 0.5, 4, 10, 8},
      {"van", "van", 4.20, 1.10, 1.10, 3.91, 0.5, 5, 10, 8},
      {"bus", "bus", 4.50, 1.50, 1.50, 4.00, 0.5, 5, 10, 8},
      {"truck", "truck", 5.35, 1.20, 1.75, 4.00, 0.5, 5, 10, 8},
  };
  const AgentTypeTable known = default_agent_types();
  AgentTypeTable types;
  for (const Row& row : kRows) {
    AgentType type = type_of(known, find_agent_type(known, row.like));
    type.name = row.name;
    type.length = row.front + row.back;
    type.width = 2 * row.half_width;
    type.wheelbase = row.wheelbase;
    type.rear_axle_to_center = 0.5 * (row.front - row.back);
    type.max_steering = radians(45);
    type.tracking_error = row.tracking_error;
    type.horizon = row.horizon;
    type.max_speed = std::max(row.max_speed, 12.0);
    if (type.kinematics == Kinematics::Holonomic) type.max_speed = row.max_speed;
    type.attention_front = row.attention_front;
    types.push_back(std::move(type));
  }
  return types;
}

TrackSet read_track_set(const std::filesystem::path& path, const ReadOptions& options) {
  const AgentTypeTable types = recorded_agent_types();
  const RawRecording raw = read_raw_recording(path, options, types);
  TrackSet set = resampled_tracks(raw, options, types, path.string());
  std::stable_sort(set.tracks.begin(), set.tracks.end(),
                   [](const Track& a, const Track& b) { return a.id < b.id; });
  const auto beside = path.parent_path() / (set.name + "_obstacles.json");
  if (std::filesystem::exists(beside)) set.obstacles = read_polygons(beside);
  if (set.tracks.empty()) throw Error(path.string(), "holds nobody for longer than 0.4 s");
  set.first_frame = set.tracks.front().first;
  for (const Track& track : set.tracks) {
    set.first_frame = std::min(set.first_frame, track.first);
    set.last_frame = std::max(set.last_frame, track.last());
  }
  return set;
}

std::uint64_t content_of(const TrackSet& set) {
  std::uint64_t sum = 0;
  for (const Track& track : set.tracks) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const Vec2& position : track.position)
      for (const double value : {position.x(), position.y()})
        hash = (hash ^ static_cast<std::uint64_t>(std::llround(100.0 * value))) * 0x100000001b3ULL;
    sum += hash;
  }
  return sum;
}

TrackSet window_of(const TrackSet& set, int first, int last) {
  static const AgentTypeTable types = recorded_agent_types();
  TrackSet window;
  window.name = set.name;
  window.period = set.period;
  window.first_frame = first;
  window.last_frame = last;
  window.obstacles = set.obstacles;
  for (const Track& track : set.tracks) {
    const int begin = std::max(first, track.first), end = std::min(last, track.last());
    if (begin > end) continue;
    const auto skip = begin - track.first, count = end - begin + 1;
    Track part{track.id, track.type, begin, {}, {}};
    part.position.assign(track.position.begin() + skip, track.position.begin() + skip + count);
    std::span<const double> annotated;
    if (track.annotated)
      annotated = std::span(track.heading)
                      .subspan(static_cast<std::size_t>(skip), static_cast<std::size_t>(count));
    point_track(types, annotated, part);
    window.tracks.push_back(std::move(part));
  }
  return window;
}

TrackSet with_noise(const TrackSet& set, double deviation, std::uint64_t seed) {
  TrackSet disturbed = set;
  for (Track& track : disturbed.tracks)
    for (std::size_t k = 0; k < track.position.size(); ++k) {
      const auto frame = static_cast<std::uint64_t>(track.first) + k;
      track.position[k] +=
          deviation * Vec2(random_normal(seed, track.id, 2 * frame, Draw::ProcessNoise),
                           random_normal(seed, track.id, 2 * frame + 1, Draw::ProcessNoise));
    }
  return disturbed;
}

}  // namespace sumogamma
