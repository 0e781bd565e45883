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

#include "model/model.h"
#include "road/lane_locator.h"
#include "scene/point_speeds.h"
#include "scene/trip.h"
#include "simulation/world.h"
#include "sumo/backend.h"
#include "sumo/edge_speeds.h"
#include "sumo/vehicle_types.h"

namespace sumogamma {

/// Which agents GAMMA takes over.
struct ControlChoice {
  bool all = true;              ///< everyone that can be driven
  std::set<std::string> names;  ///< else: agent types ("car"), SUMO's vTypes or ids; empty: none
  bool has_region = false;      ///< only inside the box below
  Vec2 region_low = Vec2::Zero(), region_high = Vec2::Zero();

  bool any() const { return all || !names.empty() || has_region; }
};

/// Options of a run in SUMO.
struct SumoWorldOptions {
  ControlChoice control;
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
      left_to_sumo;               ///< not driven by us although asked for, by reason
  std::int64_t stops_served = 0;  ///< planned halts of agents that we drive
  std::int64_t rides = 0;         ///< times that somebody boarded a vehicle
  std::size_t waiting = 0;        ///< departed in SUMO, waiting for room here
};

/// What SUMO reported against what was written.
struct CouplingCheck {
  std::function<void(const Vec2& written, const Vec2& reported)>
      compare;  ///< called for each pose read back
  int teleports = 0, emergency_stops = 0, sumo_collisions = 0;
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
    std::shared_ptr<const Path> path;                  ///< from the lane that SUMO chose
    std::vector<std::shared_ptr<const Path>> besides;  ///< from the lanes beside it, once needed
    bool looked_besides = false;
    bool resumes = false;   ///< SUMO has it for a while: ours as soon as it moves on
    bool off_lane = false;  ///< SUMO has been told that it waits
    /// Parked: where SUMO shows its front, and its angle [deg]; others wait off the map.
    Vec2 waits_at = Vec2::Constant(std::nan(""));
    double waiting_angle = 0;
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
    bool speed_held = false;   ///< SUMO-driven: we hold its speed behind a ghost
    bool resumes = false;      ///< as Pending::resumes
    bool keeps_place = false;  ///< it waits where it walked to, not where SUMO shows it
    double length = 0;         ///< 0 for persons, whose reference point is their centre [m]
    int stages_left = 0;       ///< persons that SUMO moves
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
  bool is_out_of_sight(const SumoAgent& seen, double length) const;
  void leave_sight(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                   RoadState& road, std::vector<bool>& removed);
  void watch_absent(const SumoAgent& seen);
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
  void hold_followers(const Scene& scene);
  bool wants_control(const SumoAgentDetails& details, AgentTypeId type) const;
  bool insert(Pending& pending, Scene& scene, RoadState& road);
  bool insert_on(const Pending& pending, const std::shared_ptr<const Path>& path, Scene& scene,
                 RoadState& road);
  /// The agent as it would stand at the start of `path`.
  AgentState newcomer(const Pending& pending, const Path& path, AgentId id) const;
  AgentId register_agent(const SumoAgentDetails& details, bool external, AgentTypeId type);
  void record_arrival(const Traveller& traveller);
  void forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
              std::size_t row);
  void compare_poses();
  void read_detectors();
  void feed_detectors(const Scene& scene);
  bool in_region(const Vec2& position) const;
  void take_over(AgentId id, Scene& scene, std::size_t row);

  const Model& model_;
  LaneLocator locator_;
  SumoBackend& backend_;
  SumoWorldOptions options_;
  VehicleTypeRows rows_;
  SumoStep step_;
  LifeCycle life_cycle_;
  CouplingCheck coupling_;
  std::deque<Pending> pending_;
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
  PointSpeeds speeds_;  ///< of the reference points of those whom we drive
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
