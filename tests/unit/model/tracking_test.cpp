#include "model/tracking.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/units.h"
#include "support/random_draw.h"

namespace sumogamma {
namespace {

Vec2 rear_axle(const AgentType& type, const BodyState& body) {
  return body.position - type.rear_axle_to_center * direction_of(body.heading);
}

TEST(Tracking, WheelsRollWithinTheirLimitsWhateverIsAsked) {
  for (const AgentType& type : default_agent_types()) {
    if (type.kinematics == Kinematics::Holonomic) continue;
    SCOPED_TRACE(type.name);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      for (double dt : {0.01, 0.05, 0.5}) {
        BodyState body;
        body.heading = drawn_number(seed, 1, -kPi, kPi);
        for (std::uint64_t step = 0; step < 100; ++step) {
          const Vec2 asked(drawn_number(seed, 10 + 2 * step, -20, 20),
                           drawn_number(seed, 11 + 2 * step, -20, 20));
          const BodyState next = advance_body(type, body, asked, dt);
          ASSERT_GE(next.speed, 0) << "never backwards";
          ASSERT_LE(next.speed, std::max(body.speed + type.max_acceleration * dt, 0.0) + 1e-9);
          ASSERT_GE(next.speed, std::max(body.speed - type.max_deceleration * dt, 0.0) - 1e-9);
          ASSERT_LE(std::abs(next.steering), type.max_steering + 1e-9);
          ASSERT_LE(std::abs(next.steering - body.steering), type.max_steering_rate * dt + 1e-9);
          // the rear axle moves along the chord between the two headings: it doesn't slide
          const Vec2 way = rear_axle(type, next) - rear_axle(type, body);
          const double turn = wrap_angle(next.heading - body.heading);
          if (way.norm() > 1e-6) {
            const Vec2 middle = direction_of(body.heading + 0.5 * turn);
            ASSERT_NEAR(cross(middle, way), 0, 1e-6 + 1e-6 * way.norm());
          }
          // no turning on the spot, and no tighter than the lock allows
          ASSERT_LE(std::abs(turn),
                    next.speed * dt * std::tan(type.max_steering) / type.wheelbase + 1e-9);
          ASSERT_NEAR((next.velocity * dt - (next.position - body.position)).norm(), 0, 1e-9);
          body = next;
        }
      }
    }
  }
}

TEST(Tracking, TheCentreGoesWhereItIsAskedWithinItsSlip) {
  // the steering law of low speeds: no error at all once the speed is there
  AgentType car = type_of(default_agent_types(), find_agent_type(default_agent_types(), "car"));
  car.max_steering_rate = 1e3;
  BodyState body;
  body.speed = 3;
  body.velocity = {3, 0};
  const Vec2 asked = 3.2 * direction_of(radians(15));
  for (int k = 0; k < 100; ++k) body = advance_body(car, body, asked, 0.05);
  EXPECT_NEAR(heading_of(body.velocity), radians(15), 0.01);
  EXPECT_NEAR(body.heading, radians(15), 0.02);
  EXPECT_NEAR(cross(asked.normalized(), body.position), 0, 0.15)
      << "the centre's path is the asked line";
}

TEST(Tracking, StandsOnRequestAndOnNonsense) {
  const AgentTypeTable types = default_agent_types();
  for (const AgentType& type : types) {
    BodyState body;
    body.speed = 2;
    body.velocity = {2, 0};
    for (int k = 0; k < 100; ++k)
      body = advance_body(
          type, body,
          k % 2 == 0 ? Vec2(0, 0) : Vec2(std::nan(""), std::numeric_limits<double>::infinity()),
          0.05);
    EXPECT_NEAR(body.velocity.norm(), 0, 1e-9) << type.name;
    EXPECT_TRUE(body.position.allFinite());
  }
}

TEST(Tracking, PeopleOnFootAccelerateWithinLimitsAndFaceTheirWay) {
  const AgentTypeTable types = default_agent_types();
  const AgentType& walker = type_of(types, find_agent_type(types, "pedestrian"));
  BodyState body;
  const BodyState next = advance_body(walker, body, Vec2(0, 5), 0.1);
  EXPECT_NEAR(next.velocity.norm(), walker.max_acceleration * 0.1, 1e-9);
  for (int k = 0; k < 50; ++k) body = advance_body(walker, body, Vec2(0, 1.2), 0.1);
  EXPECT_NEAR(body.velocity.y(), 1.2, 1e-9);
  EXPECT_NEAR(body.heading, kPi / 2, 1e-6);
}

}  // namespace
}  // namespace sumogamma
