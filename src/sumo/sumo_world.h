#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "road/lane_locator.h"
#include "scene/point_speeds.h"
#include "scene/trip.h"
#include "simulation/world.h"
#include "sumo/backend.h"
#include "sumo/control_choice.h"
#include "sumo/edge_speeds.h"
#include "sumo/vehicle_types.h"

namespace sumogamma {

/// Options of a run in SUMO.
struct SumoWorldOptions {
  ControlChoice control = control_of_all();
  std::size_t max_vehicles = 0;  ///< cap on vehicles on the road at once, 0: none
  std::uint64_t seed = 1;
  double dt = 0.05;                         ///< [s]
  std::vector<std::string> rerouter_edges;  ///< on which SUMO's rerouters act
  std::vector<std::string> sign_lanes;      ///< whose speed limit SUMO changes as it runs
  bool others_steer = false;                ///< another client may change any lane's
  std::set<std::string> type_keys;  ///< of scenario.toml that win over vTypes: "types.car.headway"
  std::size_t watched = 32;         ///< ghosts whose pose is read back to measure the coupling
};

/// Counts of the life cycle, by type name.
struct LifeCycle {
  struct Count {
    std::int64_t inserted = 0, arrived = 0;
  };
  std::vector<FinishedTrip> trips;  ///< of those who arrived, in order of arrival
  std::map<std::string, Count> by_type;
  std::map<std::string, std::int64_t> removed;  ///< taken out before the destination, by reason
  std::map<std::string, std::int64_t>
      left_to_sumo;                     ///< not driven by us although asked for, by reason
  std::int64_t stops_served = 0;        ///< planned halts of agents that we drive
  std::int64_t rides = 0;               ///< times that somebody boarded a vehicle
  std::int64_t insertions_delayed = 0;  ///< of SUMO's vehicles, for ghosts in their place
  std::int64_t taken_over = 0;          ///< in motion, from SUMO
  std::int64_t handed_back = 0;         ///< in motion, to SUMO
  std::int64_t kept_on_foot =
      0;                    ///< people whom a rule gives up: SUMO would freeze them, they stay
  std::size_t waiting = 0;  ///< departed in SUMO, waiting for room here
};

/// How SUMO went on with a vehicle in the steps after it was handed back.
struct HandBack {
  double position = 0;      ///< most that it was off where its speed and heading led in a step [m]
  double heading = 0;       ///< largest change in a step [rad]
  double speed = 0;         ///< likewise [m/s]
  double acceleration = 0;  ///< largest [m/s^2]
};

/// What SUMO reported against what was written.
struct CouplingCheck {
  std::function<void(const Vec2& written, const Vec2& reported)>
      compare;  ///< called for each pose read back
  int teleports = 0, emergency_stops = 0, sumo_collisions = 0;
  std::vector<HandBack> hand_backs;
};

/// SUMO as the world: it inserts, routes, signals and shows; agents under our control are ghosts in
/// it (see docs/coupling.md). Life cycle of an agent: departed in SUMO -> pending (kept off the map
/// until its place is free) -> driven -> arrived. In between SUMO has it for a while wherever its
/// plan is more than a way: at stops, in parking places, while it waits for a ride or sits in a
/// vehicle (plans.cpp).
class SumoWorld : public World {
 public:
  /// `model` and `backend` outlive the world, which adds rows to the model's tables of types for
  /// vTypes that ask for one, in observe() alone.
  SumoWorld(Model& model, SumoBackend& backend, SumoWorldOptions options);

  void observe(Scene& scene, RoadState& road) override;
  void advance(const Scene& scene) override;
  bool finished() const override;

  const LifeCycle& life_cycle() const { return life_cycle_; }
  CouplingCheck& coupling() { return coupling_; }
  /// SUMO's id of an agent, by AgentId.
  const std::vector<std::string>& names() const { return names_; }
  const SumoStep& last_step() const { return step_; }

 private:
  struct Pending {
    SumoAgentDetails details;
    AgentTypeId type{};
    std::shared_ptr<const Path> path;  ///< from the lane that SUMO chose
    std::optional<AgentId> blocker;    ///< who was last in the way there
    struct Beside {
      std::shared_ptr<const Path> path;
      std::optional<AgentId> blocker;
    };
    std::vector<Beside> besides;  ///< from the lanes beside it, once needed
    bool looked_besides = false;
    bool resumes = false;      ///< SUMO has it for a while: ours as soon as it moves on
    bool off_lane = false;     ///< SUMO has been told that it waits
    bool was_delayed = false;  ///< its insertion by SUMO was put off once
    /// Parked: where SUMO shows its front, and its angle [deg]; others wait off the map.
    Vec2 waits_at = Vec2::Constant(std::nan(""));
    double waiting_angle = 0;
  };
  /// SUMO's own vehicle, which waits off the map for room among ghosts.
  struct Delayed {
    Pending pending;
    Vec2 front = Vec2::Zero();  ///< where SUMO had inserted it, its angle [deg], speed and lane
    double angle = 0, speed = 0;
    LaneId lane = kNoLane;
    bool off_lane = false;  ///< as Pending::off_lane
  };
  /// What SUMO does with a vehicle of ours that halts at a stop of its plan.
  enum class Service {
    None,
    Asked,     ///< it is on its lane there, SUMO has not said yet that it stands
    Standing,  ///< SUMO counts its time, lets people in and out
  };
  struct Known {
    std::string sumo_id;
    bool is_person = false;
    bool external = false;
    bool speed_held = false;         ///< SUMO-driven: we hold its speed behind a ghost
    std::uint32_t rules = 0;         ///< that may concern it, as bits
    bool sumos_own = false;          ///< nobody but SUMO can move it
    bool leaves = false;             ///< ours, and wanted by no rule any more
    bool was_kept = false;           ///< counted in LifeCycle::kept_on_foot
    double liked_offset = 0;         ///< beside its path, before it made for its lane's middle [m]
    int watched_steps = -1;          ///< since it was handed back; negative: over, or never
    HandBack hand_back{};            ///< as seen so far
    Vec2 last_front = Vec2::Zero();  ///< where SUMO had its front in the step before [m]
    double last_angle = 0, last_speed = 0;
    std::string wish{};            ///< of another client: "take", "release", or ""
    bool overtaking_held = false;  ///< SUMO-driven: we keep it off the opposite lane
    std::string eagerness{};       ///< its own for that, once asked for
    double keeps_lane_until = 0;   ///< SUMO-driven: no lane change so soon after it was ours [s]
    bool lane_held = false;        ///< SUMO-driven: we keep it from changing lanes beside a ghost
    bool resumes = false;          ///< as Pending::resumes
    bool keeps_place = false;      ///< it waits where it walked to, not where SUMO shows it
    double length = 0;             ///< 0 for persons, whose reference point is their centre [m]
    std::string lane_name{};       ///< SUMO-driven: on which SUMO had it last
    LaneId lane = kNoLane;         ///< the same
    double looked_at = 0;          ///< when its path was last held against that lane [s]
    int stages_left = 0;           ///< persons that SUMO moves
    Service service = Service::None;
    double asked_at = 0;                           ///< when its service began [s]
    std::vector<SumoAgentDetails::Stop> stops{};   ///< of its plan, as PathStop::plan counts
    std::string type_id{};                         ///< SUMO's vType
    std::vector<std::string> route{};              ///< SUMO's, as it was last known or told
    std::shared_ptr<const Trip> trip;              ///< the one that SUMO knows
    EdgeId edge = kNoEdge;                         ///< on which it was last shown to rerouters
    double reroute_period = -1, next_reroute = 0;  ///< of its rerouting device [s]
  };
  /// From its first place in the scene to its destination, in it or in a vehicle.
  struct Journey {
    AgentId id;
    AgentTypeId type{};
    double departed = 0;  ///< [s]
  };
  using Traveller = std::pair<bool, std::string>;  ///< is it a person, SUMO's id

  void take_departed();
  void take_newcomer(SumoAgentDetails details, bool moves_already);
  void take_arrived(Scene& scene, RoadState& road);
  void finish_driven(Scene& scene, RoadState& road);
  void insert_pending(Scene& scene, RoadState& road);
  void update_external(Scene& scene, RoadState& road);
  void appear(const SumoAgent& seen, Pending& pending, Scene& scene, RoadState& road);
  void follow(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene, RoadState& road,
              std::vector<bool>& removed);

  // plans.cpp
  std::optional<SumoAgentDetails> details_of(const std::string& id, bool is_person);
  std::shared_ptr<const Path> way_of(SumoAgentDetails& details, AgentTypeId type);
  bool touches(const Scene& scene, std::size_t row) const;
  bool is_out_of_sight(const SumoAgent& seen, double length, const Scene& scene) const;
  void leave_sight(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                   RoadState& road, std::vector<bool>& removed);
  void watch_absent(const SumoAgent& seen, const Scene& scene);
  bool take_back(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene, RoadState& road);
  bool rejoin(const SumoAgent& seen, bool parked);
  bool walk_on(Scene& scene, RoadState& road, std::size_t row);
  void hand_over_person(AgentId id, std::size_t row, Scene& scene, RoadState& road);
  void begin_services(Scene& scene, const RoadState& road);
  void follow_service(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                      RoadState& road, std::vector<bool>& removed);
  void end_service(AgentId id, std::size_t row, Scene& scene, RoadState& road);

  // routes.cpp
  bool same_way(const Path& path, double along, const SumoAgentDetails& details) const;
  bool follow_sumos_route(SumoAgentDetails& details, AgentId id, std::size_t row, Scene& scene,
                          RoadState& road);
  void follow_rerouters(Scene& scene, RoadState& road);
  bool enters_rerouter(const Scene& scene, std::size_t row);
  void tell_routes(const Scene& scene, const RoadState& road);
  void look_for_faster_routes(Scene& scene, RoadState& road);
  void read_speed_limits(const Scene& scene, RoadState& road);
  /// The lane on which SUMO has the front of an agent that it drives, and its centre along that.
  void place_external(const SumoAgent& seen, Scene& scene, std::size_t row) const;

  // sumos_drivers.cpp
  void read_links();
  void follow_lane(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                   RoadState& road);
  bool delay_insertion(const SumoAgent& seen, Pending& pending, const Scene& scene);
  bool fits(const Delayed& delayed, const SumoAgentDetails& details, double speed,
            const Scene& scene, bool ghosts_only) const;
  void insert_delayed(const Scene& scene);
  void hold_drivers(const Scene& scene);
  double free_speed(const Scene& scene, std::size_t row, std::span<const std::uint32_t> near,
                    bool straight_on) const;
  bool is_barred(const Scene& scene, std::size_t row, std::span<const std::uint32_t> near) const;
  void hold_overtaking(const Scene& scene, std::size_t row);
  bool meets_ghosts(const Scene& scene, std::size_t row) const;
  bool overtakes(const Scene& scene, std::size_t row) const;
  double inner_side(const Lane& lane) const;

  bool insert(Pending& pending, Scene& scene, RoadState& road);
  bool insert_on(const Pending& pending, const std::shared_ptr<const Path>& path,
                 std::optional<AgentId>& blocker, Scene& scene, RoadState& road);
  /// The agent as it would stand at the start of `path`.
  AgentState newcomer(const Pending& pending, const Path& path, AgentId id) const;
  AgentId register_agent(const SumoAgentDetails& details, bool external, AgentTypeId type);
  void record_arrival(const Traveller& traveller);
  void forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
              std::size_t row);
  void compare_poses();
  void read_detectors();
  void feed_detectors(const Scene& scene);

  // ownership.cpp
  std::uint32_t rules_for(const SumoAgentDetails& details, AgentTypeId type) const;
  bool is_always_ours(std::uint32_t rules) const;
  bool changes_hands() const;
  bool is_wanted(const Known& known, const Vec2& position, bool ours) const;
  bool may_take(const Scene& scene, std::size_t row) const;
  bool may_give(const Scene& scene, std::size_t row) const;
  void find_centers(const Scene& scene);
  void read_wishes();
  void hand_back(Scene& scene);
  void give(AgentId id, Scene& scene, std::size_t row);
  void watch_hand_back(const SumoAgent& seen, Known& known);
  bool has_room_for(const Scene& scene, std::size_t row) const;
  void take_over(AgentId id, Scene& scene, std::size_t row);

  std::vector<Vec2> centers_;  ///< of the circles of rules; not finite where there is none now
  double next_wishes_ = 0;     ///< when other clients' wishes are read again [s]
  const Model& model_;
  const RoadState* road_ = nullptr;  ///< of the last observe()
  LaneLocator locator_;
  SumoBackend& backend_;
  SumoWorldOptions options_;
  VehicleTypeRows rows_;
  SumoStep step_;
  LifeCycle life_cycle_;
  CouplingCheck coupling_;
  std::deque<Pending> pending_;
  std::vector<Delayed> delayed_;
  bool observed_ = false;
  std::map<Traveller, Pending> external_arriving_;  ///< watched, first pose not seen yet
  std::map<Traveller, Pending> absent_;  ///< watched, in no scene: in a vehicle, parked on a lane
  std::map<Traveller, AgentId> external_ids_;  ///< watched: whom SUMO moves, whose halts it serves
  std::map<Traveller, Journey> journeys_;
  std::vector<Known> known_;                                 ///< by AgentId
  std::vector<std::string> names_;                           ///< by AgentId
  std::vector<SignalId> signal_order_;                       ///< of the back end's list
  std::map<std::string, std::pair<AgentId, Vec2>> written_;  ///< watched ghosts: what was sent
  std::vector<SumoPose> vehicle_poses_, person_poses_;
  struct LinkPiece {
    ConnectionId link = kNoConnection;
    double before = 0;  ///< of the link, before this lane of it [m]
  };
  std::vector<LinkPiece> link_pieces_;  ///< by LaneId
  SpatialGrid ghosts_;                  ///< everybody's places at the end of the tick
  PointSpeeds speeds_;                  ///< of the reference points of those whom we drive
  struct LaneDetector {
    std::size_t index = 0;  ///< into detector_ages_
    double position = 0;    ///< along the lane [m]
    double last_seen = 0;   ///< when a vehicle was last on it [s]
  };
  std::map<LaneId, std::vector<LaneDetector>>
      detectors_;  ///< induction loops on lanes of the network
  std::vector<std::pair<std::string, double>>
      detector_ages_;                            ///< id and seconds since it was last passed
  std::vector<bool> at_rerouter_;                ///< by EdgeId; empty: there are none
  std::vector<AgentId> shown_;                   ///< to rerouters, in the last step
  std::shared_ptr<std::vector<double>> limits_;  ///< by LaneId [m/s]; null: none can change
  std::vector<LaneId> limited_;                  ///< lanes whose limit may change
  double next_limits_ = 0;                       ///< when they are read again [s]
  EdgeSpeeds edge_speeds_;
  bool has_rerouting_ = false;
  double next_look_ = 0;  ///< of rerouting devices at travel times [s]
  double time_ = 0;
};

}  // namespace sumogamma
