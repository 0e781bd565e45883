#pragma once

#include <cstddef>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma::osm {

/// Opens the hairpins of a line to bulbs, as hairpins are built: maps draw many as a V, whose inner
/// lane would end in a point. A hairpin is where the line turns by more than 120 degrees within
/// 10 m to either side of its tip. The tip stays; what is beside it moves away from the hairpin's
/// axis, until it lies on a circle of `bulb` [m] through the tip, and behind that on a neck that
/// narrows by 1 m in 4 m to each side. What is as wide already stays.
///
/// `points` [m] lie a metre or two apart; `radii` are by point, 0 for those that may not move.
std::vector<Vec2> open_hairpins(std::vector<Vec2> points, const std::vector<double>& radii,
                                double bulb);

}  // namespace sumogamma::osm
