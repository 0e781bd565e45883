#pragma once

#include "scene/scene.h"
#include "traffic/traffic_state.h"

namespace sumogamma {

/// Counts once a tick, after everybody has moved, for how long a row has not got on, and notes when
/// it stood. On foot a step forward and back doesn't take the wait back to its beginning, six
/// seconds of walking take a minute. dt [s].
void count_waiting(double dt, Kinematics kinematics, const Scene& scene, TrafficState& traffic,
                   std::size_t row);

}  // namespace sumogamma
