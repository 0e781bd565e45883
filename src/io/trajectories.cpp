#include "io/trajectories.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/error.h"
#include "base/units.h"
#include "base/xml_text.h"

namespace sumogamma {

namespace {

bool driven_by_us(const Scene& scene, std::size_t row) { return is_ours(scene.control[row]); }

void append_number(std::string& text, double value, int decimals) {
  char digits[64];
  const auto end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals);
  text.append(digits, end.ptr);
}

void append_attribute(std::string& text, const char* name, double value, int decimals = 2) {
  text += ' ';
  text += name;
  text += "=\"";
  append_number(text, value, decimals);
  text += '"';
}

void append_attribute(std::string& text, const char* name, std::string_view value) {
  text += ' ';
  text += name;
  text += "=\"";
  append_escaped(text, value);
  text += '"';
}

/// From an agent's centre to SUMO's reference point [m]: a vehicle's front, a person's centre.
double reach_of(const Scene& scene, const AgentType& type, std::size_t row) {
  double reach = 0;
  if (type.kinematics != Kinematics::Holonomic)
    for (const Vec2& vertex : scene.footprint[row].outline()) reach = std::max(reach, vertex.x());
  return reach;
}

Vec2 reference_point(const Scene& scene, const AgentTypeTable& types, std::size_t row) {
  return scene.position[row] +
         reach_of(scene, type_of(types, scene.type[row]), row) * direction_of(scene.heading[row]);
}

void append_row(const TrajectoryRow& row, bool person, std::string& text) {
  text += person ? "        <person" : "        <vehicle";
  append_attribute(text, "id", row.id);
  append_attribute(text, "x", row.x);
  append_attribute(text, "y", row.y);
  append_attribute(text, "angle", row.angle);
  append_attribute(text, "type", row.type);
  append_attribute(text, "speed", row.speed);
  append_attribute(text, "pos", row.along);
  append_attribute(text, person ? "edge" : "lane", row.place);
  append_attribute(text, "slope", row.slope);
  text += "/>\n";
}

}  // namespace

FcdSink::FcdSink(const std::filesystem::path& file) : file_(file) {
  // "T": plain text through the same interface
  stream_ = gzopen(file.c_str(), file.extension() == ".gz" ? "wb4" : "wbT");
  if (!stream_)
    throw Error(file.string(), std::string("can't be written (") + std::strerror(errno) + ")");
  text_ =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\n<fcd-export "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:noNamespaceSchemaLocation=\"http://sumo.dlr.de/xsd/fcd_file.xsd\">\n";
}

FcdSink::~FcdSink() {
  try {
    close();
  } catch (const Error&) {
    // an exception is on its way already, or nobody asked whether the end was written
  }
}

void FcdSink::fail() {
  int code = Z_OK;
  const char* message = gzerror(stream_, &code);
  const std::string why = code == Z_ERRNO ? std::strerror(errno) : message;
  gzclose(stream_);
  stream_ = nullptr;
  throw Error(file_.string(), "can't be written to its end (" + why + "), make room and run again");
}

void FcdSink::flush_text() {
  if (!text_.empty() && gzwrite(stream_, text_.data(), static_cast<unsigned>(text_.size())) <= 0)
    fail();
  text_.clear();
}

void FcdSink::add(const TrajectoryStep& step) {
  if (!stream_) throw Error(file_.string(), "is closed already");
  text_ += "    <timestep";
  // hundredths as SUMO writes them, thousandths where the step needs them
  const bool fine = std::llround(step.time * 1000.0) % 10 != 0;
  append_attribute(text_, "time", step.time, fine ? 3 : 2);
  text_ += ">\n";
  for (const TrajectoryRow& row : step.vehicles) append_row(row, false, text_);
  for (const TrajectoryRow& row : step.persons) append_row(row, true, text_);
  text_ += "    </timestep>\n";
  flush_text();
  // what is on the disk can be read up to here even if the process is killed
  constexpr int kSyncEvery = 64;
  if (++since_sync_ >= kSyncEvery) {
    since_sync_ = 0;
    if (gzflush(stream_, Z_SYNC_FLUSH) != Z_OK) fail();
  }
}

void FcdSink::close() {
  if (!stream_) return;
  text_ += "</fcd-export>\n";
  flush_text();
  const int code = gzclose(stream_);
  stream_ = nullptr;
  if (code != Z_OK)
    throw Error(file_.string(),
                std::string("can't be written to its end (") + std::strerror(errno) + ")");
}

TrajectoryWriter::TrajectoryWriter(double period, double step, const RoadNetwork& network,
                                   const LaneLocator* locator)
    : period_(period), step_(step), network_(network), locator_(locator) {}

TrajectoryWriter::~TrajectoryWriter() {
  try {
    close();
  } catch (const Error&) {
    // an exception is on its way already, or nobody asked whether the end was written
  }
}

void TrajectoryWriter::append_all(const Scene& scene, const AgentTypeTable& types,
                                  const AgentName& name_of, bool driven) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (driven_by_us(scene, row) != driven) continue;
    const AgentType& type = type_of(types, scene.type[row]);
    auto& rows = type.kinematics == Kinematics::Holonomic ? persons_ : vehicles_;
    rows.push_back(row_of(scene, row, type, name_of(scene.id[row])));
  }
}

void TrajectoryWriter::finish_step() {
  open_ = false;
  for (const auto& sink : sinks_) sink->add({open_time_, vehicles_, persons_});
}

void TrajectoryWriter::add(const Scene& scene, const AgentTypeTable& types,
                           const AgentName& name_of) {
  if (open_) {
    append_all(scene, types, name_of, false);
    finish_step();
  }
  const double began = scene.time - step_;
  // a little early: sums of steps don't meet the period exactly
  const bool due = !started_ || began >= next_time_ - 1e-6;
  // speeds are over a tick, whether or not it is due
  speed_.resize(scene.size());
  for (std::size_t row = 0; row < scene.size(); ++row)
    speed_[row] = driven_by_us(scene, row)
                      ? speeds_.update(scene, row, reference_point(scene, types, row), step_)
                      : scene.speed[row];
  if (!due) return;
  vehicles_.clear();
  persons_.clear();
  append_all(scene, types, name_of, true);
  next_time_ = started_ ? std::max(next_time_ + period_, began) : began + period_;
  started_ = open_ = true;
  open_time_ = began;
  external_ = std::any_of(scene.control.begin(), scene.control.end(),
                          [](Control control) { return !is_ours(control); });
}

TrajectoryRow TrajectoryWriter::row_of(const Scene& scene, std::size_t row, const AgentType& type,
                                       std::string_view name) const {
  const bool person = type.kinematics == Kinematics::Holonomic;
  const double reach = reach_of(scene, type, row);
  const Vec2 place = scene.position[row] + reach * direction_of(scene.heading[row]);
  LanePosition lane = scene.lane[row];
  if (lane.lane == kNoLane && locator_) {
    const LaneHit hit = locator_->find_nearest(
        scene.position[row], vehicle_class_from_name(type.sumo_class), scene.heading[row]);
    lane = {hit.lane, hit.along, hit.offset};
  }
  TrajectoryRow made;
  made.id = name;
  made.type = type.name;
  made.x = place.x();
  made.y = place.y();
  made.angle = sumo_from_heading(scene.heading[row]);
  made.speed = driven_by_us(scene, row) ? speed_[row] : scene.speed[row];
  if (lane.lane == kNoLane) return made;
  const Lane& on = network_.lane(lane.lane);
  // SUMO's length of a lane differs from its shape's where the map says so
  const double scale = on.centerline.length() > 0 ? on.length / on.centerline.length() : 1.0;
  made.along = std::clamp((lane.along + reach) * scale, 0.0, on.length);
  if (!on.elevation.empty()) {
    const double rise = elevation_at(on, lane.along + 0.5) - elevation_at(on, lane.along - 0.5);
    made.slope = degrees(std::atan(rise));
  }
  made.place = person ? std::string_view(network_.edge(on.edge).name) : std::string_view(on.name);
  return made;
}

void TrajectoryWriter::close() {
  if (closed_) return;
  closed_ = true;
  // where those whom the world drives were at its end isn't known
  if (open_ && !external_) finish_step();
  for (const auto& sink : sinks_) sink->close();
}

}  // namespace sumogamma
