#pragma once

#include <vector>

#include "road/conflict_zones.h"

namespace sumogamma {

/// Bodies by what they sweep beside their lane where they turn.
enum class TurningBody { Car, Truck, Bus };

constexpr TurningBody turning_body(double length) {
  constexpr double kTruck = 6.5;  // [m]
  if (length > kLongBody) return TurningBody::Bus;
  return length > kTruck ? TurningBody::Truck : TurningBody::Car;
}

/// Where a truck or bus that takes one link sweeps over the way of another link, though it be the
/// end of the lane on which others wait. Distances [m] from where the links begin; negative before
/// that. On the way of the body that sweeps they are the places of its front when it begins to and
/// of its rear when it has done, which may lie before the former.
struct SweptWay {
  ConnectionId foe = kNoConnection;
  double begin = 0, end = 0;            ///< on this link's way
  double foe_begin = 0, foe_end = 0;    ///< on the foe's
  TurningBody body = TurningBody::Bus;  ///< who sweeps
  bool foe_sweeps = false;  ///< the foe's body does the sweeping, on this link's way; else this
                            ///< link's does, on the foe's
  bool for_wide = false;    ///< holds if who is in the way is wider than kWideBody, else if not
};

/// By connection: the ways of a junction that a truck or a bus which takes it sweeps, and those of
/// them that sweep its own, as far as the conflict zones don't tell it already. Each is rolled
/// along each link that bends, corners rounded.
using SweptWayTable = std::vector<std::vector<SweptWay>>;
SweptWayTable find_swept_ways(const RoadNetwork& network, const ConflictTable& conflicts,
                              Workers& workers);
inline SweptWayTable find_swept_ways(const RoadNetwork& network, const ConflictTable& conflicts) {
  Workers alone;
  return find_swept_ways(network, conflicts, alone);
}

}  // namespace sumogamma
