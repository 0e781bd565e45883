#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// A vehicle, as far as outputs have to know it.
struct OutputVehicle {
  std::string name;                ///< SUMO's id
  std::string type;                ///< SUMO's vType
  double length = 0, min_gap = 0;  ///< [m]
  double max_speed = 0;            ///< [m/s]
  double speed_factor = 1;         ///< of the lanes' limits
};

/// Where a vehicle is at the end of a step, as SUMO counts.
struct VehiclePlace {
  std::uint32_t vehicle = 0;  ///< index of its OutputVehicle
  LaneId lane = kNoLane;      ///< of its front; kNoLane off all of them (parked beside the road)
  double front = 0;           ///< along that lane [m]
  double speed = 0;           ///< [m/s]
  double speed_limit = 0;     ///< of that lane now [m/s]
  bool stopped = false;       ///< at a stop of its plan
};

/// How a vehicle comes onto a lane.
enum class LaneEntry : std::uint8_t {
  None,        ///< it was there
  Departed,    ///< its trip begins
  Junction,    ///< its front drives on from the lane before
  LaneChange,  ///< from beside
  Placed,      ///< from off the road
};

/// How it leaves one. What its tail still covers isn't left by Junction, LaneExit only tells of the
/// front.
enum class LaneExit : std::uint8_t { None, Junction, LaneChange, Arrived, Taken };

/// What a vehicle did on one lane in one step. Its front may be before the lane's begin or beyond
/// its end: the tail counts.
struct LanePassage {
  std::uint32_t vehicle = 0;
  LaneId lane = kNoLane;
  double from = 0, to = 0;         ///< of the front along the lane, as SUMO counts [m]
  double begin = 0, duration = 0;  ///< [s]; no duration: only the entry or exit is told
  double speed = 0;                ///< [m/s]
  double free_speed = 0;           ///< that its limits allow where its front is [m/s]
  bool stopped = false;
  LaneEntry entry = LaneEntry::None;
  LaneExit exit = LaneExit::None;

  /// When the front, or with an offset of the vehicle's length its back, passes a place at even
  /// speed, counted from `begin` [s]. Precondition: it passes it in this step.
  double passing_time(double place, double offset = 0) const {
    return to > from ? duration * (place + offset - from) / (to - from) : 0.0;
  }
};

/// How far a vehicle has come, and what it lost, since it departed.
struct TripOdometer {
  double distance = 0;      ///< of its front [m]
  double time_loss = 0;     ///< against its free speed, stops left out [s]
  double waiting_time = 0;  ///< at 0.1 m/s or less, stops left out [s]
  double stop_time = 0;     ///< [s]
  int waiting_count = 0;
  bool waits = false;
};

/// Turns places at the ends of steps into passages of lanes, for whoever drives the vehicles:
/// outputs are made from these alone.
class LanePassages {
 public:
  /// `network` outlives it. `step`: length of a step [s].
  LanePassages(const RoadNetwork& network, double step) : network_(network), step_(step) {}

  /// Drops the passages of the last step; the next one begins at this time [s].
  void begin_step(double begin);
  /// A vehicle at the end of the step. Whoever wasn't there in the step before has departed, unless
  /// its `vehicle` was: then it comes back onto the road.
  void move(const OutputVehicle& vehicle, const VehiclePlace& place);
  /// A vehicle that isn't on the road at the step's end: it has `arrived`, on which it has driven
  /// on at its last speed for a step, or it was taken off, for good or for a while.
  void end(const OutputVehicle& vehicle, std::uint32_t index, bool arrived);

  /// No further vehicle comes in this step: puts the passages in order of lanes.
  void end_step();

  /// Of the step, by lane; those of one lane in the order in which they were made.
  std::span<const LanePassage> passages() const { return passages_; }
  /// Those of one lane. Precondition: the step was ended.
  std::span<const LanePassage> passages_on(LaneId lane) const;
  /// Has it ever been on the road? The others ask for such alone.
  bool has_departed(std::uint32_t vehicle) const {
    return vehicle < states_.size() && states_[vehicle].departed;
  }
  const TripOdometer& odometer(std::uint32_t vehicle) const { return states_[vehicle].odometer; }
  /// Where it was last.
  const VehiclePlace& last_place(std::uint32_t vehicle) const { return states_[vehicle].place; }
  /// Where a vehicle's trip began.
  const VehiclePlace& first_place(std::uint32_t vehicle) const { return states_[vehicle].first; }

 private:
  struct Covered {
    LaneId lane;
    double start;  ///< odometer of the vehicle where this lane begins [m]
  };
  struct State {
    bool departed = false, on_road = false;
    VehiclePlace place, first;
    double at = 0;                 ///< end of the step in which it was seen last [s]
    double front = 0;              ///< odometer of the front, lanes' lengths added up [m]
    std::vector<Covered> covered;  ///< lanes that it is on, from back to front
    TripOdometer odometer;
  };

  void begin_trip(const OutputVehicle& vehicle, const VehiclePlace& place, State& state);
  void drive(const OutputVehicle& vehicle, const VehiclePlace& place, State& state);
  void advance(const OutputVehicle& vehicle, const VehiclePlace& place, double way, State& state,
               std::size_t entered);
  void add_up(const OutputVehicle& vehicle, const VehiclePlace& place, double way,
              State& state) const;
  void change_lane(const LanePassage& like, LaneId to, State& state);
  LanePassage passage(const OutputVehicle& vehicle, const VehiclePlace& place) const;
  std::vector<LaneId> way_to(LaneId from, EdgeId edge, LaneId preferred) const;

  const RoadNetwork& network_;
  double step_, begin_ = 0;  ///< [s]
  std::vector<State> states_;
  std::vector<LanePassage> passages_;
};

}  // namespace sumogamma
