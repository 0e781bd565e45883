#include "model/attention.h"

#include <algorithm>
#include <cmath>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "model/nearby.h"

namespace sumogamma {

namespace {

/// Largest distance between the positions at which `agent` attends to `other` at `offset` from it.
double reach_towards(const AgentGeometry& agent, const AgentGeometry& other,
                     const AttentionRange& range, const Vec2& offset) {
  const double own = agent.forward.dot(offset) >= 0 ? range.front + agent.stopping : range.rear;
  // who comes this way is seen from as far as it needs to stop
  const double theirs = other.forward.dot(offset) < 0 ? other.stopping : 0.0;
  return own + theirs + agent.radius + other.radius;
}

/// Is somebody out of reach within the horizon? gap > horizon * approach, both times the distance.
bool stays_away(double gap, double distance, double approach, double horizon) {
  return gap > 0 && gap * distance > horizon * (approach + kSideStep * distance);
}

/// Looks at two entries of the grid at a time: most of those that a search passes are too far away.
class PairSearch {
 public:
  /// For somebody at `position` who sees as far as `far` [m].
  PairSearch(const TickGeometry& geometry, const Vec2& position, double far)
      : x_(geometry.x.data()), y_(geometry.y.data()), far_(geometry.far.data()) {
#ifdef __SSE2__
    own_x_ = _mm_set1_pd(position.x());
    own_y_ = _mm_set1_pd(position.y());
    own_far_ = _mm_set1_pd(far);
#else
    own_x_ = position.x();
    own_y_ = position.y();
    own_far_ = far;
#endif
  }

  /// Bits of the entries k and k + 1 that matter.
  unsigned within(std::uint32_t k) const {
#ifdef __SSE2__
    const __m128d dx = _mm_loadu_pd(x_ + k) - own_x_, dy = _mm_loadu_pd(y_ + k) - own_y_;
    const __m128d reach = _mm_loadu_pd(far_ + k) + own_far_;
    return static_cast<unsigned>(_mm_movemask_pd(_mm_cmple_pd(dx * dx + dy * dy, reach * reach)));
#else
    unsigned bits = 0;
    for (std::uint32_t m = 0; m < 2; ++m) {
      const double dx = x_[k + m] - own_x_, dy = y_[k + m] - own_y_, reach = far_[k + m] + own_far_;
      bits |= static_cast<unsigned>(dx * dx + dy * dy <= reach * reach) << m;
    }
    return bits;
#endif
  }

 private:
  const double *x_, *y_, *far_;
#ifdef __SSE2__
  __m128d own_x_, own_y_, own_far_;
#else
  double own_x_, own_y_, own_far_;
#endif
};

/// Rows that matter to somebody at `position` who sees as far as `far` [m]: their number,
/// themselves in `found`.
std::size_t find_within(const TickGeometry& geometry, const Vec2& position, double far,
                        std::vector<std::uint32_t>& found) {
  const PairSearch search(geometry, position, far);
  const SpatialGrid::Entry* entries = geometry.grid.entries().data();
  std::size_t count = 0;
  geometry.grid.visit_runs(position, far + geometry.largest_far,
                           [&](std::uint32_t first, std::uint32_t last) {
                             if (found.size() < count + (last - first))
                               found.resize(2 * (count + (last - first)));
                             std::uint32_t* end = found.data() + count;
                             const PairSearch pairs = search;  // in registers
                             for (std::uint32_t k = first; k < last; k += 2) {
                               const unsigned bits = pairs.within(k);
                               if (bits == 0) continue;
                               if (bits & 1u) *end++ = entries[k].row;
                               if (bits > 1u && k + 1 < last) *end++ = entries[k + 1].row;
                             }
                             count = static_cast<std::size_t>(end - found.data());
                           });
  return count;
}

}  // namespace

bool attends(const AgentGeometry& agent, const AgentGeometry& other, const AttentionRange& range) {
  const Vec2 offset = other.position - agent.position;
  const double reach = reach_towards(agent, other, range, offset);
  return offset.squaredNorm() <= reach * reach;
}

void find_neighbours(const RoadNetwork& network, const TickGeometry& geometry, std::size_t row,
                     const AttentionRange& range, const Vec2& preferred, double horizon,
                     Neighbours& neighbours) {
  neighbours.attended.clear();
  neighbours.near.clear();
  const AgentGeometry& own = geometry.agent[row];
  const double seen = std::max({range.front + own.stopping, range.rear, 0.0}) + own.radius;
  const double own_far = std::max(seen, own.next_reach);
  const std::size_t count = find_within(geometry, own.position, own_far, neighbours.found);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t other_row = neighbours.found[k];
    if (other_row == row) continue;
    const AgentGeometry& other = geometry.agent[other_row];
    // above or below on a bridge: never met
    if (on_other_storey(network, own.ground, other.ground)) continue;
    const Vec2 offset = other.position - own.position;
    const double square = offset.squaredNorm();
    const double near = own.next_reach + other.next_reach;
    if (square <= near * near) neighbours.near.push_back(other_row);
    const double reach = reach_towards(own, other, range, offset);
    if (square > reach * reach) continue;
    const double distance = std::sqrt(square);
    const double gap = distance - own.radius - other.radius;
    const double approach =
        std::max(own.velocity.dot(offset), preferred.dot(offset)) - other.velocity.dot(offset);
    if (stays_away(gap, distance, approach, horizon)) continue;
    neighbours.attended.push_back({other_row, distance});
  }
  // in order of id, so that nothing depends on where the grid's cells happen to lie
  std::sort(neighbours.attended.begin(), neighbours.attended.end(),
            [](const Attended& a, const Attended& b) { return a.row < b.row; });
}

void find_nearby(const RoadNetwork& network, const TickGeometry& geometry, std::size_t row,
                 const AttentionRange& farthest, Nearby& nearby) {
  nearby.row = row;
  nearby.agents.clear();
  const AgentGeometry& own = geometry.agent[row];
  const double seen = std::max({farthest.front + own.stopping, farthest.rear, 0.0}) + own.radius;
  const std::size_t count =
      find_within(geometry, own.position, std::max(seen, own.next_reach), nearby.found);
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint32_t other_row = nearby.found[k];
    if (other_row == row) continue;
    const AgentGeometry& other = geometry.agent[other_row];
    if (on_other_storey(network, own.ground, other.ground)) continue;
    const Vec2 offset = other.position - own.position;
    const double square = offset.squaredNorm();
    const double reach = reach_towards(own, other, farthest, offset);
    if (square > reach * reach) continue;
    const double distance = std::sqrt(square);
    nearby.agents.push_back({other_row, own.forward.dot(offset) >= 0,
                             other.forward.dot(offset) < 0 ? other.stopping : 0.0, other.radius,
                             distance, square, distance - own.radius - other.radius,
                             own.velocity.dot(offset), other.velocity.dot(offset), offset});
  }
  std::sort(nearby.agents.begin(), nearby.agents.end(),
            [](const Nearby::Agent& a, const Nearby::Agent& b) { return a.row < b.row; });
}

void attend_among(const Nearby& nearby, const AgentGeometry& own, const AttentionRange& range,
                  const Vec2& preferred, double horizon, std::vector<Attended>& attended) {
  attended.clear();
  for (const Nearby::Agent& other : nearby.agents) {
    const double far = other.ahead ? range.front + own.stopping : range.rear;
    const double reach = far + other.stopping + own.radius + other.radius;
    if (other.square > reach * reach) continue;
    const double approach =
        std::max(other.own_approach, preferred.dot(other.offset)) - other.flight;
    if (stays_away(other.gap, other.distance, approach, horizon)) continue;
    attended.push_back({other.row, other.distance});
  }
}

}  // namespace sumogamma
