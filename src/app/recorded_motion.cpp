#include "app/recorded_motion.h"

#include <spdlog/spdlog.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "outputs/xml_lines.h"
#include "prediction/track_set.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
constexpr const char* kTrajectories = "trajectories.fcd.xml.gz";

/// One agent of a frame, before all of them are sorted into a scene.
struct MovedAgent {
  std::uint32_t id = 0;
  AgentTypeId type{};
  Vec2 center = Vec2::Zero();
  double heading = 0;
  Vec2 velocity = Vec2::Zero();
};

Scene scene_of(std::vector<MovedAgent>& seen, const AgentTypeTable& types, double time) {
  std::sort(seen.begin(), seen.end(),
            [](const MovedAgent& a, const MovedAgent& b) { return a.id < b.id; });
  Scene scene;
  scene.time = time;
  for (const MovedAgent& one : seen) {
    // the same agent twice in a step is none of SUMO's files
    if (!scene.id.empty() && scene.id.back() == AgentId{one.id}) continue;
    const AgentType& type = type_of(types, one.type);
    AgentState agent;
    agent.id = AgentId{one.id};
    agent.type = one.type;
    agent.footprint = box_footprint(type.length, type.width);
    agent.position = one.center;
    agent.heading = one.heading;
    agent.speed = one.velocity.norm();
    append_agent(scene, agent);
    scene.velocity.back() = one.velocity;
  }
  return scene;
}

/// Steps of an FCD file, each handed on as a scene once it is whole.
class FcdReader {
 public:
  FcdReader(const fs::path& file, MotionSampler& sampler) : file_(file), sampler_(sampler) {}

  void read() {
    const std::unique_ptr<gzFile_s, decltype(&gzclose)> stream(gzopen(file_.c_str(), "rb"),
                                                               &gzclose);
    if (!stream) throw Error(file_.string(), "can't be read");
    bool ended = false;
    std::string line;
    std::array<char, 1 << 12> part{};
    while (gzgets(stream.get(), part.data(), static_cast<int>(part.size()))) {
      line += part.data();
      if (line.back() != '\n') continue;
      ended = ended || line.find("</fcd-export>") != std::string::npos;
      look_at(parse_line(std::move(line)));
      line.clear();
    }
    if (!ended && line.find("</fcd-export>") == std::string::npos)
      throw Error(file_.string(),
                  "has no end (</fcd-export>): it was cut off, or is none in SUMO's FCD schema");
    end_step();
    if (period_ <= 0.0)
      throw Error(file_.string(), "holds no two steps in SUMO's FCD schema, expected trajectories");
    sampler_.finish();
  }

 private:
  void look_at(const XmlLine& line) {
    if (line.element == "timestep")
      begin_step(line.number("time", -1.0));
    else if (line.element == "vehicle" || line.element == "person")
      add(line);
  }

  void begin_step(double time) {
    end_step();
    time_ = time;
    open_ = true;
  }

  void end_step() {
    if (!open_) return;
    open_ = false;
    if (!has_first_) {
      // the period is known with the second step alone
      first_ = scene_of(seen_, types_, time_);
      has_first_ = true;
    } else {
      if (period_ <= 0.0) {
        period_ = time_ - first_.time;
        if (!(period_ > 0.0)) throw Error(file_.string(), "its steps' times don't go up");
        sampler_.begin_group(period_);
        sampler_.add(first_, types_);
      }
      sampler_.add(scene_of(seen_, types_, time_), types_);
    }
    seen_.clear();
  }

  void add(const XmlLine& line) {
    const bool on_foot = line.element == "person";
    MovedAgent agent;
    agent.id = ids_.try_emplace(line.element + " " + std::string(line.get("id")),
                                static_cast<std::uint32_t>(ids_.size()))
                   .first->second;
    agent.type = type_named(line.get("type"), on_foot);
    agent.heading = heading_from_sumo(line.number("angle"));
    const Vec2 forward = direction_of(agent.heading);
    const double reach = on_foot ? 0.0 : 0.5 * type_of(types_, agent.type).length;
    agent.center = Vec2(line.number("x"), line.number("y")) - reach * forward;
    agent.velocity = line.number("speed") * forward;
    seen_.push_back(agent);
  }

  /// A vType's own name says nothing of its size here: others are taken for cars, or people.
  AgentTypeId type_named(std::string_view name, bool on_foot) {
    for (std::size_t row = 0; row < types_.size(); ++row)
      if (types_[row].name == name) return static_cast<AgentTypeId>(row);
    const char* const base = on_foot ? "pedestrian" : "car";
    if (!warned_)
      spdlog::warn("{}: type '{}' isn't known here, it and the like are taken for a {}",
                   file_.string(), name, base);
    warned_ = true;
    return find_agent_type(types_, base);
  }

  fs::path file_;
  MotionSampler& sampler_;
  AgentTypeTable types_ = default_agent_types();
  std::map<std::string, std::uint32_t> ids_;
  std::vector<MovedAgent> seen_;
  Scene first_;
  double time_ = 0, period_ = 0;
  bool open_ = false, has_first_ = false, warned_ = false;
};

void sample_recording(const fs::path& file, MotionSampler& sampler) {
  const TrackSet set = read_track_set(file);
  const AgentTypeTable types = recorded_agent_types();
  if (set.last_frame <= set.first_frame) throw Error(file.string(), "holds no two frames");
  sampler.begin_group(set.period);
  const auto center = [&](const Track& track, std::size_t k) -> Vec2 {
    return track.position[k] +
           type_of(types, track.type).rear_axle_to_center * direction_of(track.heading[k]);
  };
  for (int frame = set.first_frame; frame <= set.last_frame; ++frame) {
    std::vector<MovedAgent> seen;
    for (const Track& track : set.tracks) {
      if (!track.present(frame)) continue;
      const auto k = static_cast<std::size_t>(frame - track.first);
      const std::size_t before = k > 0 ? k - 1 : 0, after = k > 0 ? k : 1;
      MovedAgent agent{track.id, track.type, center(track, k), track.heading[k], Vec2::Zero()};
      if (after < track.position.size())
        agent.velocity = (center(track, after) - center(track, before)) / set.period;
      seen.push_back(agent);
    }
    sampler.add(scene_of(seen, types, frame * set.period), types);
  }
  sampler.finish();
}

}  // namespace

MotionSources find_motion(const fs::path& named) {
  MotionSources sources;
  if (!fs::exists(named)) throw Error(named.string(), "isn't there");
  if (!fs::is_directory(named)) {
    const std::string name = named.filename().string();
    const bool fcd = name.ends_with(".xml") || name.ends_with(".xml.gz");
    (fcd ? sources.trajectories : sources.recordings).push_back(named);
    return sources;
  }
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(named))
    if (entry.path().filename() == kTrajectories) sources.trajectories.push_back(entry.path());
  std::sort(sources.trajectories.begin(), sources.trajectories.end());
  if (sources.trajectories.empty())
    throw Error(named.string(),
                std::string("holds no ") + kTrajectories + " of a run, neither in it nor below it");
  return sources;
}

void sample_motion(const MotionSources& sources, MotionSampler& sampler) {
  for (const fs::path& file : sources.trajectories) FcdReader(file, sampler).read();
  for (const fs::path& file : sources.recordings) sample_recording(file, sampler);
}

}  // namespace sumogamma
