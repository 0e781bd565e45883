#pragma once

#include <algorithm>

#include "traffic/perception.h"

namespace sumogamma {

/// How much faster than somebody a narrow vehicle goes by at most [m/s] with `clearance` [m]
/// between their sides: 0 where that is too little to go by at all.
double filtering_speed(const TrafficParameters& parameters, double clearance);

/// How somebody is passed.
struct Manner {
  double clear = 0;     ///< far enough aside [m]
  double sideways = 0;  ///< how fast the vehicle gets aside [m/s]
  double closes = 0;    ///< of the way to where it has to be aside, in a second
};

/// Between queues.
Manner filtering_manner(const TrafficParameters& parameters);
/// Over the middle of the road.
Manner overtaking_manner(const TrafficParameters& parameters);

/// Somebody whom a vehicle means to pass.
struct Passed {
  double gap = 0;      ///< way ahead [m], negative beside
  double now = 0;      ///< clear between the sides as the vehicle is [m]
  double meant = 0;    ///< likewise where it means to be [m]
  double turned = 0;   ///< its heading to the side on which it passes, a sine
  double speed = 0;    ///< of the other [m/s]
  bool taken = false;  ///< somebody is beside the vehicle where it means to be
  Manner manner = {};

  /// How far the vehicle still has to move over before it is beside [m].
  double aside() const { return std::min(meant, manner.clear) - now; }
};

/// The most speed at which a narrow vehicle goes by [m/s]. Ways aside are made at a slow walk: so
/// who comes near without being clear gets slow, and turns out as tightly as its wheels let it.
double passing_speed(const TrafficParameters& parameters, const Passed& passed,
                     const AgentType& type);

/// Does a wide vehicle, its middle `offset` [m] from a path on `lane`, stand beside that lane and
/// neither wait to get into it nor be on its way there, so that a wide vehicle, too, may pass what
/// of its body is in there?
bool stands_beside_lane(const TrafficView& view, std::size_t other, LaneId lane, double offset);

/// Where beside its path an agent on wheels should be [m, positive left]: where it likes to be, or
/// far enough aside to pass somebody slow with a gap, where the room of its own direction allows
/// it, and over the middle of the road where it may overtake there (TrafficState::overtaking_room).
/// Wide vehicles pass narrow ones on the inner side, and within their lane who stands beside it
/// with its tail in there; narrow ones pass anybody, on either side, and between two queues in the
/// middle of what is free.
double passing_offset(const TrafficView& view, const Path& path, const Surroundings& around,
                      std::size_t row);

}  // namespace sumogamma
