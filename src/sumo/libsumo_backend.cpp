#include <libsumo/libsumo.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "scene/sumo_defaults.h"
#include "sumo/libsumo_module.h"
#include "sumo/stepped_backend.h"
#include "sumo/sumo_process.h"

namespace sumogamma {
namespace {

// libsumo keeps its simulation in static variables: a second instance would share them
std::atomic_flag in_use = ATOMIC_FLAG_INIT;

/// Catches what SUMO writes to std::cerr during a call, as the pipe does for a child.
class CapturedErrors {
 public:
  explicit CapturedErrors(SumoOutput& output)
      : output_(output), before_(std::cerr.rdbuf(text_.rdbuf())) {}
  ~CapturedErrors() {
    std::cerr.rdbuf(before_);
    if (text_.tellp() > 0) output_.append(text_.str());
  }
  CapturedErrors(const CapturedErrors&) = delete;
  CapturedErrors& operator=(const CapturedErrors&) = delete;

 private:
  SumoOutput& output_;
  std::ostringstream text_;
  std::streambuf* before_;
};

// SUMO's moveToXY (1.15, Vehicle.cpp) leaves its lane position uninitialised where no lane is
// matched, as for a ghost, and then asserts that it is no NaN. What it finds there is what lay on
// the stack, so zeros are laid there first: about 450 bytes below the caller's frame. The pointers
// keep the dynamic linker's resolver from running in between.
__attribute__((noinline, no_sanitize("address", "undefined"))) void clear_stack_below() {
  volatile std::uint64_t zeros[128];
  for (volatile std::uint64_t& word : zeros) word = 0;
}
auto* volatile move_vehicle = &libsumo::Vehicle::moveToXY;
auto* volatile move_person = &libsumo::Person::moveToXY;

// a getter of an agent that may have left: its value, or `otherwise`
template <typename Value, typename Getter>
Value value_or(Value otherwise, Getter&& getter) {
  try {
    return static_cast<Value>(getter());
  } catch (const std::exception&) {
    return otherwise;
  }
}

template <typename Kind>
SumoAgentDetails common_details(const std::string& id) {
  SumoAgentDetails details;
  details.id = id;
  details.is_person = std::is_same_v<Kind, libsumo::Person>;
  details.type_id = value_or(std::string(), [&] { return Kind::getTypeID(id); });
  if (details.type_id.empty()) return details;
  details.vehicle_class = value_or(std::string(), [&] { return Kind::getVehicleClass(id); });
  details.length = value_or(0.0, [&] { return Kind::getLength(id); });
  details.width = value_or(0.0, [&] { return Kind::getWidth(id); });
  details.height = value_or(0.0, [&] { return Kind::getHeight(id); });
  details.max_speed = value_or(0.0, [&] { return Kind::getMaxSpeed(id); });
  details.speed_factor = value_or(1.0, [&] { return Kind::getSpeedFactor(id); });
  details.lane = value_or(std::string(), [&] { return Kind::getLaneID(id); });
  details.lane_position = value_or(0.0, [&] { return Kind::getLanePosition(id); });
  return details;
}

StageKind stage_kind(int type) {
  return type == libsumo::STAGE_WAITING   ? StageKind::Waiting
         : type == libsumo::STAGE_WALKING ? StageKind::Walking
         : type == libsumo::STAGE_DRIVING ? StageKind::Riding
                                          : StageKind::Other;
}

SumoAgentDetails vehicle_details(const std::string& id) {
  using libsumo::Vehicle;
  SumoAgentDetails details = common_details<Vehicle>(id);
  details.type = {value_or(-1.0, [&] { return Vehicle::getAccel(id); }),
                  value_or(-1.0, [&] { return Vehicle::getDecel(id); }),
                  value_or(-1.0, [&] { return Vehicle::getEmergencyDecel(id); }),
                  value_or(-1.0, [&] { return Vehicle::getTau(id); }),
                  value_or(-1.0, [&] { return Vehicle::getMinGap(id); }),
                  value_or(-1.0, [&] { return Vehicle::getImperfection(id); })};
  details.allowed_speed = value_or(0.0, [&] { return libsumo::Vehicle::getAllowedSpeed(id); });
  details.route =
      value_or(std::vector<std::string>(), [&] { return libsumo::Vehicle::getRoute(id); });
  const auto stops = value_or(std::vector<libsumo::TraCINextStopData>(),
                              [&] { return libsumo::Vehicle::getStops(id); });
  constexpr double kNone = -1.0;
  for (const libsumo::TraCINextStopData& stop : stops)
    details.stops.push_back({stop.lane, stop.startPos, stop.endPos, std::max(stop.duration, kNone),
                             std::max(stop.until, kNone), stop.stoppingPlaceID, stop.stopFlags,
                             stop.speed});
  details.stop_state = value_or(0, [&] { return libsumo::Vehicle::getStopState(id); });
  details.route_index =
      std::max(value_or(0, [&] { return libsumo::Vehicle::getRouteIndex(id); }), 0);
  const auto parameter = [&](const char* key) {
    return value_or(std::string(), [&] { return libsumo::Vehicle::getParameter(id, key); });
  };
  details.is_taxi = parameter("has.taxi.device") == "true";
  if (parameter("has.rerouting.device") == "true")
    details.reroute_period = reroute_period(parameter("device.rerouting.period"));
  return details;
}

SumoAgentDetails person_details(const std::string& id) {
  SumoAgentDetails details = common_details<libsumo::Person>(id);
  // the type's, as over the socket: Person::getMaxSpeed has the person's own factor in it already
  details.max_speed = walking_speed(value_or(
      details.max_speed, [&] { return libsumo::VehicleType::getMaxSpeed(details.type_id); }));
  const auto stage = value_or(libsumo::TraCIStage(), [&] { return libsumo::Person::getStage(id); });
  details.stages_left = value_or(0, [&] { return libsumo::Person::getRemainingStages(id); });
  if (!details.type_id.empty()) details.stage = stage_kind(stage.type);
  if (details.stage == StageKind::Walking) {
    details.route = stage.edges;
    details.arrival_position = stage.arrivalPos;
  }
  return details;
}

class LibsumoBackend final : public SteppedBackend {
 public:
  explicit LibsumoBackend(const SumoStart& start);
  ~LibsumoBackend() override { shut(); }

  std::string version() const override { return version_; }
  std::string option(const std::string& name) override {
    return guarded([&] { return libsumo::Simulation::getOption(name); });
  }
  std::vector<std::string> edge_ids() override {
    return guarded([] { return libsumo::Edge::getIDList(); });
  }
  std::vector<SumoAgentDetails> details(std::span<const std::string> vehicles,
                                        std::span<const std::string> persons) override;
  void remove_vehicle(const std::string& id) override;
  StageKind finish_stage(const std::string& person) override;
  std::vector<std::string> present_vehicles() override {
    return guarded([] { return libsumo::Vehicle::getIDList(); });
  }
  std::vector<std::string> present_persons() override {
    return guarded([] { return libsumo::Person::getIDList(); });
  }
  void put_on_lane(const SumoPose& pose, const std::string& lane, double speed) override;
  void add_vehicle(const NewVehicle& vehicle) override;
  void set_route(const std::string& vehicle, const std::vector<std::string>& edges) override;
  std::vector<std::string> find_route(const std::string& from, const std::string& to,
                                      const std::string& type) override;
  void set_travel_time(const std::string& edge, double seconds) override;
  std::vector<double> lane_speeds(std::span<const std::string> lanes) override;
  std::vector<std::string> parameters(std::span<const std::string> vehicles,
                                      const std::string& key) override;
  void add_stop(const std::string& vehicle, const SumoAgentDetails::Stop& stop) override;
  void take_over(const std::string& vehicle, double speed) override;
  void release(const std::string& vehicle) override;
  void set_speed(const std::string& id, bool is_person, double speed) override;
  void allow_lane_changes(const std::string& vehicle, bool allowed) override;
  void set_parameter(const std::string& vehicle, const std::string& key,
                     const std::string& value) override;
  void override_detectors(std::span<const std::pair<std::string, double>> detectors) override;
  std::vector<std::string> take_warnings() override {
    std::vector<std::string> all = std::exchange(warnings_, {});
    for (const std::string& line : output_.take_first_warnings()) all.push_back("SUMO: " + line);
    return all;
  }
  long sumo_warnings() const override { return output_.warnings(); }
  void close() override { shut(); }

 protected:
  void talk_to_sumo(const std::function<void()>& talk) override { guarded(talk); }
  void move_and_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                     SumoStep& result) override;
  double ask_next_switch(std::size_t signal) override {
    return value_or(std::numeric_limits<double>::infinity(),
                    [&] { return libsumo::TrafficLight::getNextSwitch(signal_ids_[signal]); });
  }
  std::vector<std::string> route_of(const std::string& vehicle) override {
    return value_or(std::vector<std::string>(),
                    [&] { return libsumo::Vehicle::getRoute(vehicle); });
  }
  std::optional<GhostObservation> observe(const std::string& id, bool is_person) override;
  void read_watched(const std::vector<WatchList::Entry>& entries, std::vector<SumoAgent>& agents,
                    std::vector<WatchList::Entry>& gone) override;

 private:
  void shut();
  template <typename Talk>
  auto guarded(Talk&& talk) -> decltype(talk());
  [[noreturn]] void report_failure(const std::string& what);
  std::string scenario() const;
  void read_inventory();
  void move(std::span<const SumoPose> poses, bool is_person, SumoStep& result);
  void read_step(SumoStep& result);

  SumoStart start_;
  bool open_ = false;
  bool moves_pending_ = false;
  std::string version_;
  SumoOutput output_;
};

LibsumoBackend::LibsumoBackend(const SumoStart& start) : SteppedBackend(start), start_(start) {
  if (!start.connect_host.empty())
    throw Error("--connect", "needs the traci back end; leave --backend libsumo out");
  if (start.clients > 1 || start.client_order)
    throw Error("--num-clients", "needs the traci back end; leave --backend libsumo out");
  if (start.binary.find("gui") != std::string::npos)
    throw Error("--backend", "libsumo has no window; use --backend traci with sumo-gui");
  if (in_use.test_and_set())
    throw SumoError(
        "libsumo",
        "holds one simulation a process, and none after a failed step; use the traci back end");
  open_ = true;
  set_default_sumo_home();
  try {
    std::vector<std::string> words = start.arguments;
    words.insert(words.begin(), "sumo");
    {
      CapturedErrors captured(output_);
      version_ = libsumo::Simulation::start(words).second;
    }
    read_inventory();
  } catch (const std::exception& error) {
    report_failure(error.what());
  }
}

void LibsumoBackend::shut() {
  if (!open_) return;
  open_ = false;
  try {
    // a start that failed leaves a half-loaded simulation behind, which would happily step
    CapturedErrors captured(output_);
    libsumo::Simulation::close();
  } catch (const std::exception&) {
    // nothing was open
  }
  // libsumo 1.15 keeps pointers to moved vehicles until a step has ended well; they would dangle in
  // the next simulation
  if (!moves_pending_) in_use.clear();
}

std::string LibsumoBackend::scenario() const {
  for (std::size_t i = 0; i + 1 < start_.arguments.size(); ++i)
    if (start_.arguments[i] == "-c" || start_.arguments[i] == "--configuration-file")
      return start_.arguments[i + 1];
  return "SUMO";
}

void LibsumoBackend::report_failure(const std::string& what) {
  shut();
  // SUMO's texts may go over several lines; ours is one
  SumoOutput one_line;
  one_line.append("Error: " + what + "\n");
  const std::string words =
      output_.first_error().empty() ? one_line.first_error() : output_.first_error();
  if (!started_) throw Error(scenario(), "SUMO can't run it: " + words);
  throw SumoError("libsumo", words + " (at " + std::to_string(time_) + " s of simulation)");
}

template <typename Talk>
auto LibsumoBackend::guarded(Talk&& talk) -> decltype(talk()) {
  if (!open_) throw SumoError("libsumo", "was closed or has failed; no further calls are possible");
  try {
    CapturedErrors captured(output_);
    return talk();
  } catch (const std::logic_error&) {
    throw;  // our own bug
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    report_failure(error.what());
  }
}

void LibsumoBackend::read_inventory() {
  time_ = libsumo::Simulation::getTime();
  signal_ids_ = libsumo::TrafficLight::getIDList();
  for (const std::string& id : libsumo::InductionLoop::getIDList())
    detectors_.push_back(
        {id, libsumo::InductionLoop::getLaneID(id), libsumo::InductionLoop::getPosition(id)});
}

void LibsumoBackend::move(std::span<const SumoPose> poses, bool is_person, SumoStep& result) {
  const GhostArguments arguments = ghost_arguments(mode(is_person));
  static const std::string kNoHint;
  for (const SumoPose& pose : poses) {
    const double angle = wrapped_degrees(pose.angle);
    auto* const to_vehicle = move_vehicle;
    auto* const to_person = move_person;
    try {
      clear_stack_below();
      if (is_person) {
        to_person(*pose.id, kNoHint, pose.position.x(), pose.position.y(), angle,
                  arguments.keep_route, arguments.match_threshold);
      } else {
        to_vehicle(*pose.id, kNoHint, 0, pose.position.x(), pose.position.y(), angle,
                   arguments.keep_route, arguments.match_threshold);
        libsumo::Vehicle::setSpeed(*pose.id, pose.speed);
      }
    } catch (const std::exception&) {
      result.lost.push_back(*pose.id);
    }
  }
}

void LibsumoBackend::read_step(SumoStep& result) {
  using libsumo::Simulation;
  result.time = Simulation::getTime();
  result.departed_vehicles = Simulation::getDepartedIDList();
  result.arrived_vehicles = Simulation::getArrivedIDList();
  result.departed_persons = Simulation::getDepartedPersonIDList();
  result.arrived_persons = Simulation::getArrivedPersonIDList();
  result.teleports = Simulation::getStartingTeleportNumber();
  result.emergency_stops = Simulation::getEmergencyStoppingVehiclesNumber();
  result.collisions = Simulation::getCollidingVehiclesNumber();
  result.waiting_to_insert = static_cast<int>(Simulation::getPendingVehicles().size());
  for (std::size_t i = 0; i < signal_ids_.size(); ++i) {
    if (!is_due(i)) continue;
    result.signal_states[i] = libsumo::TrafficLight::getRedYellowGreenState(signal_ids_[i]);
    if (by_schedule_) next_switch_[i] = ask_next_switch(i);
    result.asked_signals.push_back(static_cast<std::uint32_t>(i));
  }
}

void LibsumoBackend::move_and_step(std::span<const SumoPose> vehicles,
                                   std::span<const SumoPose> persons, SumoStep& result) {
  moves_pending_ = !vehicles.empty() || !persons.empty();
  move(vehicles, false, result);
  move(persons, true, result);
  libsumo::Simulation::step();
  moves_pending_ = false;
  read_step(result);
}

template <typename Kind>
std::optional<GhostObservation> observe_as(const std::string& id) {
  try {
    const libsumo::TraCIPosition position = Kind::getPosition(id);
    return GhostObservation{{position.x, position.y}, Kind::getAngle(id), Kind::getLaneID(id), {}};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::optional<GhostObservation> LibsumoBackend::observe(const std::string& id, bool is_person) {
  if (is_person) return observe_as<libsumo::Person>(id);
  auto seen = observe_as<libsumo::Vehicle>(id);
  if (seen) seen->route = route_of(id);
  return seen;
}

template <typename Kind>
void read_agent_as(const std::string& id, SumoAgent& agent) {
  const libsumo::TraCIPosition position = Kind::getPosition(id);
  agent.position = {position.x, position.y};
  agent.angle = Kind::getAngle(id);
  agent.speed = Kind::getSpeed(id);
  agent.lane = Kind::getLaneID(id);
  agent.lane_position = Kind::getLanePosition(id);
}

void read_agent(const WatchList::Entry& entry, SumoAgent& agent) {
  agent.id = entry.id;
  agent.is_person = entry.is_person;
  agent.stop_state = agent.stages_left = 0;
  agent.rides.clear();
  if (entry.is_person) {
    read_agent_as<libsumo::Person>(entry.id, agent);
    agent.rides = libsumo::Person::getVehicle(entry.id);
    agent.stages_left = libsumo::Person::getRemainingStages(entry.id);
  } else {
    read_agent_as<libsumo::Vehicle>(entry.id, agent);
    agent.stop_state = libsumo::Vehicle::getStopState(entry.id);
  }
}

void LibsumoBackend::read_watched(const std::vector<WatchList::Entry>& entries,
                                  std::vector<SumoAgent>& agents,
                                  std::vector<WatchList::Entry>& gone) {
  agents.resize(entries.size());
  std::size_t kept = 0;
  for (const WatchList::Entry& entry : entries) {
    try {
      read_agent(entry, agents[kept]);
      ++kept;
    } catch (const std::exception&) {
      gone.push_back(entry);
    }
  }
  agents.resize(kept);
}

std::vector<SumoAgentDetails> LibsumoBackend::details(std::span<const std::string> vehicles,
                                                      std::span<const std::string> persons) {
  return guarded([&] {
    std::vector<SumoAgentDetails> all;
    for (const std::string& id : vehicles) all.push_back(vehicle_details(id));
    for (const std::string& id : persons) all.push_back(person_details(id));
    return all;
  });
}

void LibsumoBackend::remove_vehicle(const std::string& id) {
  unwatch(id, false);
  guarded([&] {
    try {
      libsumo::Vehicle::remove(id, libsumo::REMOVE_ARRIVED);
    } catch (const libsumo::TraCIException&) {
      // it left by itself
    }
  });
}

StageKind LibsumoBackend::finish_stage(const std::string& person) {
  return guarded([&] {
    try {
      // in place of the last one SUMO has it wait for no time
      const bool was_last = libsumo::Person::getRemainingStages(person) <= 1;
      libsumo::Person::removeStage(person, 0);
      return was_last ? StageKind::None : stage_kind(libsumo::Person::getStage(person, 0).type);
    } catch (const libsumo::TraCIException&) {
      return StageKind::None;  // it has finished
    }
  });
}

void LibsumoBackend::put_on_lane(const SumoPose& pose, const std::string& lane, double speed) {
  require_finite_pose(*pose.id, pose.position, pose.angle);
  guarded([&] {
    const LaneHint hint = lane_hint(lane);
    try {
      // what SUMO derives from its motion as a ghost is no speed to start with
      libsumo::Vehicle::setPreviousSpeed(*pose.id, speed, 0.0);
      libsumo::Vehicle::moveToXY(*pose.id, hint.edge, hint.index, pose.position.x(),
                                 pose.position.y(), wrapped_degrees(pose.angle),
                                 kOntoLane.keep_route, kOntoLane.match_threshold);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::add_vehicle(const NewVehicle& vehicle) {
  guarded([&] {
    try {
      libsumo::Route::add(vehicle.id, vehicle.route);
      libsumo::Vehicle::add(vehicle.id, vehicle.id, vehicle.type, "now",
                            std::to_string(vehicle.lane_index), number_text(vehicle.front), "0");
    } catch (const libsumo::TraCIException&) {
      // it is never seen: the traci back end says nothing, either
    }
  });
}

void LibsumoBackend::set_route(const std::string& vehicle, const std::vector<std::string>& edges) {
  guarded([&] {
    try {
      libsumo::Vehicle::setRoute(vehicle, edges);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

std::vector<std::string> LibsumoBackend::find_route(const std::string& from, const std::string& to,
                                                    const std::string& type) {
  return guarded([&] {
    return value_or(std::vector<std::string>(),
                    [&] { return libsumo::Simulation::findRoute(from, to, type, -1.0, 0).edges; });
  });
}

void LibsumoBackend::set_travel_time(const std::string& edge, double seconds) {
  guarded([&] {
    try {
      libsumo::Edge::adaptTraveltime(edge, seconds);
    } catch (const libsumo::TraCIException&) {
      // no such edge: the traci back end ignores it, too
    }
  });
}

std::vector<double> LibsumoBackend::lane_speeds(std::span<const std::string> lanes) {
  return guarded([&] {
    std::vector<double> speeds;
    for (const std::string& lane : lanes)
      speeds.push_back(value_or(-1.0, [&] { return libsumo::Lane::getMaxSpeed(lane); }));
    return speeds;
  });
}

std::vector<std::string> LibsumoBackend::parameters(std::span<const std::string> vehicles,
                                                    const std::string& key) {
  return guarded([&] {
    std::vector<std::string> values;
    for (const std::string& id : vehicles)
      values.push_back(
          value_or(std::string(), [&] { return libsumo::Vehicle::getParameter(id, key); }));
    return values;
  });
}

void LibsumoBackend::add_stop(const std::string& vehicle, const SumoAgentDetails::Stop& stop) {
  guarded([&] {
    const bool at_place = (stop.flags & stop_flags::kStoppingPlace) != 0;
    const LaneHint hint = lane_hint(stop.lane);
    try {
      libsumo::Vehicle::setStop(vehicle, at_place ? stop.place : hint.edge, stop.end, hint.index,
                                std::max(stop.duration, 0.0),  // none would be for ever
                                stop.flags, stop.start,
                                stop.until >= 0.0 ? stop.until : libsumo::INVALID_DOUBLE_VALUE);
    } catch (const libsumo::TraCIException&) {
      // SUMO refuses it: the vehicle drives on (SumoWorld sees that it doesn't stand)
    }
  });
}

void LibsumoBackend::take_over(const std::string& vehicle, double speed) {
  require_finite_pose(vehicle, Vec2::Zero(), 0, speed);
  guarded([&] {
    try {
      libsumo::Vehicle::setSpeedMode(vehicle, kSpeedModeFree);
      libsumo::Vehicle::setPreviousSpeed(vehicle, speed, 0.0);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::release(const std::string& vehicle) {
  guarded([&] {
    try {
      libsumo::Vehicle::setSpeedMode(vehicle, kSpeedModeSafe);
      libsumo::Vehicle::setSpeed(vehicle, -1.0);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::set_speed(const std::string& id, bool is_person, double speed) {
  require_finite_pose(id, Vec2::Zero(), 0, speed);
  guarded([&] {
    try {
      if (is_person)
        libsumo::Person::setSpeed(id, speed);
      else
        libsumo::Vehicle::setSpeed(id, speed);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::allow_lane_changes(const std::string& vehicle, bool allowed) {
  guarded([&] {
    try {
      libsumo::Vehicle::setLaneChangeMode(vehicle, allowed ? kLaneChangesOwn : kLaneChangesNone);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::set_parameter(const std::string& vehicle, const std::string& key,
                                   const std::string& value) {
  guarded([&] {
    try {
      libsumo::Vehicle::setParameter(vehicle, key, value);
    } catch (const libsumo::TraCIException&) {
      // it left meanwhile
    }
  });
}

void LibsumoBackend::override_detectors(std::span<const std::pair<std::string, double>> detectors) {
  guarded([&] {
    for (const auto& [id, age] : detectors) {
      try {
        // as over the socket: else SUMO holds the loop for jammed after a while
        if (age > 0.0) libsumo::InductionLoop::overrideTimeSinceDetection(id, -1.0);
        libsumo::InductionLoop::overrideTimeSinceDetection(id, age);
      } catch (const libsumo::TraCIException&) {
        // no such detector: the traci back end ignores it too
      }
    }
  });
}

}  // namespace

extern "C" SumoBackend* sumogamma_start_libsumo(const SumoStart& start) {
  return std::make_unique<LibsumoBackend>(start).release();
}

}  // namespace sumogamma
