#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// How long a bus halts at a stop, at least: as SUMO's ptlines2flows.py [s].
inline constexpr double kDwell = 20.0;

/// From where people on foot reach a stop whose own road nobody walks along.
struct StopAccess {
  LaneId lane = kNoLane;
  double along = 0;  ///< as SUMO counts positions [m]
};

/// A place on a lane where buses halt.
struct BusStop {
  std::string id, name;
  LaneId lane = kNoLane;
  double begin = 0, end = 0;         ///< on the lane, as SUMO counts positions [m]
  std::optional<StopAccess> access;  ///< none: people walk along the stop's own edge, or nowhere
};

/// A stop that a line serves.
struct ServedStop {
  std::size_t stop = 0;  ///< row of PublicTransport::stops
  std::size_t edge = 0;  ///< row of the route that it lies on
};

/// A stretch of a line that lies in the network, in one direction.
struct LinePart {
  std::string id;      ///< "2207095.0": OpenStreetMap's relation, and which part of it
  std::string line;    ///< what is written on the bus; two directions may share it
  std::string kind;    ///< OpenStreetMap's route: "bus", "trolleybus", ...
  double headway = 0;  ///< [s]; 0: the map doesn't say
  std::vector<EdgeId> route;
  std::vector<ServedStop> stops;  ///< in the order of travel
};

/// Lines and stops of a place: facts of it, as the network is one.
struct PublicTransport {
  std::vector<BusStop> stops;
  std::vector<LinePart> parts;
};

}  // namespace sumogamma
