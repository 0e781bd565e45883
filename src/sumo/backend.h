#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Pose in SUMO's words: vehicles by front bumper, persons by centre; angle in degrees clockwise
/// from north.
struct SumoPose {
  const std::string* id = nullptr;
  Vec2 position = Vec2::Zero();  ///< [m]
  double angle = 0;              ///< [deg], any finite value: the back end wraps it
  double speed = 0;              ///< vehicles: what SUMO is to tell of it, see take_over() [m/s]
};

/// A vehicle or person as SUMO reports it.
struct SumoAgent {
  std::string id;
  bool is_person = false;
  Vec2 position = Vec2::Zero();  ///< front bumper (vehicle) or centre (person) [m]
  double angle = 0;              ///< [deg]
  double speed = 0;              ///< [m/s]
  std::string lane;              ///< "" off every lane
  double lane_position = 0;      ///< on it, as SUMO counts [m]
  int stop_state = 0;            ///< vehicles: bits of stop_state below
  std::string rides;             ///< persons: the vehicle that it sits in, "" outside of any
  int stages_left = 0;           ///< persons: of its plan, the present one included
};

/// Bits of a vehicle's stop state (TraCI, "stop state", 0xb5).
namespace stop_state {
inline constexpr int kStopped = 1, kParking = 2;
inline bool stopped(int bits) { return (bits & kStopped) != 0; }
inline bool parked(int bits) { return stopped(bits) && (bits & kParking) != 0; }
}  // namespace stop_state

/// What a person is doing, by its present stage (TraCI, "get stage").
enum class StageKind {
  None,  ///< its plan is over
  Walking,
  Waiting,  ///< at a stop of its plan
  Riding,   ///< in a vehicle or waiting for one
  Other,    ///< access to a platform, a trip that has not been routed
};

/// Bits of a planned stop (TraCI, "stop", 0x12), as they are read and as they are set.
namespace stop_flags {
inline constexpr int kParking = 1, kStoppingPlace = 8 | 16 | 32 | 64;  // bus, container, charging,
                                                                       // parking area
}

/// What SUMO tells of a vehicle's type beyond its body; negative: not told (persons).
struct SumoVehicleType {
  double acceleration = -1, deceleration = -1, emergency_deceleration = -1;  ///< [m/s^2]
  double headway = -1;                                                       ///< tau [s]
  double min_gap = -1;                                                       ///< [m]
  double imperfection = -1;  ///< sigma; negative also of car-following models without one
};

/// What a newcomer is and wants, read once at departure.
struct SumoAgentDetails {
  std::string id;
  bool is_person = false;
  std::string type_id;
  std::string vehicle_class;                 ///< "passenger", "pedestrian", ...
  double length = 0, width = 0, height = 0;  ///< [m]
  double max_speed =
      0;  ///< of the vType; persons: at most SUMO's walking speed, before the factor [m/s]
  double speed_factor = 1;
  SumoVehicleType type;
  double allowed_speed = 0;  ///< vehicles: what SUMO lets it drive on its lane at departure [m/s]
  std::string lane;          ///< at departure, may be empty
  double lane_position = 0;  ///< front bumper along that lane [m]
  std::vector<std::string>
      route;  ///< edges: the vehicle's whole route, or the edges of the person's current walk
  double arrival_position = -1;  ///< along the last edge [m], < 0: its end
  double mid_block = -1;         ///< as PathRequest::mid_block; not SUMO's
  struct Stop {
    std::string lane;
    double start = 0, end = 0;  ///< along the lane [m]
    double duration = -1;       ///< at the least [s]; negative: none
    double until = -1;          ///< not before this time [s]; negative: none
    std::string place;          ///< bus stop, parking area, ...; empty: a place on the lane
    int flags = 0;              ///< bits of stop_flags
    double speed = 0;           ///< > 0: passed at this speed at most (a waypoint) [m/s]
  };
  std::vector<Stop> stops;     ///< vehicles: those ahead, in order
  int stop_state = 0;          ///< vehicles: bits of stop_state
  int route_index = 0;         ///< vehicles: of the edge in `route` that SUMO has it on
  bool is_taxi = false;        ///< vehicles: SUMO's taxi dispatch gives it its ways
  double reroute_period = -1;  ///< vehicles with a rerouting device: time between its looks [s], 0
                               ///< for one at departure; negative: without
  StageKind stage = StageKind::None;  ///< persons
  int stages_left = 0;                ///< persons: of the plan, the present one included
};

/// What happened during a step.
struct SumoStep {
  double time = 0;  ///< after the step [s]
  std::vector<std::string> departed_vehicles, departed_persons;
  std::vector<std::string> arrived_vehicles, arrived_persons;
  std::vector<std::string> lost;  ///< ids whose pose SUMO refused (vanished between read and write)
  std::vector<SumoAgent> agents;  ///< poses of the agents asked for with watch(), after the step
  std::vector<std::pair<bool, std::string>>
      gone;  ///< watched ones that SUMO doesn't know any more: is it a person, id
  std::vector<std::string> signal_states;    ///< one a signal, in the order of signal_ids()
  std::vector<std::uint32_t> asked_signals;  ///< those of which this step has told the state
  int teleports = 0, emergency_stops = 0, collisions = 0;
  int waiting_to_insert = 0;  ///< SUMO's own insertion backlog
};

/// The seam to SUMO. One exchange a step: all poses in, everything that a tick needs out. Every
/// call throws SumoError (never crashes or hangs: each wait has a time limit) where SUMO fails or
/// goes away.
class SumoBackend {
 public:
  virtual ~SumoBackend() = default;

  /// Ready to step: version string such as "SUMO 1.15.0".
  virtual std::string version() const = 0;
  /// Path of the network file and the additional files that SUMO loaded, as options gave them;
  /// begin time; step length.
  virtual std::string option(const std::string& name) = 0;
  virtual const std::vector<std::string>& signal_ids() const = 0;
  /// Edges of the network that SUMO has loaded, those inside junctions included.
  virtual std::vector<std::string> edge_ids() = 0;
  virtual double time() const = 0;
  /// When a signal changes next, by its place in signal_ids() [s]; infinite where SUMO can't tell.
  virtual double next_switch(std::size_t signal) = 0;

  /// Who is in the simulation already: of a loaded state, or of a SUMO that the user started.
  virtual std::vector<std::string> present_vehicles() = 0;
  virtual std::vector<std::string> present_persons() = 0;

  /// Moves every ghost and advances one step. A ghost left out for one step is forgotten by SUMO.
  void step(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons,
            SumoStep& result) {
    send(vehicles, persons);
    receive(result);
  }
  /// The two halves of step(): where SUMO's own client makes its steps (SumoStart::socket), it does
  /// so in between. The poses must stay where they are until then.
  virtual void send(std::span<const SumoPose> vehicles, std::span<const SumoPose> persons) = 0;
  virtual void receive(SumoStep& result) = 0;
  /// Details of newcomers, in the order of ids.
  virtual std::vector<SumoAgentDetails> details(std::span<const std::string> vehicles,
                                                std::span<const std::string> persons) = 0;
  /// Reported after each step from now on (agents that SUMO drives, or all for the coupling error).
  /// An agent that is gone is dropped silently.
  virtual void watch(const std::string& id, bool is_person) = 0;
  virtual void unwatch(const std::string& id, bool is_person) = 0;
  /// Takes a vehicle out as arrived, or ends a person's current stage and tells the next one.
  virtual void remove_vehicle(const std::string& id) = 0;
  virtual StageKind finish_stage(const std::string& person) = 0;
  /// Puts a ghost onto a lane at `pose` in the coming step, where SUMO's stops and rerouters find
  /// it; from then on SUMO moves it, from `speed` [m/s], until it is a ghost again.
  virtual void put_on_lane(const SumoPose& pose, const std::string& lane, double speed) = 0;
  /// Adds a vehicle that departs in the coming step: its vType, its route, the index of the lane of
  /// the route's first edge and the place of its front along that [m]. One that SUMO can't have is
  /// never seen.
  struct NewVehicle {
    std::string id, type;
    std::vector<std::string> route;
    int lane_index = 0;
    double front = 0;
  };
  virtual void add_vehicle(const NewVehicle& vehicle) = 0;
  /// Adds a stop to a vehicle's plan.
  virtual void add_stop(const std::string& vehicle, const SumoAgentDetails::Stop& stop) = 0;
  /// The route of a vehicle from its first edge on.
  virtual void set_route(const std::string& vehicle, const std::vector<std::string>& edges) = 0;
  /// SUMO's fastest route for a vType by the travel times of set_travel_time; empty: there is none.
  virtual std::vector<std::string> find_route(const std::string& from, const std::string& to,
                                              const std::string& type) = 0;
  /// What SUMO's routers take for the travel time of an edge from now on [s].
  virtual void set_travel_time(const std::string& edge, double seconds) = 0;
  /// Present speed limits of lanes [m/s], negative where SUMO doesn't know the lane.
  virtual std::vector<double> lane_speeds(std::span<const std::string> lanes) = 0;
  /// A parameter (TraCI, "generic parameters") of vehicles; "" where there is none.
  virtual std::vector<std::string> parameters(std::span<const std::string> vehicles,
                                              const std::string& key) = 0;
  virtual void set_parameter(const std::string& vehicle, const std::string& key,
                             const std::string& value) = 0;
  /// A vehicle that step() moves from now on, at `speed` [m/s] so far: SUMO's limits no longer
  /// apply to the speeds that step() has it tell.
  virtual void take_over(const std::string& vehicle, double speed) = 0;
  /// The other way round: SUMO drives it by its own limits.
  virtual void release(const std::string& vehicle) = 0;
  /// Somebody whom SUMO moves: hold this speed [m/s]; negative gives it back to SUMO.
  virtual void set_speed(const std::string& id, bool is_person, double speed) = 0;
  /// In what color its window shows somebody, red, green and blue; nothing where it has none.
  virtual void set_color(const std::string& id, bool is_person,
                         const std::array<std::uint8_t, 3>& color) {
    (void)id, (void)is_person, (void)color;
  }
  /// SUMO-driven vehicle: may it change lanes by itself? As SUMO has it by default, or not at all.
  virtual void allow_lane_changes(const std::string& vehicle, bool allowed) = 0;
  /// Tells actuated signals that a vehicle passed `age` seconds ago, for each listed detector.
  virtual void override_detectors(std::span<const std::pair<std::string, double>> detectors) = 0;
  /// Ids, lanes and positions of the induction loops (those of actuated signals included).
  struct Detector {
    std::string id, lane;
    double position = 0;
  };
  virtual const std::vector<Detector>& detectors() const = 0;
  /// What the user should know, ours and SUMO's own complaints, since the last call; few and short.
  virtual std::vector<std::string> take_warnings() { return {}; }
  /// Lines of warning that SUMO has printed so far; -1: unknown (a SUMO that the user started).
  virtual long sumo_warnings() const { return -1; }
  /// Ends SUMO in good order; further calls are errors. Idempotent.
  virtual void close() = 0;
};

struct SumoStart {
  std::string binary = "sumo";         ///< or sumo-gui; looked up in $SUMO_HOME/bin, then PATH
  std::vector<std::string> arguments;  ///< without the binary; remote-port is added by the back end
  double start_timeout = 60;           ///< [s] to load the network
  double step_timeout = 120;           ///< [s] for one exchange
  std::string connect_host;  ///< not empty: join a SUMO that the user started, instead of a child
  int connect_port = 0;
  int socket = -1;  ///< not negative: an open TraCI connection of a client that makes the steps; it
                    ///< stays that client's, and is used between its own exchanges alone
  std::optional<int> client_order;  ///< our place among several TraCI clients
  int clients = 1;  ///< of a child: how many it waits for, us included (its --num-clients)
  int port = 0;     ///< for a child to listen on; 0: any free one
  /// Signals change when their own programs say so: neither a WAUT nor anybody at SUMO's window
  /// switches them. Then a step asks for those alone whose program has an event in it. Other
  /// clients may do anything: where there are some, all are asked for.
  bool signals_by_schedule = false;
  /// Told of the port before others are waited for; may be empty.
  std::function<void(int)> on_listening;
};

/// Child process (or a user's SUMO) over a loopback socket with the batching client.
std::unique_ptr<SumoBackend> start_traci_backend(const SumoStart& start);
/// In process with libsumo. One at a time. Opens the module that is linked with libsumo, so that no
/// other command pays for libsumo's shared libraries; throws Error naming its file where it can't.
std::unique_ptr<SumoBackend> start_libsumo_backend(const SumoStart& start);

}  // namespace sumogamma
