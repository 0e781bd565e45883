#include "realism/sumo_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <pugixml.hpp>
#include <utility>

#include "base/error.h"
#include "base/scratch_folder.h"
#include "base/units.h"
#include "demand/vehicle_type_xml.h"
#include "realism/sumo_drivers.h"
#include "sumo/backend.h"

namespace sumogamma {

namespace {

constexpr int kWarmUp = 6;                         // steps in which those scored are inserted
constexpr int kLead = kWarmUp + 1;                 // from there to the window's beginning
constexpr int kPeriod = kLead + kWindowSteps + 3;  // from one rollout to the next [steps]
constexpr double kRoom = 4.0;                      // between those inserted in a lane [m]

/// Programs that show again and again, a rollout each, what signals show in a window.
std::string signals_of(const RoadNetwork& network, double begin) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("additional");
  const double whole = kScoreStep * kPeriod;
  for (const Signal& signal : network.signals) {
    double cycle = 0;
    for (const SignalPhase& phase : signal.phases) cycle += phase.duration;
    if (cycle <= 0.0) continue;
    pugi::xml_node logic = root.append_child("tlLogic");
    logic.append_attribute("id") = signal.name.c_str();
    logic.append_attribute("type") = "static";
    logic.append_attribute("programID") = "window";
    logic.append_attribute("offset") = "0";
    double left = std::fmod(begin, cycle), shown = 0;
    if (left < 0.0) left += cycle;
    for (std::size_t k = 0; shown < whole - 1e-9; k = (k + 1) % signal.phases.size()) {
      const double duration = signal.phases[k].duration - left;
      left = std::max(0.0, -duration);
      if (duration <= 1e-9) continue;
      const double part = std::min(duration, whole - shown);
      pugi::xml_node phase = logic.append_child("phase");
      phase.append_attribute("duration") = fmt::format("{:.2f}", part).c_str();
      phase.append_attribute("state") = signal.phases[k].state.c_str();
      shown += part;
    }
  }
  return xml_text(document);
}

/// Somebody as SUMO has it in one rollout.
struct Driver {
  const RecordedAgent* who = nullptr;
  std::size_t row = 0;  ///< among those scored; beyond them: who comes later
  std::string id;
  bool asked = false, departed = false, seen = false;
  bool near = false, placed = false;  ///< a step before its place; in it
  bool late = false;                  ///< in it after it was due
  int due = 0;                        ///< step of the window
  MotionState last{};
};

/// The rollouts of a window in one SUMO.
class Session {
 public:
  Session(const RecordedScene& scene, const RecordedRoad& road, const ScoreWindow& window,
          const std::string& method, std::uint64_t seed, std::size_t count)
      : scene_(scene), road_(road), window_(window), seed_(seed) {
    for (const std::size_t who : window.agents) everybody_.push_back(who);
    for (const std::size_t who : window.entering) everybody_.push_back(who);
    const double begin = kScoreStep * (window.start - scene.first - kLead);
    SumoStart start;
    start.arguments = sumo_arguments(road.file, folder_.file("types.rou.xml", types(method, count)),
                                     method, seed);
    start.arguments.insert(
        start.arguments.end(),
        {"-a", folder_.file("signals.add.xml", signals_of(road.road.network, begin)).string()});
    backend_ = start_traci_backend(start);
  }

  Rollout drive(std::size_t number, EntryCounts& entries) {
    drivers_.clear();
    for (std::size_t row = 0; row < everybody_.size(); ++row) {
      const RecordedAgent& who = scene_.agents[everybody_[row]];
      const bool scored_row = row < window_.agents.size();
      Driver driver;
      driver.who = &who;
      driver.row = row;
      driver.id = fmt::format("{}_{}", row, number);
      driver.due = scored_row ? 0 : who.first - window_.start;
      drivers_.push_back(std::move(driver));
    }
    Rollout rollout{Poses(window_.agents.size()), std::vector<bool>(window_.agents.size(), false)};
    filled_.clear();
    // SUMO keeps the order in a lane by which it inserted
    std::stable_sort(drivers_.begin(), drivers_.begin() + scored(),
                     [&](const Driver& a, const Driver& b) { return way_of(a) < way_of(b); });
    for (auto driver = drivers_.begin(); driver != drivers_.begin() + scored(); ++driver)
      ask(*driver);
    std::sort(drivers_.begin(), drivers_.begin() + scored(),
              [](const Driver& a, const Driver& b) { return a.row < b.row; });
    for (int step = 0; step < kPeriod; ++step) {
      const int now = step - kLead;  // of the window, after this step
      for (Driver& driver : drivers_) prepare(driver, now);
      backend_->step({}, {}, result_);
      take(now);
      if (now >= 0 && now <= kWindowSteps) note(static_cast<std::size_t>(now), rollout);
      if (now == kWindowSteps) end_all();
    }
    for (const Driver& driver : drivers_) {
      if (driver.row < window_.agents.size()) {
        entries.unplaced += !driver.placed;
        continue;
      }
      entries.entered += driver.placed;
      entries.delayed += driver.late;
      entries.shut_out += !driver.placed;
    }
    return rollout;
  }

  void close() { backend_->close(); }

 private:
  MotionState begin_of(const Driver& driver) const {
    return driver.due == 0 ? driver.who->known_at(window_.start)
                           : driver.who->at(driver.who->first);
  }
  static double speed_of(const MotionState& state) {
    return std::max(0.0, direction_of(state.heading).dot(state.velocity));
  }
  const MatchedRoute& route_of(const Driver& driver) const {
    return road_.routes[everybody_[driver.row]];
  }

  std::ptrdiff_t scored() const { return static_cast<std::ptrdiff_t>(window_.agents.size()); }
  RoutePlace place_of(const Driver& driver, const MotionState& state) const {
    return place_on_route(
        road_.road.network, route_of(driver), state,
        vehicle_class_from_name(type_of(scene_.types, driver.who->type).sumo_class));
  }

  /// How far along its route somebody begins [m].
  double way_of(const Driver& driver) const {
    const RoadNetwork& network = road_.road.network;
    const MotionState state = begin_of(driver);
    const RoutePlace place = place_of(driver, state);
    double way = place.along;
    for (std::size_t k = 0; k < place.edge; ++k)
      way += network.lane(network.edge(route_of(driver).edges[k]).lanes.front()).length;
    if (place.on != place.lane)
      way += network.lane(place.on).centerline.project(state.position).along;
    return way;
  }

  /// A vType for everybody in each rollout: SUMO draws no factor on limits of its own.
  std::string types(const std::string& method, std::size_t count) const {
    pugi::xml_document document;
    pugi::xml_node root = document.append_child("routes");
    for (std::size_t row = 0; row < everybody_.size(); ++row) {
      const RecordedAgent& who = scene_.agents[everybody_[row]];
      const MotionState state =
          row < window_.agents.size() ? who.known_at(window_.start) : who.at(who.first);
      const double limit = road_.road.network.lane(road_.routes[everybody_[row]].from).speed_limit;
      for (std::size_t number = 0; number < count; ++number) {
        AgentType type = type_of(scene_.types, who.type);
        type.length = who.length;
        type.width = who.width;
        type.name = fmt::format("{}_{}", row, number);
        append_vehicle_type(root, type);
        pugi::xml_node element = root.last_child();
        const double factor = limit_factor(speed_of(state), limit, seed_ + number, who.id);
        set_driver(element, method, fmt::format("{:.4f}", factor));
        element.append_attribute("speedDev") = "0";
      }
    }
    return xml_text(document);
  }

  /// Asks SUMO for somebody ahead of time, and puts it in its place when it is due.
  void prepare(Driver& driver, int now) {
    if (!driver.asked && now >= driver.due - 2) ask(driver);
    if (!driver.departed || driver.placed || now < driver.due - 1 || now >= kWindowSteps) return;
    MotionState state = begin_of(driver);
    if (driver.due > 0 && is_taken(driver, state)) return;
    // of the way from the step before SUMO makes its speed
    const bool before = !driver.near;
    if (before) state.position -= kScoreStep * speed_of(state) * direction_of(state.heading);
    const RoutePlace place = place_of(driver, state);
    const SumoPose pose{&driver.id,
                        state.position + 0.5 * driver.who->length * direction_of(state.heading),
                        sumo_from_heading(state.heading), speed_of(state)};
    backend_->put_on_lane(pose, road_.road.network.lane(place.on).name, speed_of(state));
    driver.near = true;
    driver.placed = !before;
    driver.late = driver.placed && now > driver.due;
  }

  void ask(Driver& driver) {
    driver.asked = true;
    const RoadNetwork& network = road_.road.network;
    const Lane& lane = network.lane(route_of(driver).from);
    SumoBackend::NewVehicle vehicle;
    vehicle.id = vehicle.type = driver.id;
    for (const EdgeId edge : route_of(driver).edges)
      vehicle.route.push_back(network.edge(edge).name);
    vehicle.lane_index = lane.index;
    if (driver.due > 0) {
      vehicle.front = std::clamp(way_of(driver) + 0.5 * driver.who->length, 0.0, lane.length);
    } else {
      // one before the other, wherever they go from there
      double& filled = filled_[lane.name];
      filled += driver.who->length + kRoom;
      vehicle.front = std::min(filled, lane.length);
    }
    backend_->add_vehicle(vehicle);
  }

  bool is_taken(const Driver& driver, const MotionState& state) const {
    const Vec2 size(driver.who->length, driver.who->width);
    return std::any_of(drivers_.begin(), drivers_.end(), [&](const Driver& other) {
      return other.seen && other.placed &&
             signed_distance(state, size, other.last, Vec2(other.who->length, other.who->width)) <
                 0.0;
    });
  }

  /// What SUMO says after a step.
  void take(int now) {
    const auto find = [&](const std::string& id) -> Driver* {
      const auto at = std::find_if(drivers_.begin(), drivers_.end(),
                                   [&](const Driver& one) { return one.id == id; });
      return at == drivers_.end() ? nullptr : &*at;
    };
    for (const std::string& id : result_.departed_vehicles)
      if (Driver* driver = find(id)) {
        driver->departed = true;
        backend_->watch(id, false);
      }
    for (Driver& driver : drivers_) driver.seen = false;
    for (const SumoAgent& agent : result_.agents) {
      Driver* driver = find(agent.id);
      if (!driver) continue;
      const double heading = heading_from_sumo(agent.angle);
      driver->last = {agent.position - 0.5 * driver->who->length * direction_of(heading),
                      agent.speed * direction_of(heading), heading};
      driver->seen = true;
    }
    // who has arrived, or never came, goes on as it did
    for (Driver& driver : drivers_) {
      if (driver.seen || now < driver.due) continue;
      if (!driver.placed && driver.row >= window_.agents.size()) continue;
      if (now == 0 || (!driver.placed && now <= 0))
        driver.last = begin_of(driver);
      else
        driver.last.position += kScoreStep * driver.last.velocity;
    }
  }

  void note(std::size_t step, Rollout& rollout) const {
    for (std::size_t row = 0; row < window_.agents.size(); ++row) {
      const Driver& own = drivers_[row];
      rollout.poses.position[row * Poses::kSteps + step] = own.last.position;
      rollout.poses.heading[row * Poses::kSteps + step] = own.last.heading;
      if (step >= window_.bodies.present[row]) continue;
      for (std::size_t k = window_.agents.size(); k < drivers_.size(); ++k) {
        const Driver& other = drivers_[k];
        if (!other.placed || !other.seen) continue;
        if (signed_distance(own.last, Vec2(own.who->length, own.who->width), other.last,
                            Vec2(other.who->length, other.who->width)) < 0.0)
          rollout.touches_entering[row] = true;
      }
    }
  }

  void end_all() {
    for (const Driver& driver : drivers_)
      if (driver.departed && driver.seen) backend_->remove_vehicle(driver.id);
  }

  const RecordedScene& scene_;
  const RecordedRoad& road_;
  const ScoreWindow& window_;
  std::uint64_t seed_;
  std::vector<std::size_t> everybody_;  ///< agents of the recording, those scored first
  ScratchFolder folder_;
  std::unique_ptr<SumoBackend> backend_;
  std::vector<Driver> drivers_;
  std::map<std::string, double> filled_;  ///< lanes, by those inserted [m]
  SumoStep result_;
};

}  // namespace

SumoLoop::SumoLoop(const RecordedScene& scene, const RecordedRoad& road)
    : scene_(scene), road_(road) {}

std::vector<Rollout> SumoLoop::drive(const ScoreWindow& window, const std::string& method,
                                     std::uint64_t seed, std::size_t count,
                                     EntryCounts& entries) const {
  Session session(scene_, road_, window, method, seed, count);
  std::vector<Rollout> rollouts;
  for (std::size_t number = 0; number < count; ++number)
    rollouts.push_back(session.drive(number, entries));
  session.close();
  return rollouts;
}

}  // namespace sumogamma
