#include "model/attention.h"

#include <algorithm>

namespace sumogamma {

namespace {

// approach speed that is always reckoned with, whatever the velocities say now [m/s]
constexpr double kSideStep = 1.0;

double reach_towards(const TickGeometry& geometry, std::size_t row, std::size_t other,
                     const AttentionRange& range, const Vec2& offset) {
  const bool ahead = geometry.forward[row].dot(offset) >= 0;
  const double own = ahead ? range.front + geometry.stopping[row] : range.rear;
  // who comes towards this agent is seen from as far as it needs to stop
  const bool approaching = geometry.forward[other].dot(offset) < 0;
  return own + (approaching ? geometry.stopping[other] : 0.0) + geometry.radius[row] +
         geometry.radius[other];
}

}  // namespace

bool attends(const TickGeometry& geometry, const Scene& scene, std::size_t row, std::size_t other,
             const AttentionRange& range) {
  const Vec2 offset = scene.position[other] - scene.position[row];
  const double reach = reach_towards(geometry, row, other, range, offset);
  return offset.squaredNorm() <= reach * reach;
}

void find_attended(const Scene& scene, const TickGeometry& geometry, std::size_t row,
                   const AttentionRange& range, const Vec2& preferred, double horizon,
                   std::vector<Attended>& attended) {
  attended.clear();
  const Vec2 &position = scene.position[row], &velocity = scene.velocity[row];
  const double radius = std::max(range.front + geometry.stopping[row], range.rear) +
                        geometry.longest_stopping + geometry.radius[row] + geometry.largest_radius;
  geometry.grid.visit_within(position, radius, [&](std::uint32_t other, double square) {
    if (other == row) return;
    const Vec2 offset = scene.position[other] - position;
    const double reach = reach_towards(geometry, row, other, range, offset);
    if (square > reach * reach) return;
    // not to be reached within the horizon: gap > horizon * approach, without the division by the
    // distance
    const double distance = std::sqrt(square);
    const double gap = distance - geometry.radius[row] - geometry.radius[other];
    const double approach = std::max(velocity.dot(offset), preferred.dot(offset)) -
                            scene.velocity[other].dot(offset) + kSideStep * distance;
    if (gap * distance > horizon * approach && gap > 0) return;
    attended.push_back({other, distance});
  });
}

}  // namespace sumogamma
