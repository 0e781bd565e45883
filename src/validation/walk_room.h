#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "geometry/vec2.h"
#include "scene/scene.h"

namespace sumogamma {

/// A line that people walk through from its left to its right: a door, or the end of the way.
struct Gate {
  Vec2 from, to;  ///< [m]
};

struct Walker {
  Vec2 position;            ///< [m]
  double speed = 1.34;      ///< that it likes to walk [m/s]
  std::vector<Gate> gates;  ///< in order; behind the last one it has left
  double starts_at = 0;     ///< [s]
};

/// People between walls.
struct Room {
  std::vector<std::vector<Vec2>> walls;  ///< open chains [m]
  std::vector<Walker> walkers;
  double period = 0;  ///< the ground is repeated every so many metres along x; 0: it isn't
};

/// What became of one walker.
struct Walked {
  double started = -1;         ///< when it set off [s]; negative: never
  std::vector<double> passed;  ///< when it went through its gates [s], as far as it came
};

/// Called after every step with the time [s]. The first rows are the walkers that are still there;
/// of a repeated ground their copies follow.
using RoomObserver = std::function<void(double time, const Scene& scene, std::size_t walkers)>;

/// Lets everybody walk for `duration` [s] by the model alone (Eq. 7, guard), without rules of the
/// road, in steps of 0.05 s; of each what became of it. Somebody who has passed its last gate is
/// taken out; without gates it walks towards +x.
std::vector<Walked> walk(const Room& room, double duration, Workers& workers,
                         const RoomObserver& observe = {});

}  // namespace sumogamma
