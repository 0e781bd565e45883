#include "model/bending.h"

#include <algorithm>
#include <cmath>

#include "geometry/closing.h"
#include "geometry/vec2.h"

namespace sumogamma {

Arc::Arc(const AgentGeometry& who, const Vec2& bend)
    // the chord of an arc points along half of its turn
    : agent(who), curvature(2.0 * heading_of(bend) / std::max(kBendTime * who.speed, 0.5)) {}

OrientedBox Arc::body_after(double way) const {
  const double half_turn = 0.5 * curvature * way;
  const double chord = std::abs(half_turn) > 1e-6 ? way * std::sin(half_turn) / half_turn : way;
  const Vec2 position = agent.position + chord * from_body(direction_of(half_turn), agent.forward);
  const Vec2 forward = from_body(direction_of(2.0 * half_turn), agent.forward);
  return {position + agent.guarded_shift * forward, forward, agent.guarded_half};
}

bool bend_past(const Arc& a, double speed_a, const Arc& b, double speed_b, double time) {
  constexpr double kStep = 0.15;   // [s]
  constexpr double kExact = 1e-6;  // two who meet head on touch at that very moment [s]
  const double turn_a = std::abs(a.curvature * speed_a), turn_b = std::abs(b.curvature * speed_b);
  const double swing = turn_a * a.agent.radius + turn_b * b.agent.radius;
  const double change = turn_a * std::abs(speed_a) + turn_b * std::abs(speed_b);
  double apart_until = 0.0;  // no step before that has to be looked at
  for (double at = kStep; at < time + 0.5 * kStep; at += kStep) {
    if (at < apart_until) continue;
    const OrientedBox one = a.body_after(speed_a * at), other = b.body_after(speed_b * at);
    const double gap = separation(one, other);
    if (gap <= 0.0) return false;
    const double speed = (speed_a * one.forward - speed_b * other.forward).norm() + swing;
    apart_until = at + time_to_close(gap, speed, change) - kExact;
  }
  return true;
}

}  // namespace sumogamma
