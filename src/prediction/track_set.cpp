#include "prediction/track_set.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"

namespace sumogamma {

namespace {

/// One line of a file.
struct Observation {
  int frame = 0;
  std::uint32_t id = 0;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();
  Vec2 heading = Vec2::Zero();
};

/// Where a file names its columns; -1 where it lacks one.
struct Columns {
  int frame = -1, id = -1, type = -1, x = -1, y = -1, heading_x = -1, heading_y = -1;
  int count = 0;
};

std::vector<std::string> split(const std::string& line, bool commas) {
  std::vector<std::string> fields;
  if (commas) {
    std::stringstream stream(line);
    std::string field;
    while (std::getline(stream, field, ',')) fields.push_back(field);
  } else {
    std::istringstream stream(line);
    std::string field;
    while (stream >> field) fields.push_back(field);
  }
  return fields;
}

/// Position in a file, for messages.
struct Place {
  std::string file;
  std::size_t line = 0;
  std::string text() const { return file + ":" + std::to_string(line); }
};

double number(const Place& place, const std::string& field, const char* what) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size() || !std::isfinite(value))
    throw Error(place.text(), std::string(what) + " is \"" + field + "\", expected a number");
  return value;
}

Columns named_columns(const Place& place, const std::vector<std::string>& names) {
  Columns columns;
  const std::map<std::string, int*> known = {{"frame", &columns.frame},
                                             {"agent_id", &columns.id},
                                             {"agent_type", &columns.type},
                                             {"x_m", &columns.x},
                                             {"y_m", &columns.y},
                                             {"heading_x", &columns.heading_x},
                                             {"heading_y", &columns.heading_y},
                                             {"id", &columns.id},
                                             {"x", &columns.x},
                                             {"y", &columns.y},
                                             {"type", &columns.type}};
  for (std::size_t k = 0; k < names.size(); ++k)
    if (const auto column = known.find(names[k]); column != known.end())
      *column->second = static_cast<int>(k);
  columns.count = static_cast<int>(names.size());
  if (columns.frame < 0 || columns.id < 0 || columns.x < 0 || columns.y < 0)
    throw Error(place.text(), "expected a header with frame, agent_id, x_m and y_m");
  return columns;
}

Observation parse(const Place& place, const std::vector<std::string>& fields,
                  const Columns& columns, const AgentTypeTable& types) {
  if (static_cast<int>(fields.size()) < columns.count)
    throw Error(place.text(), "has " + std::to_string(fields.size()) + " fields, expected " +
                                  std::to_string(columns.count));
  auto field = [&](int column) -> const std::string& {
    return fields[static_cast<std::size_t>(column)];
  };
  auto whole = [&](int column, const char* what) {
    const double value = number(place, field(column), what);
    if (value != std::floor(value) || std::abs(value) > 1e9)
      throw Error(place.text(), std::string(what) + " is no whole number");
    return value;
  };
  Observation observation;
  observation.frame = static_cast<int>(whole(columns.frame, "frame"));
  const double id = whole(columns.id, "agent id");
  if (id < 0) throw Error(place.text(), "agent id is negative");
  observation.id = static_cast<std::uint32_t>(id);
  observation.position = {number(place, field(columns.x), "x"),
                          number(place, field(columns.y), "y")};
  if (columns.type >= 0) {
    try {
      observation.type = find_agent_type(types, field(columns.type));
    } catch (const Error& error) {
      throw Error(place.text(), error.what());
    }
  }
  if (columns.heading_x >= 0 && columns.heading_y >= 0)
    observation.heading = {number(place, field(columns.heading_x), "heading_x"),
                           number(place, field(columns.heading_y), "heading_y")};
  return observation;
}

std::vector<Observation> read_observations(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(path.string(), "cannot be read");
  const AgentTypeTable types = recorded_agent_types();
  std::vector<Observation> observations;
  Place place{path.string(), 0};
  Columns columns;
  bool commas = false;
  std::string line;
  while (std::getline(file, line)) {
    ++place.line;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (place.line == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    if (columns.count == 0) {
      commas = line.find(',') != std::string::npos;
      if (commas) {
        columns = named_columns(place, split(line, true));
        continue;
      }
      columns = {.frame = 0, .id = 1, .x = 2, .y = 3, .count = 4};
    }
    observations.push_back(parse(place, split(line, commas), columns, types));
  }
  if (observations.empty()) throw Error(path.string(), "holds no observations");
  return observations;
}

/// The common text format counts video frames: the step is the greatest divisor of all of them.
int frame_step(const std::vector<Observation>& observations) {
  int step = 0;
  for (const Observation& observation : observations)
    step = std::gcd(step, std::abs(observation.frame - observations.front().frame));
  return std::max(step, 1);
}

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

TrackSet read_track_set(const std::filesystem::path& path) {
  std::vector<Observation> observations = read_observations(path);
  const int step = frame_step(observations);
  std::stable_sort(observations.begin(), observations.end(), [](const auto& a, const auto& b) {
    return a.id != b.id ? a.id < b.id : a.frame < b.frame;
  });
  TrackSet set;
  set.name = path.stem().string();
  const AgentTypeTable types = recorded_agent_types();
  std::uint32_t fresh_id = observations.back().id;
  std::vector<Vec2> annotated;
  auto finish = [&] {
    if (set.tracks.empty()) return;
    Track& track = set.tracks.back();
    std::size_t begin = 0;
    track.heading = directions_of_motion(track.position, begin);
    // a box on wheels shows how it stands; files give people who haven't moved yet the direction
    // in which they will
    if (type_of(types, track.type).kinematics != Kinematics::Holonomic) begin = 0;
    for (std::size_t k = begin; k < annotated.size(); ++k)
      if (annotated[k].squaredNorm() > 0.25) track.heading[k] = heading_of(annotated[k]);
    annotated.clear();
  };
  const Observation* before = nullptr;
  for (const Observation& observation : observations) {
    const bool same = before != nullptr && before->id == observation.id;
    if (same && observation.frame == before->frame)
      throw Error(path.string(), "agent " + std::to_string(observation.id) + " is twice in frame " +
                                     std::to_string(observation.frame));
    if (!same || observation.frame != before->frame + step) {
      finish();
      set.tracks.push_back({.id = same ? ++fresh_id : observation.id,
                            .type = observation.type,
                            .first = observation.frame / step,
                            .position = {},
                            .heading = {}});
    }
    set.tracks.back().position.push_back(observation.position);
    annotated.push_back(observation.heading);
    before = &observation;
  }
  finish();
  std::stable_sort(set.tracks.begin(), set.tracks.end(),
                   [](const Track& a, const Track& b) { return a.id < b.id; });
  const auto beside = path.parent_path() / (set.name + "_obstacles.json");
  if (std::filesystem::exists(beside)) set.obstacles = read_polygons(beside);
  set.first_frame = set.tracks.front().first;
  for (const Track& track : set.tracks) {
    set.first_frame = std::min(set.first_frame, track.first);
    set.last_frame = std::max(set.last_frame, track.last());
  }
  constexpr int kMostFrames = 10'000'000;
  if (set.last_frame - set.first_frame > kMostFrames)
    throw Error(path.string(), "frames reach from " + std::to_string(set.first_frame) + " to " +
                                   std::to_string(set.last_frame) +
                                   ", expected counted steps, not times");
  return set;
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
