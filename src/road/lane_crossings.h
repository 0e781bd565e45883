#pragma once

#include "base/parallel.h"
#include "road/road_network.h"

namespace sumogamma {

/// Ground that differs by less is never taken for another storey, whatever the lanes do [m].
inline constexpr double kLeastStorey = 1.5;

/// No road climbs a storey within this [m].
inline constexpr double kJoined = 40.0;

/// Is anything there above anything else?
bool has_storeys(const RoadNetwork& network);

/// Has OpenStreetMap's map different layers for two lanes? Heights don't tell it everywhere:
/// netconvert 1.15 gives them to a road's ends only, so that a tunnel between two bridges lies as
/// high as they do.
inline bool layers_differ(const RoadNetwork& network, LaneId a, LaneId b) {
  return network.has_layers && a != kNoLane && b != kNoLane &&
         network.lane(a).layer != network.lane(b).layer;
}

/// Fills Lane::crossings and Junction::neighbours, from which it is told who is above whom (see
/// scene/storey.h); empty where the network has no storeys. Lanes reach 1 m beyond their ends for
/// it, as there may be a gap between one and the next. Expects layers, elevations and overpasses.
void find_lane_crossings(RoadNetwork& network, Workers& workers);
inline void find_lane_crossings(RoadNetwork& network) {
  Workers alone;
  find_lane_crossings(network, alone);
}

/// The crossing of a lane with another; nullptr where their centerlines don't cross.
const LaneCrossing* crossing_with(const Lane& lane, LaneId other);

}  // namespace sumogamma
