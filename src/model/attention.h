#pragma once

#include <cstdint>
#include <vector>

#include "model/tick_geometry.h"

namespace sumogamma {

/// A neighbour that Att admits.
struct Attended {
  std::uint32_t row = 0;
  double distance = 0;  ///< between the centres [m]
};

/// True where `row` attends to `other` (III-B): within the half disc of `range` on the side where
/// it lies, each reach taken from outline to outline and lengthened by what both need to stop when
/// they close in.
bool attends(const TickGeometry& geometry, const Scene& scene, std::size_t row, std::size_t other,
             const AttentionRange& range);

/// Att of III-B for one row: fills `attended` in the grid's order (by cell, then id).
/// Left out are neighbours that `row` can't reach within `horizon` [s] at the larger of its own and
/// `preferred`'s approach speed and a margin: their half-planes could not bind.
void find_attended(const Scene& scene, const TickGeometry& geometry, std::size_t row,
                   const AttentionRange& range, const Vec2& preferred, double horizon,
                   std::vector<Attended>& attended);

}  // namespace sumogamma
