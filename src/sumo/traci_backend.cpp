#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/number_text.h"
#include "scene/sumo_defaults.h"
#include "sumo/stepped_backend.h"
#include "sumo/sumo_process.h"
#include "sumo/traci_answers.h"
#include "sumo/traci_client.h"
#include "sumo/traci_message.h"

namespace sumogamma {
namespace {

constexpr int kOldestProtocol = 18,
              kNewestProtocol = 22;       // measured with 20 (1.15, 1.18) and 22 (1.27)
constexpr double kHandshakeTimeout = 20;  // [s], joining a SUMO that the user started
constexpr double kOthersTimeout = 300;    // [s] for the other clients of a SUMO of ours to come
constexpr double kLastWords = 3;          // [s] for a child to end once its socket has closed
constexpr double kCloseGrace = 20;        // [s] to write its outputs
constexpr int kPortTrials = 5;
constexpr std::uint8_t kStepVariables[] = {traci::kTime,
                                           traci::kDepartedVehicles,
                                           traci::kArrivedVehicles,
                                           traci::kDepartedPersons,
                                           traci::kArrivedPersons,
                                           traci::kTeleportCount,
                                           traci::kEmergencyStopCount,
                                           traci::kCollidingCount,
                                           traci::kPendingVehicles};
constexpr std::uint8_t kWatchedVariables[] = {traci::kPosition, traci::kAngle, traci::kSpeed,
                                              traci::kLane, traci::kLanePosition};
constexpr double kInvalidDouble = -1073741824.0;  // SUMO's word for none

// moveToXY (docs/coupling.md): SUMO's own number for it, a compound of 7 items for vehicles and 6
// for persons, who are on no lane
void append_move(TraciWriter& message, const SumoPose& pose, const LaneHint& hint, bool is_person,
                 const GhostArguments& arguments) {
  const std::string& id = *pose.id;
  const std::size_t body =
      1 + (4 + id.size()) + 5 + (5 + hint.edge.size()) + (is_person ? 0 : 5) + 9 + 9 + 9 + 2 + 9;
  message.begin_command(traci::set_command(is_person ? traci::kPerson : traci::kVehicle), body);
  message.raw_byte(traci::kMoveToXy);
  message.raw_string(id);
  message.compound(is_person ? 6 : 7);
  message.typed_string(hint.edge);
  if (!is_person) message.typed_integer(hint.index);
  message.typed_double(pose.position.x());
  message.typed_double(pose.position.y());
  message.typed_double(wrapped_degrees(pose.angle));
  message.typed_byte(static_cast<std::uint8_t>(arguments.keep_route));
  message.typed_double(arguments.match_threshold);
}

void append_ghost(TraciWriter& message, const SumoPose& pose, bool is_person, GhostMode mode) {
  append_move(message, pose, {}, is_person, ghost_arguments(mode));
}

class TraciBackend final : public SteppedBackend {
 public:
  explicit TraciBackend(const SumoStart& start) : SteppedBackend(start), start_(start) {
    if (start.socket >= 0) {
      client_ = std::make_unique<TraciClient>(start.socket);
      handshake(start.start_timeout);
    } else if (start.connect_host.empty()) {
      spawn();
    } else {
      join();
    }
  }
  ~TraciBackend() override {
    try {
      close();
    } catch (const std::exception&) {
      // nobody is left to tell; SumoProcess kills what still runs
    }
  }

  std::string version() const override { return version_; }
  std::string option(const std::string& name) override;
  std::vector<std::string> edge_ids() override;
  std::vector<SumoAgentDetails> details(std::span<const std::string> vehicles,
                                        std::span<const std::string> persons) override;
  void remove_vehicle(const std::string& id) override;
  StageKind finish_stage(const std::string& person) override;
  std::vector<std::string> present_vehicles() override { return id_list(traci::kVehicle); }
  std::vector<std::string> present_persons() override { return id_list(traci::kPerson); }
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
  void set_speed(const std::string& id, bool is_person, double speed) override {
    require_finite_pose(id, Vec2::Zero(), 0, speed);
    queued_.set_double(is_person ? traci::kPerson : traci::kVehicle, traci::kSpeed, id, speed);
  }
  void allow_lane_changes(const std::string& vehicle, bool allowed) override {
    queued_.set_integer(traci::kVehicle, traci::kLaneChangeMode, vehicle,
                        allowed ? kLaneChangesOwn : kLaneChangesNone);
  }
  void set_color(const std::string& id, bool is_person,
                 const std::array<std::uint8_t, 3>& color) override {
    queued_.begin_command(traci::set_command(is_person ? traci::kPerson : traci::kVehicle),
                          5 + id.size() + 5);
    queued_.raw_byte(traci::kColor);
    queued_.raw_string(id);
    queued_.raw_byte(traci::kColorType);
    for (const std::uint8_t part : color) queued_.raw_byte(part);
    queued_.raw_byte(255);
  }
  void set_parameter(const std::string& vehicle, const std::string& key,
                     const std::string& value) override {
    queued_.begin_command(traci::set_command(traci::kVehicle),
                          5 + vehicle.size() + 5 + 5 + key.size() + 5 + value.size());
    queued_.raw_byte(traci::kParameter);
    queued_.raw_string(vehicle);
    queued_.compound(2);
    queued_.typed_string(key);
    queued_.typed_string(value);
  }
  void override_detectors(std::span<const std::pair<std::string, double>> detectors) override {
    for (const auto& [id, age] : detectors) {
      // SUMO takes one override after another for a vehicle that stands there, and holds the loop
      // for jammed after a while (jam-threshold): it begins anew once nobody is on it
      if (age > 0.0) queued_.set_double(traci::kInductionLoop, traci::kVirtualDetection, id, -1.0);
      queued_.set_double(traci::kInductionLoop, traci::kVirtualDetection, id, age);
    }
  }
  std::vector<std::string> take_warnings() override;
  long sumo_warnings() const override { return process_ ? process_->output().warnings() : -1; }
  void close() override;

 protected:
  void talk_to_sumo(const std::function<void()>& talk) override { guarded(talk); }
  void move_ahead(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                  std::vector<std::string>& lost) override;
  void move_and_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                     SumoStep& result) override;
  std::vector<std::string> route_of(const std::string& vehicle) override;
  double ask_next_switch(std::size_t signal) override;
  std::optional<GhostObservation> observe(const std::string& id, bool is_person) override;
  void read_watched(const std::vector<WatchList::Entry>& entries, std::vector<SumoAgent>& agents,
                    std::vector<WatchList::Entry>& gone) override;

 private:
  void spawn();
  void join();
  void handshake(double timeout);
  void take_order(double timeout);
  void read_inventory();
  template <typename Talk>
  auto guarded(Talk&& talk) -> decltype(talk());
  TraciReader exchange(TraciWriter& message) {
    return TraciReader(
        client_->exchange(message, started_ ? start_.step_timeout : start_.start_timeout));
  }
  [[noreturn]] void report_failure(const std::string& what);
  std::string scenario() const;
  std::vector<std::string> id_list(std::uint8_t domain);
  void read_reroute_periods(std::vector<SumoAgentDetails>& all);
  void read_walking_speeds(std::vector<SumoAgentDetails>& all);

  void compose_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons);
  void read_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                 SumoStep& result);
  void read_moves(TraciReader& reply, std::span<const SumoPose> vehicles,
                  std::span<const SumoPose> persons, std::vector<std::string>& lost);
  /// What another client's step has brought: it has the answers to subscriptions.
  void ask_step(SumoStep& result);
  void ask_signals(SumoStep& result);
  bool is_guest() const { return start_.socket >= 0; }
  void read_subscriptions(TraciReader& reply, SumoStep& result);
  void read_simulation(TraciReader& reply, int variables, SumoStep& result);
  void read_simulation_value(TraciReader& reply, std::uint8_t variable, SumoStep& result);
  void compose_watch(const std::vector<WatchList::Entry>& entries);
  bool read_agent(TraciReader& reply, const WatchList::Entry& entry, SumoAgent& agent);

  SumoStart start_;
  // declared before the client, which looks at it
  std::unique_ptr<SumoProcess> process_;
  std::unique_ptr<TraciClient> client_;
  bool closed_ = false;
  std::string version_;
  std::map<std::string, std::string> options_;
  std::map<std::string, double> type_max_speed_;  ///< of people's types [m/s]

  TraciWriter queued_;  // commands that can wait for the next step
  TraciWriter message_;
  TraciWriter watch_message_;
};

std::string TraciBackend::scenario() const {
  for (std::size_t i = 0; i + 1 < start_.arguments.size(); ++i)
    if (start_.arguments[i] == "-c" || start_.arguments[i] == "--configuration-file")
      return start_.arguments[i + 1];
  return "SUMO";
}

void TraciBackend::report_failure(const std::string& what) {
  if (client_) client_->close();
  if (!process_) throw SumoError(what, "at " + std::to_string(time_) + " s of simulation");
  // a closed socket means that it is ending: give it the time to say why; one that hangs is killed
  if (client_ && !client_->timed_out()) process_->wait(kLastWords);
  const bool hangs = process_->running();
  if (hangs) process_->terminate(0);
  process_->drain();
  const SumoOutput& output = process_->output();
  const std::string words = output.first_error().empty() ? output.tail() : output.first_error();
  // SUMO says no to its input by ending itself with a message; a signal or an abort is never the
  // user's fault
  if (!started_ && process_->exit_code().value_or(0) != 0 && !output.first_error().empty())
    throw Error(scenario(), "SUMO can't run it: " + words);
  throw SumoError(what, (hangs ? std::string("killed by us") : process_->end_description()) +
                            " at " + std::to_string(time_) + " s of simulation" +
                            (words.empty() ? "" : "; its last words: " + words));
}

template <typename Talk>
auto TraciBackend::guarded(Talk&& talk) -> decltype(talk()) {
  if (closed_ || !client_ || !client_->connected())
    throw SumoError("SUMO", "was closed or has gone away; no further calls are possible");
  try {
    return talk();
  } catch (const SumoError& error) {
    report_failure(error.what());
  }
}

void TraciBackend::spawn() {
  const std::string binary = find_sumo_binary(start_.binary);
  for (int trial = 1;; ++trial) {
    const int port = start_.port > 0 ? start_.port : free_port();
    std::vector<std::string> arguments = start_.arguments;
    arguments.insert(arguments.end(), {"--remote-port", std::to_string(port)});
    client_.reset();
    process_ = std::make_unique<SumoProcess>(binary, arguments);
    try {
      client_ =
          std::make_unique<TraciClient>("127.0.0.1", port, start_.start_timeout, process_.get());
      if (start_.on_listening) start_.on_listening(port);
      handshake(start_.clients > 1 ? kOthersTimeout : start_.start_timeout);
      return;
    } catch (const SumoError& error) {
      // somebody else took the port between our look and SUMO's
      if (client_ && !client_->timed_out()) process_->wait(kLastWords);
      const bool port_taken = process_->output().contains("listening socket") ||
                              process_->output().contains("Address already in use");
      if (port_taken && start_.port > 0)
        throw Error("--remote-port " + std::to_string(port),
                    "is in use by somebody else, choose another");
      if (start_.clients > 1 && client_ && client_->timed_out())
        throw Error("--num-clients " + std::to_string(start_.clients),
                    "not all clients came to port " + std::to_string(port) + " within " +
                        std::to_string(static_cast<int>(kOthersTimeout)) + " s");
      if (!port_taken || trial >= kPortTrials) report_failure(error.what());
    }
  }
}

void TraciBackend::join() {
  const std::string where = start_.connect_host + ":" + std::to_string(start_.connect_port);
  try {
    client_ =
        std::make_unique<TraciClient>(start_.connect_host, start_.connect_port,
                                      std::min(start_.start_timeout, kHandshakeTimeout), nullptr);
    handshake(std::min(start_.start_timeout, kHandshakeTimeout));
  } catch (const SumoError& error) {
    throw Error(where, std::string("no SUMO answers there (") + error.what() +
                           "); start one with --remote-port " +
                           std::to_string(start_.connect_port));
  }
}

/// Among several clients SUMO goes by their order; the answer comes once all are there.
void TraciBackend::take_order(double timeout) {
  if (!start_.client_order) return;
  message_.clear();
  message_.begin_command(traci::kSetOrder, 4);
  message_.raw_integer(*start_.client_order);
  const TraciStatus status = TraciReader(client_->exchange(message_, timeout)).status();
  if (!status.ok())
    throw SumoError("SUMO", "refuses our place " + std::to_string(*start_.client_order) +
                                " among its clients: " + status.text);
}

void TraciBackend::handshake(double timeout) {
  take_order(timeout);
  message_.clear();
  message_.begin_command(traci::kGetVersion, 0);
  TraciReader reply(client_->exchange(message_, timeout));
  const TraciStatus status = reply.status();
  if (!status.ok() || status.command != traci::kGetVersion)
    throw SumoError("SUMO", "does not tell its version; is the other side a SUMO?");
  reply.block_length();
  if (reply.byte() != traci::kGetVersion) throw SumoError("SUMO", "does not tell its version");
  const std::int32_t protocol = reply.integer();
  version_ = reply.string();
  if (protocol < kOldestProtocol || protocol > kNewestProtocol)
    warnings_.push_back(version_ + " speaks TraCI version " + std::to_string(protocol) +
                        "; tested are " + std::to_string(kOldestProtocol) + " to " +
                        std::to_string(kNewestProtocol));
  read_inventory();
}

void TraciBackend::read_inventory() {
  message_.clear();
  message_.get(traci::kSimulation, traci::kTime, "");
  message_.get(traci::kTrafficLight, traci::kIdList, "");
  message_.get(traci::kInductionLoop, traci::kIdList, "");
  TraciReader lists = exchange(message_);
  time_ = require_answer(lists, traci::kSimulation, traci::kTime, "its time").typed_double();
  signal_ids_ =
      require_answer(lists, traci::kTrafficLight, traci::kIdList, "its signals").typed_strings();
  detectors_.clear();
  for (std::string& id :
       require_answer(lists, traci::kInductionLoop, traci::kIdList, "its detectors")
           .typed_strings())
    detectors_.push_back({std::move(id), "", 0});

  message_.clear();
  for (const Detector& detector : detectors_) {
    message_.get(traci::kInductionLoop, traci::kLane, detector.id);
    message_.get(traci::kInductionLoop, traci::kPosition, detector.id);
  }
  if (!is_guest()) message_.subscribe(traci::kSimulation, "", kStepVariables);
  if (message_.command_count() == 0) return;
  TraciReader reply = exchange(message_);
  for (Detector& detector : detectors_) {
    detector.lane = read_text(reply, traci::kInductionLoop, traci::kLane);
    detector.position = read_number(reply, traci::kInductionLoop, traci::kPosition, 0);
  }
  if (is_guest()) return;
  const TraciStatus status = reply.status();
  if (!status.ok()) throw SumoError("SUMO", "refuses a subscription: " + status.text);
  SumoStep ignored;
  read_subscriptions(reply, ignored);
}

std::vector<std::string> TraciBackend::edge_ids() {
  return guarded([&] {
    message_.clear();
    message_.get(traci::kEdge, traci::kIdList, "");
    TraciReader reply = exchange(message_);
    return require_answer(reply, traci::kEdge, traci::kIdList, "its edges").typed_strings();
  });
}

std::string TraciBackend::option(const std::string& name) {
  const auto known = options_.find(name);
  if (known != options_.end()) return known->second;
  return guarded([&] {
    message_.clear();
    message_.get(traci::kSimulation, traci::kOption, name);
    TraciReader reply = exchange(message_);
    const std::string value =
        require_answer(reply, traci::kSimulation, traci::kOption, "its option " + name)
            .typed_string();
    options_[name] = value;
    return value;
  });
}

double TraciBackend::ask_next_switch(std::size_t signal) {
  message_.clear();
  message_.get(traci::kTrafficLight, traci::kNextSwitch, signal_ids_[signal]);
  TraciReader reply = exchange(message_);
  return read_number(reply, traci::kTrafficLight, traci::kNextSwitch,
                     std::numeric_limits<double>::infinity());
}

void TraciBackend::compose_step(std::span<const SumoPose> vehicles,
                                std::span<const SumoPose> persons) {
  message_.clear();
  // ghosts first: what other commands leave on SUMO's stack is best not below them
  // (docs/coupling.md, hazards)
  for (const SumoPose& pose : vehicles) append_ghost(message_, pose, false, mode(false));
  for (const SumoPose& pose : persons) append_ghost(message_, pose, true, mode(true));
  message_.append(queued_);
  for (const SumoPose& pose : vehicles)
    message_.set_double(traci::kVehicle, traci::kSpeed, *pose.id, pose.speed);
  // last: SUMO does not process what stands behind it reliably. Among several clients alone, later:
  // SUMO gives what it has answered before a step to the client whose turn is next
  if (!start_.client_order && !is_guest()) message_.simulation_step();
}

/// The answers to compose_step(), but for the step's own.
void TraciBackend::read_moves(TraciReader& reply, std::span<const SumoPose> vehicles,
                              std::span<const SumoPose> persons, std::vector<std::string>& lost) {
  for (const std::span<const SumoPose> poses : {vehicles, persons})
    for (const SumoPose& pose : poses)
      if (!reply.status().ok()) lost.push_back(*pose.id);
  // what was queued concerned agents that may have left meanwhile: a refusal means nothing
  for (std::size_t left = queued_.command_count(); left > 0; --left) reply.status();
  queued_.clear();
  for (std::size_t left = vehicles.size(); left > 0; --left) reply.status();
}

void TraciBackend::move_ahead(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                              std::vector<std::string>& lost) {
  if (!is_guest()) return;
  compose_step(vehicles, persons);
  if (message_.command_count() == 0) return;
  TraciReader reply = exchange(message_);
  read_moves(reply, vehicles, persons, lost);
}

void TraciBackend::ask_step(SumoStep& result) {
  message_.clear();
  for (const std::uint8_t variable : kStepVariables) message_.get(traci::kSimulation, variable, "");
  TraciReader reply = exchange(message_);
  for (const std::uint8_t variable : kStepVariables) {
    std::optional<TraciReader> value = read_answer(reply, traci::kSimulation, variable);
    if (value) read_simulation_value(*value, variable, result);
  }
}

/// By gets: for each object that is subscribed to SUMO looks through all that are already, and
/// thousands of signals may switch at once.
void TraciBackend::ask_signals(SumoStep& result) {
  message_.clear();
  for (std::size_t i = 0; i < signal_ids_.size(); ++i) {
    if (!is_due(i)) continue;
    result.asked_signals.push_back(static_cast<std::uint32_t>(i));
    message_.get(traci::kTrafficLight, traci::kSignalState, signal_ids_[i]);
    if (by_schedule_) message_.get(traci::kTrafficLight, traci::kNextSwitch, signal_ids_[i]);
  }
  if (result.asked_signals.empty()) return;
  TraciReader reply = exchange(message_);
  for (const std::uint32_t i : result.asked_signals) {
    result.signal_states[i] = read_text(reply, traci::kTrafficLight, traci::kSignalState);
    if (by_schedule_)
      next_switch_[i] = read_number(reply, traci::kTrafficLight, traci::kNextSwitch,
                                    std::numeric_limits<double>::infinity());
  }
}

void TraciBackend::read_step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
                             SumoStep& result) {
  const bool apart = start_.client_order.has_value();
  TraciReader reply{std::span<const std::uint8_t>()};
  if (!apart || message_.command_count() > 0) reply = exchange(message_);
  read_moves(reply, vehicles, persons, result.lost);
  if (apart) {
    message_.clear();
    message_.simulation_step();
    reply = exchange(message_);
  }
  const TraciStatus stepped = reply.status();
  if (stepped.command != traci::kSimulationStep)
    throw SumoError("SUMO", "an answer to another command over TraCI");
  if (!stepped.ok()) throw SumoError("SUMO", "can't make a step: " + stepped.text);
  result.time = std::nan("");
  for (std::int32_t left = reply.integer(); left > 0; --left) read_subscriptions(reply, result);
  if (!std::isfinite(result.time)) throw SumoError("SUMO", "a step without its time over TraCI");
}

void TraciBackend::read_subscriptions(TraciReader& reply, SumoStep& result) {
  constexpr std::size_t kKnownLengthFault = 4;
  reply.block_length(kKnownLengthFault);
  const std::uint8_t response = reply.byte();
  reply.string();
  const int variables = reply.byte();
  if (response == traci::subscribe_response(traci::kSimulation)) {
    read_simulation(reply, variables, result);
    return;
  }
  for (int i = 0; i < variables; ++i) {
    reply.byte();
    reply.byte();
    reply.skip_value();
  }
}

void TraciBackend::read_simulation(TraciReader& reply, int variables, SumoStep& result) {
  for (int i = 0; i < variables; ++i) {
    const std::uint8_t variable = reply.byte();
    if (reply.byte() == traci::kOk)
      read_simulation_value(reply, variable, result);
    else
      reply.skip_value();
  }
}

void TraciBackend::read_simulation_value(TraciReader& reply, std::uint8_t variable,
                                         SumoStep& result) {
  switch (variable) {
    case traci::kTime:
      result.time = reply.typed_double();
      break;
    case traci::kDepartedVehicles:
      result.departed_vehicles = reply.typed_strings();
      break;
    case traci::kArrivedVehicles:
      result.arrived_vehicles = reply.typed_strings();
      break;
    case traci::kDepartedPersons:
      result.departed_persons = reply.typed_strings();
      break;
    case traci::kArrivedPersons:
      result.arrived_persons = reply.typed_strings();
      break;
    case traci::kTeleportCount:
      result.teleports = reply.typed_integer();
      break;
    case traci::kEmergencyStopCount:
      result.emergency_stops = reply.typed_integer();
      break;
    case traci::kCollidingCount:
      result.collisions = reply.typed_integer();
      break;
    case traci::kPendingVehicles:
      result.waiting_to_insert = static_cast<int>(reply.typed_strings().size());
      break;
    default:
      reply.skip_value();
  }
}

void TraciBackend::move_and_step(std::span<const SumoPose> vehicles,
                                 std::span<const SumoPose> persons, SumoStep& result) {
  if (!is_guest()) {
    compose_step(vehicles, persons);
    read_step(vehicles, persons, result);
    ask_signals(result);
    return;
  }
  result.time = std::nan("");
  ask_step(result);
  ask_signals(result);
  if (!std::isfinite(result.time)) throw SumoError("SUMO", "does not tell its time over TraCI");
}

std::vector<std::string> TraciBackend::route_of(const std::string& vehicle) {
  message_.clear();
  message_.get(traci::kVehicle, traci::kEdges, vehicle);
  TraciReader reply = exchange(message_);
  return read_texts(reply, traci::kVehicle, traci::kEdges);
}

std::optional<GhostObservation> TraciBackend::observe(const std::string& id, bool is_person) {
  const std::uint8_t domain = is_person ? traci::kPerson : traci::kVehicle;
  message_.clear();
  for (const std::uint8_t variable : {traci::kPosition, traci::kAngle, traci::kLane})
    message_.get(domain, variable, id);
  // persons need a further argument here, without which SUMO 1.15 ends itself
  if (!is_person) message_.get(domain, traci::kEdges, id);
  TraciReader reply = exchange(message_);
  GhostObservation seen;
  std::optional<TraciReader> position = read_answer(reply, domain, traci::kPosition);
  seen.angle = read_number(reply, domain, traci::kAngle, 0);
  seen.lane = read_text(reply, domain, traci::kLane);
  if (!is_person) seen.route = read_texts(reply, domain, traci::kEdges);
  if (!position) return std::nullopt;
  const auto [x, y] = position->typed_position();
  seen.position = {x, y};
  return seen;
}

void TraciBackend::compose_watch(const std::vector<WatchList::Entry>& entries) {
  watch_message_.clear();
  for (const WatchList::Entry& entry : entries) {
    const std::uint8_t domain = entry.is_person ? traci::kPerson : traci::kVehicle;
    for (const std::uint8_t variable : kWatchedVariables)
      watch_message_.get(domain, variable, entry.id);
    watch_message_.get(domain, entry.is_person ? traci::kRidesIn : traci::kStopState, entry.id);
    if (entry.is_person) watch_message_.get(domain, traci::kStagesLeft, entry.id);
  }
}

/// The answers to compose_watch() for one entry; false: SUMO doesn't know it any more.
bool TraciBackend::read_agent(TraciReader& reply, const WatchList::Entry& entry, SumoAgent& agent) {
  const std::uint8_t domain = entry.is_person ? traci::kPerson : traci::kVehicle;
  std::optional<TraciReader> position = read_answer(reply, domain, traci::kPosition);
  std::optional<TraciReader> angle = read_answer(reply, domain, traci::kAngle);
  std::optional<TraciReader> speed = read_answer(reply, domain, traci::kSpeed);
  std::optional<TraciReader> lane = read_answer(reply, domain, traci::kLane);
  std::optional<TraciReader> along = read_answer(reply, domain, traci::kLanePosition);
  agent.rides = entry.is_person ? read_text(reply, domain, traci::kRidesIn) : std::string();
  agent.stop_state = entry.is_person ? 0 : read_integer(reply, domain, traci::kStopState);
  agent.stages_left = entry.is_person ? read_integer(reply, domain, traci::kStagesLeft) : 0;
  if (!position || !angle || !speed || !lane || !along) return false;
  const auto [x, y] = position->typed_position();
  agent.position = {x, y};
  agent.angle = angle->typed_double();
  agent.speed = speed->typed_double();
  agent.lane = lane->typed_string();
  agent.lane_position = along->typed_double();
  agent.id = entry.id;
  agent.is_person = entry.is_person;
  return true;
}

void TraciBackend::read_watched(const std::vector<WatchList::Entry>& entries,
                                std::vector<SumoAgent>& agents,
                                std::vector<WatchList::Entry>& gone) {
  agents.resize(entries.size());
  if (entries.empty()) return;
  if (std::exchange(watch_changed_, false)) compose_watch(entries);
  TraciReader reply = exchange(watch_message_);
  std::size_t kept = 0;
  for (const WatchList::Entry& entry : entries) {
    if (read_agent(reply, entry, agents[kept]))
      ++kept;
    else
      gone.push_back(entry);
  }
  agents.resize(kept);
}

std::vector<SumoAgentDetails> TraciBackend::details(std::span<const std::string> vehicles,
                                                    std::span<const std::string> persons) {
  if (vehicles.empty() && persons.empty()) return {};
  return guarded([&] {
    message_.clear();
    for (const std::string& id : vehicles) ask_details(message_, id, false);
    for (const std::string& id : persons) ask_details(message_, id, true);
    TraciReader reply = exchange(message_);
    std::vector<SumoAgentDetails> all;
    for (const std::string& id : vehicles) all.push_back(read_details(reply, id, false));
    for (const std::string& id : persons) all.push_back(read_details(reply, id, true));
    read_reroute_periods(all);
    read_walking_speeds(all);
    return all;
  });
}

std::vector<std::string> TraciBackend::take_warnings() {
  std::vector<std::string> all = std::exchange(warnings_, {});
  if (process_) {
    process_->drain();
    for (const std::string& line : process_->output().take_first_warnings())
      all.push_back("SUMO: " + line);
  }
  return all;
}

void TraciBackend::take_over(const std::string& vehicle, double speed) {
  require_finite_pose(vehicle, Vec2::Zero(), 0, speed);
  queued_.set_integer(traci::kVehicle, traci::kSpeedMode, vehicle, kSpeedModeFree);
  queued_.set_pair(traci::kVehicle, traci::kPreviousSpeed, vehicle, speed, 0.0);
}

void TraciBackend::release(const std::string& vehicle) {
  queued_.set_integer(traci::kVehicle, traci::kSpeedMode, vehicle, kSpeedModeSafe);
  queued_.set_double(traci::kVehicle, traci::kSpeed, vehicle, -1.0);
}

void TraciBackend::remove_vehicle(const std::string& id) {
  unwatch(id, false);
  queued_.set_byte(traci::kVehicle, traci::kRemove, id, traci::kRemovedAsArrived);
}

StageKind TraciBackend::finish_stage(const std::string& person) {
  return guarded([&] {
    message_.clear();
    message_.get(traci::kPerson, traci::kStagesLeft, person);
    message_.set_integer(traci::kPerson, traci::kRemoveStage, person, 0);
    message_.get(traci::kPerson, traci::kStage, person, 0);
    TraciReader reply = exchange(message_);
    // in place of the last one SUMO has it wait for no time
    const bool was_last = read_integer(reply, traci::kPerson, traci::kStagesLeft) <= 1;
    reply.status();
    std::optional<TraciReader> value = read_answer(reply, traci::kPerson, traci::kStage);
    return was_last || !value ? StageKind::None : stage_kind(read_stage(*value).type);
  });
}

void TraciBackend::read_reroute_periods(std::vector<SumoAgentDetails>& all) {
  const auto reroutes = [](const SumoAgentDetails& details) {
    return details.reroute_period >= 0.0;
  };
  if (std::none_of(all.begin(), all.end(), reroutes)) return;
  message_.clear();
  for (const SumoAgentDetails& details : all)
    if (reroutes(details))
      message_.get(traci::kVehicle, traci::kParameter, details.id, "device.rerouting.period");
  TraciReader reply = exchange(message_);
  for (SumoAgentDetails& details : all)
    if (reroutes(details))
      details.reroute_period = reroute_period(read_text(reply, traci::kVehicle, traci::kParameter));
}

/// Of people's types: a newer SUMO has the person's own factor in what it tells of the person.
void TraciBackend::read_walking_speeds(std::vector<SumoAgentDetails>& all) {
  message_.clear();
  std::vector<double*> asked;
  for (const SumoAgentDetails& details : all) {
    if (!details.is_person) continue;
    const auto [type, is_new] = type_max_speed_.try_emplace(details.type_id, details.max_speed);
    if (!is_new) continue;
    message_.get(traci::kVehicleType, traci::kMaxSpeed, details.type_id);
    asked.push_back(&type->second);
  }
  if (!asked.empty()) {
    TraciReader reply = exchange(message_);
    for (double* const speed : asked)
      *speed = read_number(reply, traci::kVehicleType, traci::kMaxSpeed, *speed);
  }
  for (SumoAgentDetails& details : all)
    if (details.is_person) details.max_speed = walking_speed(type_max_speed_.at(details.type_id));
}

std::vector<std::string> TraciBackend::id_list(std::uint8_t domain) {
  return guarded([&] {
    message_.clear();
    message_.get(domain, traci::kIdList, "");
    TraciReader reply = exchange(message_);
    return read_texts(reply, domain, traci::kIdList);
  });
}

void TraciBackend::put_on_lane(const SumoPose& pose, const std::string& lane, double speed) {
  require_finite_pose(*pose.id, pose.position, pose.angle, speed);
  // what SUMO derives from its motion as a ghost is no speed to start with
  queued_.set_pair(traci::kVehicle, traci::kPreviousSpeed, *pose.id, speed, 0.0);
  append_move(queued_, pose, lane_hint(lane), false, kOntoLane);
}

void TraciBackend::add_vehicle(const NewVehicle& vehicle) {
  std::size_t route_body = 1 + 4 + vehicle.id.size() + 5;
  for (const std::string& edge : vehicle.route) route_body += 4 + edge.size();
  queued_.begin_command(traci::set_command(traci::kRouteDomain), route_body);
  queued_.raw_byte(traci::kAddRoute);
  queued_.raw_string(vehicle.id);
  queued_.typed_strings(vehicle.route);
  // route, vType, depart time, lane, place and speed, the same of the arrival, taz, taz, line
  const std::array<std::string, 12> words{vehicle.id,
                                          vehicle.type,
                                          "now",
                                          std::to_string(vehicle.lane_index),
                                          number_text(vehicle.front),
                                          "0",
                                          "current",
                                          "max",
                                          "current",
                                          "",
                                          "",
                                          ""};
  std::size_t body = 1 + 4 + vehicle.id.size() + 5 + 5 + 5;
  for (const std::string& word : words) body += 5 + word.size();
  queued_.begin_command(traci::set_command(traci::kVehicle), body);
  queued_.raw_byte(traci::kAddFull);
  queued_.raw_string(vehicle.id);
  queued_.compound(static_cast<std::int32_t>(words.size() + 2));
  for (const std::string& word : words) queued_.typed_string(word);
  queued_.typed_integer(0);  // places for people in it
  queued_.typed_integer(0);  // and people
}

void TraciBackend::set_route(const std::string& vehicle, const std::vector<std::string>& edges) {
  std::size_t body = 5 + vehicle.size() + 5;
  for (const std::string& edge : edges) body += 4 + edge.size();
  queued_.begin_command(traci::set_command(traci::kVehicle), body);
  queued_.raw_byte(traci::kRoute);
  queued_.raw_string(vehicle);
  queued_.typed_strings(edges);
}

std::vector<std::string> TraciBackend::find_route(const std::string& from, const std::string& to,
                                                  const std::string& type) {
  return guarded([&] {
    message_.clear();
    message_.append(queued_);  // travel times that have been set meanwhile
    const std::size_t before = queued_.command_count();
    queued_.clear();
    message_.begin_command(traci::kSimulation,
                           5 + 5 + (5 + from.size()) + (5 + to.size()) + (5 + type.size()) + 9 + 5);
    message_.raw_byte(traci::kFindRoute);
    message_.raw_string("");
    message_.compound(5);
    message_.typed_string(from);
    message_.typed_string(to);
    message_.typed_string(type);
    message_.typed_double(-1.0);  // now
    message_.typed_integer(0);    // by those travel times
    TraciReader reply = exchange(message_);
    for (std::size_t left = before; left > 0; --left) reply.status();
    std::optional<TraciReader> value = read_answer(reply, traci::kSimulation, traci::kFindRoute);
    return value ? read_stage(*value).edges : std::vector<std::string>();
  });
}

void TraciBackend::set_travel_time(const std::string& edge, double seconds) {
  queued_.begin_command(traci::set_command(traci::kEdge), 5 + edge.size() + 5 + 9);
  queued_.raw_byte(traci::kTravelTime);
  queued_.raw_string(edge);
  queued_.compound(1);
  queued_.typed_double(seconds);
}

std::vector<double> TraciBackend::lane_speeds(std::span<const std::string> lanes) {
  return guarded([&] {
    message_.clear();
    for (const std::string& lane : lanes) message_.get(traci::kLaneDomain, traci::kMaxSpeed, lane);
    TraciReader reply = exchange(message_);
    std::vector<double> speeds;
    for (std::size_t i = 0; i < lanes.size(); ++i)
      speeds.push_back(read_number(reply, traci::kLaneDomain, traci::kMaxSpeed, -1.0));
    return speeds;
  });
}

std::vector<std::string> TraciBackend::parameters(std::span<const std::string> vehicles,
                                                  const std::string& key) {
  return guarded([&] {
    message_.clear();
    for (const std::string& id : vehicles)
      message_.get(traci::kVehicle, traci::kParameter, id, key);
    std::vector<std::string> values;
    if (vehicles.empty()) return values;
    TraciReader reply = exchange(message_);
    for (std::size_t i = 0; i < vehicles.size(); ++i)
      values.push_back(read_text(reply, traci::kVehicle, traci::kParameter));
    return values;
  });
}

void TraciBackend::add_stop(const std::string& vehicle, const SumoAgentDetails::Stop& stop) {
  const bool at_place = (stop.flags & stop_flags::kStoppingPlace) != 0;
  const LaneHint hint = lane_hint(stop.lane);
  const std::string& where = at_place ? stop.place : hint.edge;
  queued_.begin_command(traci::set_command(traci::kVehicle),
                        5 + vehicle.size() + 5 + (5 + where.size()) + 9 + 2 + 9 + 2 + 9 + 9);
  queued_.raw_byte(traci::kStop);
  queued_.raw_string(vehicle);
  queued_.compound(7);
  queued_.typed_string(where);
  queued_.typed_double(stop.end);
  queued_.typed_byte(static_cast<std::uint8_t>(hint.index));
  // none would be for ever
  queued_.typed_double(std::max(stop.duration, 0.0));
  queued_.typed_byte(static_cast<std::uint8_t>(stop.flags));
  queued_.typed_double(stop.start);
  queued_.typed_double(stop.until >= 0 ? stop.until : kInvalidDouble);
}

void TraciBackend::close() {
  if (closed_) return;
  closed_ = true;
  if (client_ && client_->connected()) {
    try {
      // what was queued (arrivals of the last tick) still counts in SUMO's own statistics
      message_.clear();
      message_.append(queued_);
      if (!is_guest()) message_.begin_command(traci::kClose, 0);
      if (message_.command_count() > 0) client_->exchange(message_, kCloseGrace);
    } catch (const SumoError&) {
      // it went away by itself: the process below tells
    }
    client_->close();
  }
  if (process_ && !process_->wait(kCloseGrace)) process_->terminate(2);
}

}  // namespace

std::unique_ptr<SumoBackend> start_traci_backend(const SumoStart& start) {
  return std::make_unique<TraciBackend>(start);
}

}  // namespace sumogamma
