#pragma once

#include <vector>

#include "osm/repairs/road_bodies.h"

namespace sumogamma::osm {

/// How far the edges of a body move beside it, by point of its line [m to the left of the line].
struct BendRoom {
  std::vector<double> edge, twin;
};

/// Room between the two directions of a road in its sharp bends, those of less than 25 m. Long
/// bodies sweep more than their lane there: the nose of one whose rear axle keeps to a circle of
/// radius R reaches L^2 / 2R further out, with L from the rear axle to the nose (8.7 m for a bus of
/// 12 m). Roads are built wider by that, after the same rule; netconvert draws lanes of one width
/// throughout, one direction beside the other. So the direction at the outside of the bend moves
/// outwards, 2.5 m at the most; room comes and goes at 1 m in 6 m, and none is left where lanes
/// end. Nothing moves where the body has no twin.
BendRoom room_in_bends(const RoadBody& body, bool left_hand);

}  // namespace sumogamma::osm
