#pragma once

#include "traffic/perception.h"

namespace sumogamma {

/// Room beyond the inner boundary of its own direction that a wide vehicle may use now to overtake
/// somebody slow and narrow [m]: the width of the opposite lane, where the network says that there
/// is one (Lane::opposite), and 0 where it may not. It may while it gets past and back
/// - on its lane, straight on and before the next junction or the end of its path;
/// - into a gap as long as itself ahead of whoever it overtakes;
/// - seconds before it would meet anybody who comes, whether seen within the sight distance or just
///   beyond it, and before anybody faster comes from behind.
/// Who has begun gives up only where somebody would be met. Looks around again, far ahead: `far` is
/// scratch.
double overtaking_room(const TrafficView& view, const Surroundings& around, std::size_t row,
                       Surroundings& far);

}  // namespace sumogamma
