#include "simulation/scene_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "base/error.h"
#include "base/units.h"

namespace sumogamma {

namespace {

// a limit that never binds
constexpr double kUnlimited = 1e3;
// beyond it nothing in a scene can be meant [m, m/s, rad]
constexpr double kFarthest = 1e6;

constexpr std::string_view kHeader = "id,type,x,y,heading_rad,speed,goal_x,goal_y,pref_speed";
constexpr std::string_view kSizes = ",length,width";

struct Record {
  std::uint32_t id = 0;
  std::string type;
  double x = 0, y = 0, heading = 0, speed = 0, goal_x = 0, goal_y = 0, preferred_speed = 0;
  double length = 0, width = 0;  ///< 0: the type's
};

AgentType scene_type(const char* name, double length, double width, double wheelbase,
                     double rear_axle, double max_speed) {
  AgentType type;
  type.name = name;
  type.length = length;
  type.width = width;
  type.wheelbase = wheelbase;
  type.rear_axle_to_center = rear_axle;
  type.max_steering = radians(45);
  type.max_steering_rate = kUnlimited;
  type.max_speed = max_speed;
  type.max_acceleration = 3.0;
  type.comfortable_deceleration = 3.0;
  type.max_deceleration = 6.0;
  type.max_lateral_acceleration = kUnlimited;
  type.tracking_error = 0.5;
  type.horizon = 4.0;
  type.attention_front = 2.0;
  type.attention_rear = 2.0;
  return type;
}

AgentType walking_type() {
  AgentType type = scene_type("People", 0.20, 0.44, 0.2, 0.0, 5.0);
  type.kinematics = Kinematics::Holonomic;
  type.max_acceleration = type.max_deceleration = kUnlimited;
  type.max_steering_rate = radians(360);
  type.tracking_error = 0.1;
  type.horizon = 3.0;
  type.attention_front = 2.0;
  type.attention_rear = 2.0;
  return type;
}

void make_ideal(AgentType& type) {
  type.kinematics = Kinematics::Holonomic;
  type.max_acceleration = type.max_deceleration = type.max_steering_rate = kUnlimited;
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t end = line.find(',', begin);
    fields.push_back(line.substr(begin, end == std::string_view::npos ? end : end - begin));
    if (end == std::string_view::npos) return fields;
    begin = end + 1;
  }
}

template <typename Number>
void parse(std::string_view text, const char* field, const std::string& where, Number& value) {
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  bool good = status == std::errc() && end == text.data() + text.size();
  if constexpr (std::is_floating_point_v<Number>) good = good && std::abs(value) <= kFarthest;
  if (!good)
    throw Error(where, std::string(field) + " is '" + std::string(text.substr(0, 40)) +
                           "', expected a number within a million");
}

Record parse_record(std::string_view line, bool sized, const std::string& where) {
  const std::vector<std::string_view> fields = split(line);
  const std::size_t expected = sized ? 11 : 9;
  if (fields.size() != expected)
    throw Error(where, std::to_string(fields.size()) + " fields, expected " + std::string(kHeader) +
                           std::string(sized ? kSizes : ""));
  Record record;
  parse(fields[0], "id", where, record.id);
  record.type = fields[1];
  parse(fields[2], "x", where, record.x);
  parse(fields[3], "y", where, record.y);
  parse(fields[4], "heading_rad", where, record.heading);
  parse(fields[5], "speed", where, record.speed);
  parse(fields[6], "goal_x", where, record.goal_x);
  parse(fields[7], "goal_y", where, record.goal_y);
  parse(fields[8], "pref_speed", where, record.preferred_speed);
  if (sized) {
    parse(fields[9], "length", where, record.length);
    parse(fields[10], "width", where, record.width);
    if (record.length <= 0 || record.width <= 0)
      throw Error(where, "length or width isn't positive, expected metres of a body");
  }
  if (record.speed < 0 || record.preferred_speed < 0)
    throw Error(where, "a speed is negative, expected none");
  return record;
}

std::vector<Record> read_records(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw Error(path.string(), "can't be opened, expected a scene file");
  std::string line;
  auto next_line = [&] {
    if (!std::getline(file, line)) return false;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return true;
  };
  const bool any = next_line();
  const bool sized = any && line == std::string(kHeader) + std::string(kSizes);
  if (!any || (line != kHeader && !sized))
    throw Error(path.string(), "first line must be " + std::string(kHeader) + ", and " +
                                   std::string(kSizes) +
                                   " behind it where bodies have sizes of their own");
  std::vector<Record> records;
  for (std::size_t number = 2; next_line(); ++number)
    if (!line.empty())
      records.push_back(parse_record(line, sized, path.string() + ":" + std::to_string(number)));
  if (records.empty()) throw Error(path.string(), "no agents, expected at least one");
  return records;
}

/// The id of the type in `types`, where it is added on its first use.
AgentTypeId use_type(const AgentTypeTable& known, const std::string& name, AgentTypeTable& types) {
  for (std::size_t k = 0; k < types.size(); ++k)
    if (types[k].name == name) return static_cast<AgentTypeId>(k);
  types.push_back(type_of(known, find_agent_type(known, name)));
  return static_cast<AgentTypeId>(types.size() - 1);
}

}  // namespace

AgentTypeTable scene_agent_types(Actuation actuation) {
  AgentTypeTable types = {walking_type(),
                          scene_type("Bicycle", 1.65, 1.0, 1.0, 0.425, 5),
                          scene_type("Scooter", 1.65, 1.2, 1.0, 0.425, 10),
                          scene_type("Car", 4.8, 2.0, 2.7, 1.4, 10),
                          scene_type("Van", 5.3, 2.2, 3.91, 1.55, 10),
                          scene_type("Bus", 6.0, 3.0, 4.0, 1.5, 10),
                          scene_type("Jeep", 5.3, 2.2, 3.3, 1.55, 10),
                          scene_type("Electric_Tricycle", 1.65, 1.6, 1.0, 0.425, 8),
                          scene_type("Gyro_Scooter", 0.5, 0.6, 0.25, 0.0, 2)};
  for (AgentType& type : default_agent_types()) types.push_back(std::move(type));
  if (actuation == Actuation::Ideal)
    for (AgentType& type : types) make_ideal(type);
  return types;
}

SceneFile read_scene_file(const std::filesystem::path& path, Actuation actuation) {
  std::vector<Record> records = read_records(path);
  std::stable_sort(records.begin(), records.end(),
                   [](const Record& a, const Record& b) { return a.id < b.id; });
  SceneFile file;
  file.name = path.stem().string();
  const AgentTypeTable known = scene_agent_types(actuation);
  for (const Record& record : records) {
    if (!file.scene.id.empty() && file.scene.id.back().value == record.id)
      throw Error(path.string(),
                  "id " + std::to_string(record.id) + " occurs twice, expected distinct ids");
    AgentState agent;
    agent.id = {record.id};
    agent.type = use_type(known, record.type, file.types);
    const AgentType& type = type_of(file.types, agent.type);
    agent.footprint = record.length > 0 ? box_footprint(record.length, record.width)
                                        : box_footprint(type.length, type.width);
    agent.position = {record.x, record.y};
    agent.heading = wrap_angle(record.heading);
    agent.speed = record.speed;
    agent.preferred_speed = record.preferred_speed;
    agent.behavior.intention = {IntentionKind::Goal, Vec2(record.goal_x, record.goal_y)};
    agent.behavior.attention = {type.attention_front, type.attention_rear};
    append_agent(file.scene, agent);
    file.goals.push_back(agent.behavior.intention.goal);
  }
  return file;
}

}  // namespace sumogamma
