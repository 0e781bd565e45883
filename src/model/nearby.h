#pragma once

#include <vector>

#include "model/gamma_velocity.h"

namespace sumogamma {

/// All about one row that find_neighbours looks at and that is the same under every hypothesis of
/// its behaviour: who asks for many of them searches once.
struct Nearby {
  struct Agent {
    std::uint32_t row;
    bool ahead;                    ///< in the front half of who looks
    double stopping;               ///< of who comes this way, 0 for others [m]
    double radius;                 ///< [m]
    double distance, square, gap;  ///< between positions [m, m^2] and circles [m]
    double own_approach, flight;   ///< both velocities along the offset, times the distance
    Vec2 offset;                   ///< [m]
  };
  std::size_t row = 0;               ///< of who looks
  std::vector<Agent> agents;         ///< in order of id
  std::vector<std::uint32_t> found;  ///< scratch of the search
};

/// Everybody whom the row may attend to with a range of `farthest` or less.
void find_nearby(const RoadNetwork& network, const TickGeometry& geometry, std::size_t row,
                 const AttentionRange& farthest, Nearby& nearby);

/// Att as find_neighbours has it, of those. `own`: the row's; `range`: not beyond the farthest.
void attend_among(const Nearby& nearby, const AgentGeometry& own, const AttentionRange& range,
                  const Vec2& preferred, double horizon, std::vector<Attended>& attended);

/// gamma_velocity of the row that `nearby` was found for, bit by bit. Precondition: no guard.
Vec2 gamma_velocity_among(const Model& model, const Scene& scene, const TickGeometry& geometry,
                          const BehaviorState& behavior, const Nearby& nearby, Workspace& work);

}  // namespace sumogamma
