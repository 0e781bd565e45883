#pragma once

#include <vector>

#include "scene/scene.h"

namespace sumogamma {

/// Speeds as SUMO means them: of an agent's reference point (a vehicle's front bumper, which in a
/// bend moves faster than its rear axle), over the last tick.
class PointSpeeds {
 public:
  /// Speed of a row whose reference point is at `point` now [m/s]; to be asked once a tick. Where
  /// it wasn't asked for a tick ago: that of the footprint's centre.
  double update(const Scene& scene, std::size_t row, const Vec2& point, double dt) {
    const std::size_t agent = scene.id[row].value;
    if (agent >= last_.size()) last_.resize(agent + 1);
    Last& last = last_[agent];
    const double speed =
        last.tick + 1 == scene.tick ? (point - last.point).norm() / dt : scene.velocity[row].norm();
    last = {scene.tick, point};
    return speed;
  }

 private:
  struct Last {
    std::int64_t tick = -2;
    Vec2 point = Vec2::Zero();
  };
  std::vector<Last> last_;  ///< by AgentId
};

}  // namespace sumogamma
