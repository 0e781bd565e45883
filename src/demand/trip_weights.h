#pragma once

#include <string>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

struct RoutedTrip {
  std::vector<std::string> edges;
  std::vector<std::vector<ConnectionId>>
      steps;            ///< from each edge to the next: the ways that the type may take, one a lane
  double length = 0;    ///< [m]
  double duration = 0;  ///< [s] on the empty road
  std::vector<double> times;  ///< of the duration, by edge, with what is lost before it [s]
  double inside = 0;          ///< of the duration, within the window where there is one [s]
  double weight = 1;          ///< how often it is driven, beside others of its type
};

/// One type's trips while they are weighed.
struct TripPool {
  double agents = 0;     ///< alive
  double slowness = 1;   ///< mean duration over that on the empty road
  double car_units = 1;  ///< of one vehicle, in a queue
  bool fixed = false;    ///< its trips are asked for so often each, their weights stay
  std::vector<RoutedTrip> trips;
};

double total_weight(const TripPool& pool);
/// Means over a pool by weight [m], [s].
double mean_length(const TripPool& pool);
double mean_duration(const TripPool& pool);
double mean_inside(const TripPool& pool);

/// The lane that is asked for most of what it carries.
struct BusiestLane {
  LaneId lane = kNoLane;
  double load = 0;
};

/// Weighs trips so that no lane is asked for more than it carries, as far as that can be with so
/// many agents alive: trips over full lanes come less often, others more. Long and short ones keep
/// their shares: short trips over one road would carry any number of agents. Returns the busiest
/// lane that is left.
BusiestLane weigh_trips(const RoadNetwork& road, std::vector<TripPool>& pools);

/// The busiest lane of trips as they are weighed. `load`: of the lanes, as far as it is known;
/// drivers prefer the lane that is less full.
BusiestLane busiest_lane(const RoadNetwork& road, const std::vector<TripPool>& pools,
                         std::vector<double> load = {});

}  // namespace sumogamma
