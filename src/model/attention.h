#pragma once

#include <cstdint>
#include <vector>

#include "model/tick_geometry.h"

namespace sumogamma {

/// Approach that is always reckoned with, whatever the velocities say now [m/s].
inline constexpr double kSideStep = 0.3;

/// A neighbour that Att admits.
struct Attended {
  std::uint32_t row = 0;
  double distance = 0;  ///< between the positions [m]
};

/// True where `agent` attends to `other` (III-B): it lies within the half disc of `range` on its
/// side, each reach taken from outline to outline and lengthened by the way that both need to stop
/// where they close in.
bool attends(const AgentGeometry& agent, const AgentGeometry& other, const AttentionRange& range);

/// Who matters to one row.
struct Neighbours {
  std::vector<Attended> attended;  ///< Att, in order of id
  std::vector<std::uint32_t>
      near;  ///< rows that it could touch before both stand: the stopping guard's concern
  std::vector<std::uint32_t> found;  ///< scratch of the search
};

/// Att of III-B for one row, and those that are near.
/// Left out of Att are neighbours whose half-plane can't bind: those that the row can't touch
/// within `horizon` [s] even at the faster of its present and its `preferred` approach, and a
/// sidestep more.
void find_neighbours(const RoadNetwork& network, const TickGeometry& geometry, std::size_t row,
                     const AttentionRange& range, const Vec2& preferred, double horizon,
                     Neighbours& neighbours);

}  // namespace sumogamma
