#pragma once

#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Opens the places where a line turns round within less than two turning radii into bulbs: the
/// body swings out to its outer side, comes round on a circle that ends where the line's tip is,
/// and swings back in. So drivers turn in a street: who turns from the middle of the lane, as
/// networks draw it, leaves the road on its far side.
///
///        tip
///       _____
///      /     \       the circle
///      \     /
///       ) | (        both arcs that lead into it and out of it; | the line's two branches
///        | |
///
/// `samples` [m] lie `step` [m] apart and keep their number. Places without enough straight line on
/// both sides stay as they are. Whether anything was drawn anew.
bool open_turnarounds(double step, double turning_radius, std::vector<Vec2>& samples);

}  // namespace sumogamma
