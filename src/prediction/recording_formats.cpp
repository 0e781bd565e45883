#include "prediction/recording_formats.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string_view>

#include "base/error.h"
#include "base/units.h"
#include "geometry/vec2.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kFarthest = 1e7;  // coordinates beyond are no metres of one place
constexpr double kDutRate = 23.98, kJuelichRate = 16.0;  // [1/s]

constexpr std::string_view kFormats[] = {"csv",         "text",   "juelich", "trajnet",
                                         "interaction", "levelx", "sind",    "dut"};

/// What recordings call types that have another name here.
constexpr std::pair<std::string_view, std::string_view> kTypeNames[] = {
    {"ped", "pedestrian"},
    {"person", "pedestrian"},
    {"pedestrian/bicycle", "pedestrian"},
    {"veh", "car"},
    {"vehicle", "car"},
    {"cyclist", "bicycle"},
    {"bike", "bicycle"},
    {"bicyclist", "bicycle"},
    {"motorcycle", "moped"},
    {"motorcyclist", "moped"},
    {"scooter", "moped"},
    {"tricycle", "electric_tricycle"},
    {"trailer", "truck"},
    {"truck_bus", "bus"},
    {"motorbike", "moped"}};

/// A line of a file, for messages.
struct Place {
  std::string file;
  std::size_t line = 0;
  std::string text() const { return file + ":" + std::to_string(line); }
};

/// A file cut into fields.
struct Table {
  std::string file;
  std::vector<std::string> names;  ///< of the header; empty without one
  std::vector<std::vector<std::string>> rows;
  std::vector<std::size_t> lines;
  std::string comments;  ///< lines that begin with #

  int column(std::initializer_list<std::string_view> aliases) const {
    for (const std::string_view alias : aliases)
      for (std::size_t k = 0; k < names.size(); ++k)
        if (names[k] == alias) return static_cast<int>(k);
    return -1;
  }
  bool has(std::string_view name) const { return column({name}) >= 0; }
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\"");
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\"") - begin + 1);
}

char delimiter_of(const std::string& line) {
  for (const char delimiter : {';', ',', '\t'})
    if (line.find(delimiter) != std::string::npos) return delimiter;
  return ' ';
}

std::vector<std::string> split(const std::string& line, char delimiter) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  std::string field;
  if (delimiter == ' ' || delimiter == '\t') {
    while (stream >> field) fields.push_back(field);
  } else {
    while (std::getline(stream, field, delimiter)) fields.push_back(trimmed(field));
  }
  return fields;
}

bool parse(const std::string& field, double& value) {
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc{} && end == field.data() + field.size() && std::isfinite(value);
}

double number(const Place& place, const std::string& field, const char* what) {
  double value = 0;
  if (!parse(field, value))
    throw Error(place.text(), std::string(what) + " is \"" + field + "\", expected a number");
  return value;
}

double coordinate(const Place& place, const std::string& field, const char* what, double scale) {
  const double value = scale * number(place, field, what);
  if (std::abs(value) > kFarthest)
    throw Error(place.text(),
                std::string(what) + " is " + field + ", expected metres of one place");
  return value;
}

double whole(const Place& place, const std::string& field, const char* what) {
  const double value = number(place, field, what);
  if (value != std::floor(value) || std::abs(value) > 1e9)
    throw Error(place.text(), std::string(what) + " is no whole number");
  return value;
}

Table read_table(const fs::path& path) {
  std::ifstream file(path);
  if (!file || fs::is_directory(path)) throw Error(path.string(), "cannot be read");
  Table table;
  table.file = path.string();
  std::string line;
  std::size_t count = 0;
  char delimiter = 0;
  while (std::getline(file, line)) {
    ++count;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (count == 1 && line.starts_with("\xEF\xBB\xBF")) line.erase(0, 3);
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    if (line.front() == '#') {
      table.comments += line + "\n";
      continue;
    }
    if (delimiter == 0) {
      delimiter = line.front() == '{' ? '\n' : delimiter_of(line);
      const std::vector<std::string> fields = split(line, delimiter);
      double first = 0;
      if (line.front() != '{' && !parse(fields.empty() ? "" : fields.front(), first) &&
          fields.size() > 1 && !fields.front().empty() &&
          std::isalpha(static_cast<unsigned char>(fields.front().front()))) {
        table.names = fields;
        continue;
      }
    }
    std::vector<std::string> row = split(line, delimiter);
    if (row.empty()) continue;
    table.rows.push_back(std::move(row));
    table.lines.push_back(count);
  }
  if (table.rows.empty()) throw Error(path.string(), "holds no observations");
  return table;
}

/// Numbers for what a file calls its agents: whole numbers as they are where nobody else has them.
class Names {
 public:
  explicit Names(bool numeric) : numeric_(numeric) {}
  std::uint32_t id_of(const std::string& file, const std::string& name) {
    if (numeric_) {
      double value = 0;
      parse(name, value);
      return static_cast<std::uint32_t>(value);
    }
    const auto next = static_cast<std::uint32_t>(known_.size());
    return known_.try_emplace(file + "\n" + name, next).first->second;
  }

 private:
  bool numeric_;
  std::map<std::string, std::uint32_t> known_;
};

bool is_whole(double value) { return std::abs(value) < 2e9 && value == std::floor(value); }

bool is_whole(const std::string& field) {
  double value = 0;
  return parse(field, value) && is_whole(value);
}

AgentTypeId type_of_name(const Place& place, const std::string& name, const ReadOptions& options,
                         const AgentTypeTable& types) {
  std::string wanted = name;
  if (const auto told = options.types.find(name); told != options.types.end()) {
    wanted = told->second;
  } else {
    wanted = lower(name);
    for (const auto& [theirs, ours] : kTypeNames)
      if (wanted == theirs) wanted = ours;
  }
  try {
    return find_agent_type(types, wanted);
  } catch (const Error& error) {
    throw Error(place.text(), std::string(error.what()) + "; --type " + name + "=OURS tells");
  }
}

/// Where a table has what, and how it is to be read.
struct Layout {
  std::string format;
  int frame = -1, id = -1, type = -1, x = -1, y = -1, z_width = -1, z_height = -1;
  int heading = -1, heading_x = -1, heading_y = -1;
  int length = -1, width = -1;  ///< of bodies; rows may end before them
  double heading_scale = 1;     ///< to radians
  double scale = 1;             ///< to metres
  double unit = 0;              ///< see RawRecording
  bool counted = true;          ///< frames are whole numbers
  std::string every_type{};     ///< where there is no column
  std::map<std::string, std::string> type_by_id{};

  int most() const {
    return std::max({frame, id, type, x, y, z_width, z_height, heading, heading_x, heading_y});
  }
};

Layout headerless_layout(const Table& table, const ReadOptions& options, RawRecording& raw) {
  const std::size_t fields = table.rows.front().size();
  Layout layout{.format = "text", .frame = 0, .id = 1, .x = 2, .y = 3};
  layout.every_type = "pedestrian";
  const bool counts_by_agent = table.rows.size() > 1 && fields == 5 && table.rows[1].size() == 5 &&
                               table.rows[1][0] == table.rows[0][0];
  if (options.format == "juelich" || (options.format.empty() && counts_by_agent)) {
    layout.format = "juelich";
    std::swap(layout.frame, layout.id);
    layout.scale = 0.01;
    double rate = kJuelichRate;
    if (const std::size_t at = table.comments.find("framerate:"); at != std::string::npos)
      rate = std::strtod(table.comments.c_str() + at + 10, nullptr);
    if (!(rate > 0)) throw Error(table.file, "framerate is no positive number");
    layout.unit = 1.0 / rate;
    raw.notes.push_back("columns id frame x y z in cm, " + std::to_string(rate).substr(0, 5) +
                        " frames a second");
    return layout;
  }
  if (fields == 8) layout.y = 4;  // frame id x z y vx vz vy
  if (fields != 4 && fields != 8 && options.format != "text")
    throw Error(table.file + ":" + std::to_string(table.lines.front()),
                "has " + std::to_string(fields) +
                    " columns without names, expected frame id x y; --format says what it is");
  return layout;
}

/// The file beside this one in whose name `from` stands as `to`.
fs::path beside(const fs::path& path, const std::string& from, const std::string& to) {
  std::string name = path.filename().string();
  const std::size_t at = name.find(from);
  if (at == std::string::npos) return {};
  name.replace(at, from.size(), to);
  return path.parent_path() / name;
}

/// Rate and classes from levelX's meta files.
void read_level_x_meta(const fs::path& path, Layout& layout) {
  const fs::path tracks = beside(path, "_tracks", "_tracksMeta");
  const fs::path recording = beside(path, "_tracks", "_recordingMeta");
  if (tracks.empty() || !fs::exists(tracks) || !fs::exists(recording))
    throw Error(path.string(),
                "expected NN_tracks.csv with NN_tracksMeta.csv and "
                "NN_recordingMeta.csv beside it");
  const Table meta = read_table(recording);
  const int rate = meta.column({"frameRate"});
  if (rate < 0) throw Error(meta.file, "expected a column frameRate");
  layout.unit = 1.0 / number({meta.file, meta.lines[0]},
                             meta.rows[0].at(static_cast<std::size_t>(rate)), "frameRate");
  const Table classes = read_table(tracks);
  const int id = classes.column({"trackId", "id"}), name = classes.column({"class"});
  if (id < 0 || name < 0) throw Error(classes.file, "expected columns trackId (or id) and class");
  for (std::size_t k = 0; k < classes.rows.size(); ++k) {
    if (static_cast<int>(classes.rows[k].size()) <= std::max(id, name))
      throw Error(Place{classes.file, classes.lines[k]}.text(), "has too few fields");
    layout.type_by_id[classes.rows[k][static_cast<std::size_t>(id)]] =
        classes.rows[k][static_cast<std::size_t>(name)];
  }
}

std::string looked_at(const Table& table) {
  if (table.has("x_est")) return "dut";
  if (table.has("xCenter") || (table.has("xVelocity") && table.has("width"))) return "levelx";
  if (table.has("track_id") && table.has("timestamp_ms"))
    return table.has("yaw_rad") || table.file.find("smoothed") != std::string::npos ? "sind"
                                                                                    : "interaction";
  return "csv";
}

void find_time(const Table& table, Layout& layout) {
  if (const int seconds = table.column({"time_s", "time", "t"}); seconds >= 0) {
    layout.frame = seconds;
    layout.unit = 1;
    layout.counted = false;
  } else if (const int thousandths = table.column({"timestamp_ms"}); thousandths >= 0) {
    layout.frame = thousandths;
    layout.unit = 1e-3;
    layout.counted = false;
  } else {
    layout.frame = table.column({"frame", "frame_id"});
  }
}

Layout named_layout(const fs::path& path, const Table& table) {
  Layout layout{.format = looked_at(table)};
  find_time(table, layout);
  layout.id = table.column({"agent_id", "id", "track_id", "trackId"});
  layout.type = table.column({"agent_type", "type", "label", "class"});
  layout.x = table.column({"x_m", "x", "x_est", "xCenter"});
  layout.y = table.column({"y_m", "y", "y_est", "yCenter"});
  layout.heading_x = table.column({"heading_x"});
  layout.heading_y = table.column({"heading_y"});
  layout.heading = table.column({"heading_rad", "psi_rad", "psi_est"});
  layout.length = table.column({"length_m", "length"});
  layout.width = table.column({"width_m", "width"});
  if (layout.type < 0) layout.every_type = "pedestrian";
  if (layout.format == "dut") layout.unit = 1.0 / kDutRate;
  if (layout.format == "levelx") {
    read_level_x_meta(path, layout);
    layout.heading = table.column({"heading"});
    layout.heading_scale = radians(1);
    // highD's x and y are a corner of the box
    if (!table.has("xCenter")) {
      layout.z_width = table.column({"width"});
      layout.z_height = table.column({"height"});
      // along the road and across it
      layout.length = layout.z_width;
      layout.width = layout.z_height;
    }
  }
  if (layout.frame < 0 || layout.id < 0 || layout.x < 0 || layout.y < 0)
    throw Error(table.file + ":1", "expected a header with frame or time_s, agent_id, x_m and y_m");
  return layout;
}

/// Length or width of a body; 0 where the field tells none.
double size_of(const Place& place, const std::vector<std::string>& row, int column,
               const char* what) {
  constexpr double kLongest = 100.0;  // no body is longer [m]
  if (column < 0 || column >= static_cast<int>(row.size())) return 0.0;
  const std::string& field = row[static_cast<std::size_t>(column)];
  const double size = field.empty() ? 0.0 : number(place, field, what);
  if (size > kLongest)
    throw Error(place.text(), std::string(what) + " is " + field + ", expected metres of a body");
  return std::max(0.0, size);
}

RawPoint point_of(const Place& place, const std::vector<std::string>& row, const Layout& layout,
                  const ReadOptions& options, const AgentTypeTable& types) {
  if (static_cast<int>(row.size()) <= layout.most())
    throw Error(place.text(), "has " + std::to_string(row.size()) + " fields, expected " +
                                  std::to_string(layout.most() + 1));
  auto field = [&](int column) -> const std::string& {
    return row[static_cast<std::size_t>(column)];
  };
  RawPoint point;
  point.frame = layout.counted ? whole(place, field(layout.frame), "frame")
                               : number(place, field(layout.frame), "time");
  point.position = {coordinate(place, field(layout.x), "x", layout.scale),
                    coordinate(place, field(layout.y), "y", layout.scale)};
  if (layout.z_width >= 0)
    point.position += 0.5 * Vec2(number(place, field(layout.z_width), "width"),
                                 number(place, field(layout.z_height), "height"));
  std::string type = layout.every_type;
  if (layout.type >= 0) type = field(layout.type);
  if (!layout.type_by_id.empty()) {
    const auto known = layout.type_by_id.find(field(layout.id));
    if (known == layout.type_by_id.end())
      throw Error(place.text(), "track " + field(layout.id) + " has no class in the meta data");
    type = known->second;
  }
  point.type = type_of_name(place, type, options, types);
  point.length = size_of(place, row, layout.length, "length");
  point.width = size_of(place, row, layout.width, "width");
  point.heading = kUnknown;
  if (layout.heading >= 0) {
    // people on foot often have none
    if (!field(layout.heading).empty())
      point.heading = layout.heading_scale * number(place, field(layout.heading), "heading");
  } else if (layout.heading_x >= 0 && layout.heading_y >= 0) {
    const Vec2 along(number(place, field(layout.heading_x), "heading_x"),
                     number(place, field(layout.heading_y), "heading_y"));
    if (along.squaredNorm() > 0.25) point.heading = heading_of(along);
  }
  return point;
}

void append_points(const Table& table, const Layout& layout, const ReadOptions& options,
                   const AgentTypeTable& types, Names& names, RawRecording& raw) {
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const Place place{table.file, table.lines[k]};
    RawPoint point = point_of(place, table.rows[k], layout, options, types);
    const std::string& name = table.rows[k][static_cast<std::size_t>(layout.id)];
    double value = 0;
    if (parse(name, value) && value < 0) throw Error(place.text(), "agent id is negative");
    point.id = names.id_of(table.file, name);
    raw.points.push_back(point);
  }
}

/// TrajNet++: {"scene": {..., "fps": 2.5}} and {"track": {"f": 0, "p": 1, "x": 0.0, "y": 0.0}}.
void read_ndjson(const Table& table, const AgentTypeTable& types, RawRecording& raw) {
  const AgentTypeId walker = find_agent_type(types, "pedestrian");
  double rate = 0;
  for (std::size_t k = 0; k < table.rows.size(); ++k) {
    const Place place{table.file, table.lines[k]};
    try {
      const nlohmann::json json = nlohmann::json::parse(table.rows[k].at(0));
      if (json.contains("scene")) rate = json["scene"].value("fps", rate);
      if (!json.contains("track")) continue;
      const auto& track = json["track"];
      const auto id = track.at("p").get<double>();
      if (!is_whole(id) || id < 0) throw Error(place.text(), "p must be a whole number from 0");
      RawPoint point{track.at("f").get<double>(), static_cast<std::uint32_t>(id), walker,
                     Vec2(track.at("x").get<double>(), track.at("y").get<double>()), kUnknown};
      if (!(point.position.cwiseAbs().maxCoeff() < kFarthest))
        throw Error(place.text(), "x or y is no metre of one place");
      raw.points.push_back(point);
    } catch (const nlohmann::json::exception& error) {
      throw Error(place.text(),
                  "expected a scene or a track of TrajNet++: " + std::string(error.what()));
    }
  }
  // frames count those of the video that a step leaves out
  if (rate > 0)
    raw.notes.push_back("scenes tell " + std::to_string(rate).substr(0, 4) + " steps a second");
  if (rate > 0) raw.step = 1.0 / rate;
}

/// Files of the same clip: the other kind of road user.
fs::path companion_of(const fs::path& path, const std::string& format) {
  constexpr std::pair<const char*, const char*> kPairs[] = {
      {"_ped_", "_veh_"}, {"Ped_", "Veh_"}, {"pedestrian_tracks", "vehicle_tracks"}};
  if (format != "dut" && format != "sind" && format != "interaction") return {};
  for (const auto& [walkers, wheels] : kPairs) {
    for (const fs::path& other : {beside(path, walkers, wheels), beside(path, wheels, walkers)})
      if (!other.empty() && fs::exists(other)) return other;
  }
  return {};
}

}  // namespace

std::string recording_formats() {
  std::string all;
  for (const std::string_view format : kFormats)
    all += (all.empty() ? "" : ", ") + std::string(format);
  return all;
}

RawRecording read_raw_recording(const fs::path& path, const ReadOptions& options,
                                const AgentTypeTable& types) {
  const Table table = read_table(path);
  RawRecording raw;
  raw.name = path.stem().string();
  const bool lines_of_json = table.names.empty() && table.rows[0].at(0).starts_with("{");
  if (lines_of_json) {
    raw.format = "trajnet";
    read_ndjson(table, types, raw);
  } else {
    const Layout layout =
        table.names.empty() ? headerless_layout(table, options, raw) : named_layout(path, table);
    raw.format = layout.format;
    raw.unit = layout.unit;
    raw.times = !layout.counted;
    const fs::path other = companion_of(path, layout.format);
    const bool numeric = other.empty() && layout.most() < static_cast<int>(table.rows[0].size()) &&
                         std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
                           return static_cast<int>(row.size()) > layout.id &&
                                  is_whole(row[static_cast<std::size_t>(layout.id)]);
                         });
    Names names(numeric);
    append_points(table, layout, options, types, names, raw);
    if (!other.empty()) {
      const Table second = read_table(other);
      append_points(second, named_layout(other, second), options, types, names, raw);
      raw.notes.push_back("with " + other.filename().string() + " beside it");
    }
  }
  if (!options.format.empty() && options.format != raw.format)
    throw Error(path.string(),
                "looks like " + raw.format + ", not like --format " + options.format);
  if (raw.points.empty()) throw Error(path.string(), "holds no observations");
  return raw;
}

}  // namespace sumogamma
