#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "road/lane_locator.h"
#include "scene/point_speeds.h"
#include "scene/trip.h"
#include "simulation/world.h"
#include "sumo/backend.h"
#include "sumo/changing_limits.h"
#include "sumo/control_choice.h"
#include "sumo/edge_speeds.h"
#include "sumo/insertion.h"
#include "sumo/known_agents.h"
#include "sumo/link_pieces.h"
#include "sumo/loop_detectors.h"
#include "sumo/vehicle_types.h"

namespace sumogamma {

/// Options of a run in SUMO.
struct SumoWorldOptions {
  ControlChoice control = control_of_all();
  std::size_t max_vehicles = 0;  ///< cap on vehicles on the road at once, 0: none
  std::string ego;               ///< vehicle that the cap doesn't hold back
  std::uint64_t seed = 1;
  double dt = 0.05;                         ///< [s]
  std::vector<std::string> rerouter_edges;  ///< on which SUMO's rerouters act
  std::vector<std::string> sign_lanes;      ///< whose speed limit SUMO changes as it runs
  /// Most with which a newcomer starts, by its id or its flow's [m/s].
  std::unordered_map<std::string, double> depart_speeds;
  bool others_steer = false;        ///< another client may change any lane's
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
  /// The two halves of advance(), where another client makes SUMO's step in between.
  void send(const Scene& scene);
  void receive();
  bool finished() const override;

  const LifeCycle& life_cycle() const { return life_cycle_; }
  CouplingCheck& coupling() { return coupling_; }
  /// SUMO's id of an agent, by AgentId.
  const std::vector<std::string>& names() const { return names_; }
  const SumoStep& last_step() const { return step_; }
  const LaneLocator& locator() const { return locator_; }
  /// What is known of agents, by AgentId.
  const std::vector<KnownAgent>& known_agents() const { return known_; }
  /// Who waits off the map for room: ours, and SUMO's own.
  const std::deque<PendingAgent>& pending() const { return pending_; }
  const std::vector<DelayedVehicle>& delayed() const { return delayed_; }
  /// Limits of all lanes that hold now; null: the network's.
  SpeedLimits speed_limits() const { return limits_.limits; }
  /// People in vehicles.
  std::size_t riding() const;

 private:
  // advance
  void collect_poses(const Scene& scene);
  void collect_waiting();
  void note_step();
  void compare_poses();

  // departures.cpp
  void take_departed();
  void take_newcomer(SumoAgentDetails details, bool moves_already);
  AgentId register_agent(const SumoAgentDetails& details, bool external, AgentTypeId type);
  void insert_pending(Scene& scene, RoadState& road);
  void enter(const PendingAgent& pending, Entrant entrant, Scene& scene, RoadState& road);

  // arrivals.cpp
  void take_arrived(Scene& scene, RoadState& road);
  void take_refused(const std::string& sumo_id, Scene& scene, RoadState& road,
                    std::vector<bool>& removed);
  void finish_driven(Scene& scene, RoadState& road);
  void record_arrival(const SumoTraveller& traveller);
  void forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
              std::size_t row);

  // followed.cpp
  void update_external(Scene& scene, RoadState& road);
  void appear(const SumoAgent& seen, PendingAgent& pending, Scene& scene, RoadState& road);
  void follow(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene, RoadState& road,
              std::vector<bool>& removed);
  /// The lane on which SUMO has the front of an agent that it drives, and its centre along that.
  void place_external(const SumoAgent& seen, Scene& scene, std::size_t row) const;
  void note_sumo_place(const SumoAgent& seen, KnownAgent& known) const;

  // plans.cpp
  std::optional<SumoAgentDetails> details_of(const std::string& id, bool is_person);
  std::shared_ptr<const Path> way_of(SumoAgentDetails& details, AgentTypeId type);
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
  void follow_limits(const Scene& scene, RoadState& road);

  // sumos_drivers.cpp
  void follow_lane(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                   RoadState& road);
  bool delay_insertion(const SumoAgent& seen, PendingAgent& pending, const Scene& scene);
  bool fits(const DelayedVehicle& delayed, const SumoAgentDetails& details, double speed,
            const Scene& scene, bool ghosts_only) const;
  void insert_delayed(const Scene& scene);
  void hold_drivers(const Scene& scene);
  void hold_speed(const Scene& scene, std::size_t row, bool aside,
                  std::span<const std::uint32_t> near);
  void hold_overtaking(const Scene& scene, std::size_t row);
  bool overtakes(const Scene& scene, std::size_t row) const;

  // ownership.cpp
  std::uint32_t rules_for(const SumoAgentDetails& details, AgentTypeId type) const;
  bool is_always_ours(std::uint32_t rules) const;
  bool changes_hands() const;
  bool is_wanted(const KnownAgent& known, const Vec2& position, bool ours) const;
  bool may_take(const Scene& scene, std::size_t row) const;
  bool may_give(const Scene& scene, std::size_t row) const;
  void find_centers(const Scene& scene);
  void read_wishes();
  void hand_back(Scene& scene);
  void give(AgentId id, Scene& scene, std::size_t row);
  void watch_hand_back(const SumoAgent& seen, HandBackWatch& watch);
  void take_over(AgentId id, Scene& scene, std::size_t row);

  const Model& model_;
  SumoBackend& backend_;
  SumoWorldOptions options_;
  LaneLocator locator_;
  VehicleTypeRows rows_;
  double time_ = 0;
  bool observed_ = false;            ///< once
  const RoadState* road_ = nullptr;  ///< of the last observe()
  SumoStep step_;
  LifeCycle life_cycle_;
  CouplingCheck coupling_;

  // who is where
  std::vector<KnownAgent> known_;   ///< by AgentId
  std::vector<std::string> names_;  ///< by AgentId
  std::map<SumoTraveller, Journey> journeys_;
  std::deque<PendingAgent> pending_;                         ///< ours, in order of departure
  std::vector<DelayedVehicle> delayed_;                      ///< SUMO's
  std::map<SumoTraveller, PendingAgent> external_arriving_;  ///< watched, first pose not seen yet
  std::map<SumoTraveller, PendingAgent>
      absent_;  ///< watched, in no scene: in a vehicle, parked on a lane
  std::map<SumoTraveller, AgentId>
      external_ids_;  ///< watched: whom SUMO moves, whose halts it serves

  // what SUMO is told
  std::vector<SumoPose> vehicle_poses_, person_poses_;
  std::map<std::string, std::pair<AgentId, Vec2>> written_;  ///< watched ghosts: what was sent
  PointSpeeds speeds_;  ///< of the reference points of those whom we drive
  SpatialGrid ghosts_;  ///< everybody's places; whoever needs it rebuilds it
  LoopDetectors detectors_;

  // the road as SUMO has it
  std::vector<SignalId> signal_order_;  ///< of the back end's list
  std::vector<LinkPiece> link_pieces_;  ///< by LaneId
  ChangingLimits limits_;

  // routes
  std::vector<bool> at_rerouter_;  ///< by EdgeId; empty: there are none
  std::vector<AgentId> shown_;     ///< to rerouters, in the last step
  EdgeSpeeds edge_speeds_;
  bool has_rerouting_ = false;
  double next_look_ = 0;  ///< of rerouting devices at travel times [s]

  // whose an agent is
  std::vector<Vec2> centers_;  ///< of the circles of rules; not finite where there is none now
  double next_wishes_ = 0;     ///< when other clients' wishes are read again [s]
};

}  // namespace sumogamma
