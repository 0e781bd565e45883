#pragma once

#include <array>
#include <limits>

#include "traffic/traffic_view.h"

namespace sumogamma {

/// Way that somebody of this length [m] who waits long for a gap between lanes needs beside its
/// nose [m].
double nose_room(const TrafficParameters& parameters, double length);

/// What is next in the way on an agent's path.
struct Leader {
  double gap = std::numeric_limits<double>::infinity();  ///< free metres between own front and it,
                                                         ///< along the path
  double speed = 0;                                      ///< of it along the path there, >= 0 [m/s]
  double acceleration = 0;                               ///< of it along the path [m/s^2]
  double along = 0;                                      ///< of its rear on the path [m]
  std::int64_t id = -1;                                  ///< -1: free road
};

/// Those who drive ahead on an agent's path, in no order: all of them as far as `seen_to`, so long
/// as they fit.
struct DrivingAhead {
  struct Vehicle {
    double rear = 0, front = 0;  ///< along the path [m]
    double speed = 0;            ///< along the path, >= 0 [m/s]
    std::int64_t id = -1;
    std::size_t row = 0;
  };
  std::array<Vehicle, 40> vehicles;
  std::size_t count = 0;
  double seen_to = 0;       ///< along the path [m]
  Vehicle merging;          ///< the nearest that has to change into this agent's lane
  bool on_its_way = false;  ///< it has begun to; else it waits for a gap
  /// At which a narrow vehicle goes by those whom it passes, [m/s], and who that is.
  double passing_speed = std::numeric_limits<double>::infinity();
  std::int64_t passed = -1;
  /// Within which it has to be where it means to be beside its path [m].
  double turning_way = std::numeric_limits<double>::infinity();

  void add(const Vehicle& vehicle) {
    if (count < vehicles.size()) vehicles[count++] = vehicle;
  }
};

/// Nearest agent ahead whose footprint reaches into the corridor that the row's body will sweep
/// along its path, whoever drives it. Vehicles that don't move the same way don't count (right of
/// way and avoidance see to them), people on foot when near. `reach` is how far to look [m]. Adds
/// every vehicle ahead to `ahead`.
Leader find_leader(const TrafficView& view, std::size_t row, double reach, DrivingAhead& ahead);

/// Adds who drives on the row's way beyond what `ahead` holds, as far as `to` [m along its path].
void see_queue(const TrafficView& view, std::size_t row, double to, DrivingAhead& ahead);

}  // namespace sumogamma
