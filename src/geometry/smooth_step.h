#pragma once

namespace sumogamma {

/// From 0 at 0 to 1 at 1, level at both: so a path moves over to the lane beside.
inline double smooth_step(double t) { return t * t * (3.0 - 2.0 * t); }

}  // namespace sumogamma
