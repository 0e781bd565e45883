#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "traffic/junction/arbitration.h"
#include "traffic/lateral/course.h"
#include "traffic/longitudinal/leader.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

/// Something on its path that a driver has to stop before, or to follow: a virtual leader.
struct StopPoint {
  double gap = std::numeric_limits<double>::infinity();           ///< from the own front to it [m]
  double speed = 0;                                               ///< of it along the path [m/s]
  double headway_factor = 1;                                      ///< on the type's headway
  double most_braking = std::numeric_limits<double>::infinity();  ///< for it [m/s^2]
  LimitReason reason = LimitReason::None;
  std::int64_t foe = -1;                              ///< id, -1 where it is nobody
  std::optional<double> acceleration = std::nullopt;  ///< of a foe that drives ahead [m/s^2]
};

/// What a rule looks at: one driver at this instant.
struct Driver {
  const TrafficView& view;
  const Course& course;
  double front = 0;       ///< along its path [m]
  Traveller traveller;    ///< before links, where its front may count as further ahead than it is:
                          ///< it halts a little earlier where it reaches over its lane's edge
  double free_speed = 0;  ///< that road, bend and type let it drive [m/s]
  double reach = 0;       ///< as far as it looks ahead [m]
};

/// How far a driver looks ahead [m].
double driver_reach(const AgentType& type, double speed);

Driver driver_of(const TrafficView& view, const Course& course, double free_speed);

/// What the rules found for one driver.
struct StopPoints {
  std::vector<StopPoint> points;
  DrivingAhead ahead;                                        ///< who drives on its path
  double to_halt = std::numeric_limits<double>::infinity();  ///< see RoadContext
  bool at_red = false;                                       ///< likewise
};

/// Asks all rules of the road, each for what the driver has to stop for or to follow; what `found`
/// held before is forgotten.
void find_stop_points(const Driver& driver, StopPoints& found);

/// Most acceleration that a stop point leaves [m/s^2]: the Intelligent Driver Model behind it.
double acceleration_behind(const Driver& driver, const StopPoint& point);

}  // namespace sumogamma
