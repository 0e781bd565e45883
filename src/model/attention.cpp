#include "model/attention.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

// approach that is always reckoned with, whatever the velocities say now [m/s]
constexpr double kSideStep = 0.3;

/// Largest distance between the positions at which `agent` attends to `other` at `offset` from it.
double reach_towards(const AgentGeometry& agent, const AgentGeometry& other,
                     const AttentionRange& range, const Vec2& offset) {
  const double own = agent.forward.dot(offset) >= 0 ? range.front + agent.stopping : range.rear;
  // who comes this way is seen from as far as it needs to stop
  const double theirs = other.forward.dot(offset) < 0 ? other.stopping : 0.0;
  return own + theirs + agent.radius + other.radius;
}

}  // namespace

bool attends(const AgentGeometry& agent, const AgentGeometry& other, const AttentionRange& range) {
  const Vec2 offset = other.position - agent.position;
  const double reach = reach_towards(agent, other, range, offset);
  return offset.squaredNorm() <= reach * reach;
}

void find_neighbours(const TickGeometry& geometry, std::size_t row, const AttentionRange& range,
                     const Vec2& preferred, double horizon, Neighbours& neighbours) {
  neighbours.attended.clear();
  neighbours.near.clear();
  const AgentGeometry& own = geometry.agent[row];
  const double seen = std::max({range.front + own.stopping, range.rear, 0.0}) + own.radius;
  const double own_far = std::max(seen, own.next_reach);
  geometry.grid.visit_within(
      own.position, own_far + geometry.largest_far, [&](std::uint32_t other_row, double square) {
        if (other_row == row) return;
        const AgentGeometry& other = geometry.agent[other_row];
        const double far = own_far + other.far;
        if (square > far * far) return;
        // above or below on a bridge: never met
        if (std::abs(other.height - own.height) > kStorey) return;
        const double near = own.next_reach + other.next_reach;
        if (square <= near * near) neighbours.near.push_back(other_row);
        const Vec2 offset = other.position - own.position;
        const double reach = reach_towards(own, other, range, offset);
        if (square > reach * reach) return;
        // out of reach within the horizon: gap > horizon * approach, both times the distance
        const double distance = std::sqrt(square);
        const double gap = distance - own.radius - other.radius;
        const double approach =
            std::max(own.velocity.dot(offset), preferred.dot(offset)) - other.velocity.dot(offset);
        if (gap > 0 && gap * distance > horizon * (approach + kSideStep * distance)) return;
        neighbours.attended.push_back({other_row, distance});
      });
  // in order of id, so that nothing depends on where the grid's cells happen to lie
  std::sort(neighbours.attended.begin(), neighbours.attended.end(),
            [](const Attended& a, const Attended& b) { return a.row < b.row; });
}

}  // namespace sumogamma
