#pragma once

#include <cmath>
#include <cstddef>

#include "road/lane_crossings.h"
#include "road/road_network.h"
#include "scene/scene.h"

namespace sumogamma {

/// A place on the network and how high the ground is there.
struct Ground {
  LaneId lane = kNoLane;
  double along = 0;   ///< the lane's centerline [m]
  double height = 0;  ///< [m]
};

inline Ground ground_of(const Scene& scene, std::size_t row) {
  return {scene.lane[row].lane, scene.lane[row].along, scene.height[row]};
}

/// Ground that differs by more is on another storey, unless the road joins it [m].
inline constexpr double kStorey = 2.5;

/// Do the roads of both lanes cross some road above or below (find_overpasses())?
inline bool have_overpasses(const RoadNetwork& network, LaneId a, LaneId b) {
  return !network.overpasses.empty() && a != kNoLane && b != kNoLane &&
         network.lane(a).has_overpass && network.lane(b).has_overpass;
}

/// on_other_storey() for ground that differs by more than kLeastStorey or in its layer, or of roads
/// that have overpasses.
bool lies_above_or_below(const RoadNetwork& network, const Ground& a, const Ground& b);

/// Are two places above one another, on a bridge and under it? Heights alone don't tell: at a
/// junction netconvert may join lanes whose heights differ by metres, and a ramp crosses a tunnel
/// where it has hardly begun to rise. So near a place where roads cross with no junction those are
/// on two storeys that have less way to it than by road to each other; others that a few metres of
/// road join are on one; others are not if their ground differs by more than kStorey; where their
/// lanes cross, or those that they lead into or come from a few metres away, it's the ground at the
/// crossing that counts, by kLeastStorey, or their layers.
inline bool on_other_storey(const RoadNetwork& network, const Ground& a, const Ground& b) {
  return (std::abs(a.height - b.height) > kLeastStorey || layers_differ(network, a.lane, b.lane) ||
          have_overpasses(network, a.lane, b.lane)) &&
         lies_above_or_below(network, a, b);
}
inline bool on_other_storey(const RoadNetwork& network, const Scene& scene, std::size_t a,
                            std::size_t b) {
  return on_other_storey(network, ground_of(scene, a), ground_of(scene, b));
}

}  // namespace sumogamma
