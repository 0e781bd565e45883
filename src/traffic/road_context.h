#pragma once

#include "traffic/traffic_tick.h"

namespace sumogamma {

/// Fills scene.context of every agent with a path from the frozen scene: where it is, who is ahead,
/// which rules bind at the next links. Two passes: approaches first, then each row by itself, in
/// parallel. tick.dt turns a comfortable acceleration into the most speed allowed at the next tick.
void update_road_contexts(const TrafficTick& tick);

}  // namespace sumogamma
