#pragma once

#include <cstdint>
#include <vector>

#include "geometry/half_plane.h"

namespace sumogamma {

/// Which rule a half-plane comes from: what a replay draws and a failing test prints.
enum class ConstraintKind : std::uint8_t {
  Kinematic,     ///< K
  Neighbour,     ///< G, another agent
  Obstacle,      ///< C, a solid thing
  LaneBoundary,  ///< C, edge of the room that rules leave
  Direction,     ///< C, against the direction of travel
  RoadLimit,     ///< C, leader, signal, yield, stop: see RoadContext::reason
};

struct ConstraintSource {
  ConstraintKind kind = ConstraintKind::Kinematic;
  std::int64_t foe =
      -1;  ///< id of the other agent, or index of the obstacle; -1 where there is none
};

/// Half-planes in velocity space [m/s], the hard ones (K and C) first, then G.
struct ConstraintSet {
  std::vector<HalfPlane> planes;
  std::vector<ConstraintSource> sources;
  std::size_t hard_count = 0;

  void clear() {
    planes.clear();
    sources.clear();
    hard_count = 0;
  }
  void append(const HalfPlane& plane, const ConstraintSource& source) {
    planes.push_back(plane);
    sources.push_back(source);
  }
};

}  // namespace sumogamma
