#include "model/bending.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/units.h"

namespace sumogamma {
namespace {

/// A car of 4.5 m x 1.8 m.
AgentGeometry car(const Vec2& position, double heading, double speed) {
  AgentGeometry agent;
  agent.position = position;
  agent.forward = direction_of(heading);
  agent.guarded_half = Vec2(2.25, 0.9);
  agent.radius = agent.guarded_half.norm();
  agent.speed = speed;
  agent.velocity = speed * agent.forward;
  return agent;
}

/// RoadContext::bend of somebody who turns with a radius [m, positive left].
Vec2 bend_with(double radius, double speed) {
  const double half_turn = 0.5 * kBendTime * speed / radius;
  return std::sin(half_turn) / half_turn * direction_of(half_turn);
}

TEST(Arc, EndsWhereAQuarterCircleDoes) {
  const AgentGeometry agent = car({0, 0}, 0, 4);
  const Arc arc(agent, bend_with(10, 4));
  EXPECT_NEAR(arc.curvature, 0.1, 1e-9);
  const OrientedBox body = arc.body_after(0.5 * kPi * 10);
  EXPECT_NEAR(body.center.x(), 10, 1e-9);
  EXPECT_NEAR(body.center.y(), 10, 1e-9);
  EXPECT_NEAR(body.forward.y(), 1, 1e-9);
}

TEST(Arc, IsALineWithoutABend) {
  const AgentGeometry agent = car({1, 2}, 0.5 * kPi, 4);
  const OrientedBox body = Arc(agent, Vec2(1, 0)).body_after(6);
  EXPECT_NEAR(body.center.x(), 1, 1e-9);
  EXPECT_NEAR(body.center.y(), 8, 1e-9);
}

// Somebody turns right into the near lane of a road; on the far one another comes towards it.
//
//        <------- other            the outline as it stands now, moved along the chord, would
//      ,-------->                  reach into the far lane
//      |  own
TEST(BendPast, WhoTurnsIntoItsOwnLaneIsInNobodysWay) {
  const AgentGeometry own = car({0, -6}, 0.5 * kPi, 4), other = car({22, 2.2}, kPi, 13);
  const Arc straight(other, Vec2(1, 0));
  EXPECT_TRUE(bend_past(Arc(own, bend_with(-6, 4)), 4, straight, 13, kBendTime));
  EXPECT_FALSE(bend_past(Arc(own, Vec2(1, 0)), 4, straight, 13, kBendTime)) << "straight on";
}

// two buses abreast on lanes of 3.2 m that bend together wedged each other: the outline of the
// outer one, moved along, reaches into the other lane
TEST(BendPast, TwoAbreastBendTogether) {
  auto bus = [](double y) {
    AgentGeometry agent = car({0, y}, 0, 4);
    agent.guarded_half = Vec2(6.0, 1.35);
    return agent;
  };
  const AgentGeometry outer = bus(0), inner = bus(3.2);
  EXPECT_TRUE(
      bend_past(Arc(outer, bend_with(40, 4)), 4, Arc(inner, bend_with(36.8, 4)), 3.7, kBendTime));
  EXPECT_FALSE(bend_past(Arc(outer, bend_with(40, 4)), 4, Arc(inner, Vec2(1, 0)), 4, 4 * kBendTime))
      << "one goes straight on";
}

// moments that are left out, as the two can't have met until then, would have told the same
TEST(BendPast, IsWhatEveryMomentSays) {
  std::mt19937_64 random(7);
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int past = 0;
  constexpr int kPairs = 4000;
  for (int pair = 0; pair < kPairs; ++pair) {
    const AgentGeometry one = car({0, 0}, draw(-kPi, kPi), draw(0, 30)),
                        two = car({draw(-25, 25), draw(-8, 8)}, draw(-kPi, kPi), draw(0, 30));
    const Arc a(one, draw(0.3, 1) * direction_of(draw(-1, 1))),
        b(two, draw(0.3, 1) * direction_of(draw(-1, 1)));
    const double speed_a = draw(0, 30), speed_b = draw(0, 30), time = draw(0.5, kBendTime);
    bool apart = true;
    for (double at = 0.15; at < time + 0.075; at += 0.15)
      apart = apart && separation(a.body_after(speed_a * at), b.body_after(speed_b * at)) > 0.0;
    EXPECT_EQ(bend_past(a, speed_a, b, speed_b, time), apart) << "pair " << pair;
    past += apart ? 1 : 0;
  }
  EXPECT_GT(past, kPairs / 10);
  EXPECT_LT(past, kPairs - kPairs / 10);
}

}  // namespace
}  // namespace sumogamma
