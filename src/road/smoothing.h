#pragma once

#include "road/path.h"

namespace sumogamma {

/// Rounds the corners of a driving path: a box filter along it, as wide as the turning radius asks
/// for, or the length of a long body, so that a body which can't turn on the spot cuts a corner
/// like a driver does instead of overshooting it. Places along the path are carried over.
void round_corners(const Cornering& cornering, Path& path);

}  // namespace sumogamma
