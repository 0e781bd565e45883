#pragma once

#include <vector>

#include "road/path.h"

namespace sumogamma {

/// Draws the line straight where it turns back on itself and on again, as between the ends of lanes
/// that overlap: nobody drives to the tip and back. What turns round for good stays, but narrow
/// vehicles turn where the way back is far enough away for that, not at the tip of an acute angle.
/// Whether anything was drawn anew: samples lie closer to each other there.
bool straighten_folds(double step, const Cornering& cornering, std::vector<Vec2>& samples);

}  // namespace sumogamma
