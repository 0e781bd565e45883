#include "ego/ego_record.h"

#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "ego/ego_driver.h"
#include "ego/episode.h"
#include "model/tracking.h"

namespace sumogamma {
namespace {

/// Cars on a plain without roads, the first of which is the ego.
class OnAPlain : public ::testing::Test {
 protected:
  OnAPlain() { model_.types = default_agent_types(); }

  std::size_t add(const Vec2& position, double heading, double speed) {
    AgentState agent;
    agent.id = AgentId{static_cast<std::uint32_t>(scene_.size())};
    agent.type = find_agent_type(model_.types, "car");
    agent.footprint = box_footprint(4.0, 2.0);
    agent.position = position;
    agent.heading = heading;
    agent.speed = speed;
    append_agent(scene_, agent);
    return scene_.size() - 1;
  }

  Model model_;
  Scene scene_;
};

constexpr double kEast = 0.0, kNorth = 1.5707963267948966, kWest = 3.141592653589793;

TEST_F(OnAPlain, KnowsHowTheEgoMetSomebody) {
  //   ego >   foe >        nose to tail
  const std::size_t ego = add({0, 0}, kEast, 3.0), ahead = add({3.95, 0}, kEast, 1.0);
  EXPECT_EQ(contact_kind(scene_, ego, ahead), ContactKind::Front);
  EXPECT_EQ(contact_kind(scene_, ahead, ego), ContactKind::FromBehind);
  const std::size_t stands = add({3.95, 0.5}, kNorth, 0.0);
  EXPECT_EQ(contact_kind(scene_, ego, stands), ContactKind::OtherStood);
  EXPECT_EQ(contact_kind(scene_, stands, ego), ContactKind::Standing);
  const std::size_t beside = add({0.3, 1.97}, kEast, 3.0);
  EXPECT_EQ(contact_kind(scene_, ego, beside), ContactKind::Side);
}

TEST_F(OnAPlain, AnswersForWhatItRanInto) {
  EgoContact contact;
  using Case = std::tuple<ContactKind, bool, bool>;
  for (const auto& [kind, in_lane, off_lane] :
       std::vector<Case>{{ContactKind::Front, true, true},
                         {ContactKind::OtherStood, true, true},
                         {ContactKind::Side, false, true},
                         {ContactKind::FromBehind, false, false},
                         {ContactKind::Standing, false, false}}) {
    contact.kind = kind;
    contact.in_one_lane = true;
    EXPECT_EQ(is_at_fault(contact), in_lane);
    contact.in_one_lane = false;
    EXPECT_EQ(is_at_fault(contact), off_lane);
  }
}

TEST_F(OnAPlain, TimeToCollisionLooksAheadAndBesideOnlyOutOfItsLane) {
  const std::size_t ego = add({0, 0}, kEast, 5.0);
  EXPECT_FALSE(std::isfinite(time_to_collision(model_, scene_, ego, true)));
  add({24, 0}, kEast, 0.0);  // 20 m of gap at 5 m/s
  EXPECT_NEAR(time_to_collision(model_, scene_, ego, true), 4.0, 0.11);
  add({14, 0}, kWest, 5.0);  // 10 m at 10 m/s
  EXPECT_NEAR(time_to_collision(model_, scene_, ego, true), 1.0, 0.11);
  add({0, 4}, kEast, 5.0);
  scene_.velocity.back() = Vec2(5.0, -4.0);  // drifts over from beside: 2 m at 4 m/s
  EXPECT_NEAR(time_to_collision(model_, scene_, ego, true), 1.0, 0.11);
  EXPECT_NEAR(time_to_collision(model_, scene_, ego, false), 0.5, 0.11);
  add({-6, 0}, kEast, 20.0);  // who comes from behind is not the ego's business
  EXPECT_NEAR(time_to_collision(model_, scene_, ego, false), 0.5, 0.11);
  scene_.velocity[ego].setZero();
  EXPECT_FALSE(std::isfinite(time_to_collision(model_, scene_, ego, false)));
}

TEST_F(OnAPlain, TheEmergencyBrakeKnowsItsBrakingWay) {
  const std::size_t ego = add({0, 0}, kEast, 10.0);
  const double most = type_of(model_.types, scene_.type[ego]).max_deceleration;
  const double way = 100.0 / (2.0 * most);
  const std::size_t foe = add({4.0 + way + 0.4, 0}, kEast, 0.0);
  EXPECT_FALSE(must_brake_now(model_, scene_, ego));
  scene_.position[foe].x() -= 0.2;
  EXPECT_TRUE(must_brake_now(model_, scene_, ego));
  scene_.position[foe] = {-5.0, 0.0};
  EXPECT_FALSE(must_brake_now(model_, scene_, ego)) << "behind it";
  scene_.position[foe] = {4.0, 0.0};
  scene_.speed[ego] = 0.0;
  EXPECT_FALSE(must_brake_now(model_, scene_, ego)) << "it stands";
}

TEST_F(OnAPlain, ASteeringAngleIsReachedExactly) {
  const std::size_t ego = add({0, 0}, kEast, 6.0);
  const AgentType& type = type_of(model_.types, scene_.type[ego]);
  for (const double angle : {0.2, -0.1, 0.0, 0.5}) {
    EgoAction action;
    action.acceleration = 0.0;
    action.steering = angle;
    const double grip = 1.6 * type.max_lateral_acceleration * type.wheelbase / 36.0;
    const double allowed = std::min(std::abs(angle), std::atan(grip));
    // no further turning of the wheel is needed
    scene_.steering[ego] = std::copysign(allowed, angle);
    const Vec2 wish = velocity_of(action, model_, scene_, ego, {20.0, 0.0, 0.05});
    const BodyState next = track_velocity(model_, scene_, ego, wish, 0.05);
    EXPECT_NEAR(std::abs(next.steering), allowed, 1e-9);
    EXPECT_NEAR(next.speed, 6.0, 1e-9);
  }
}

TEST_F(OnAPlain, AnAccelerationIsDoneAndNeverBeyondTheTopSpeed) {
  const std::size_t ego = add({0, 0}, kEast, 5.0);
  const auto speed_after = [&](double acceleration) {
    EgoAction action;
    action.acceleration = acceleration;
    const Vec2 wish = velocity_of(action, model_, scene_, ego, {5.1, 0.0, 0.05});
    return track_velocity(model_, scene_, ego, wish, 0.05).speed;
  };
  EXPECT_NEAR(speed_after(1.0), 5.05, 1e-9);
  EXPECT_NEAR(speed_after(-3.0), 4.85, 1e-9);
  EXPECT_NEAR(speed_after(2.5), 5.1, 1e-9);
  EXPECT_EQ(speed_after(-1e9),
            5.0 - 0.05 * type_of(model_.types, scene_.type[ego]).max_deceleration);
}

TEST_F(OnAPlain, ATrajectoryIsPursued) {
  const std::size_t ego = add({0, 0}, kEast, 5.0);
  EgoAction action;
  action.trajectory = {{0.0, {0, 0}}, {1.0, {5, 0}}, {2.0, {10, 0}}};
  EXPECT_NEAR(velocity_of(action, model_, scene_, ego, {20.0, 0.0, 0.05}).x(), 5.0, 1e-9);
  action.trajectory = {{0.0, {0, 0}}, {1.0, {5, 2}}};
  EXPECT_GT(velocity_of(action, model_, scene_, ego, {20.0, 0.0, 0.05}).y(), 0.1);
}

TEST_F(OnAPlain, GridlockIsHalfOfTheVehiclesStandingForLong) {
  add({0, 0}, kEast, 5.0);
  add({100, 0}, kEast, 0.0);
  add({104, 4}, kEast, 0.0);
  add({120, 8}, kEast, 3.0);
  GridlockWatch watch({}, 1.0), near({}, 1.0);
  for (int k = 0; k < 29; ++k) watch.add(model_.types, scene_, 0);
  EXPECT_FALSE(watch.found());
  watch.add(model_.types, scene_, 0);
  EXPECT_TRUE(watch.found());
  scene_.position[0] = {102, 10};  // the ego may be its cause
  for (int k = 0; k < 60; ++k) near.add(model_.types, scene_, 0);
  EXPECT_FALSE(near.found());
}

TEST(WilsonInterval, IsThatOfTheBooks) {
  // Newcombe 1998, table I: 81 of 263, 15 of 148, 0 of 20
  EXPECT_NEAR(wilson_interval(81, 263).low, 0.2553, 5e-5);
  EXPECT_NEAR(wilson_interval(81, 263).high, 0.3662, 5e-5);
  EXPECT_NEAR(wilson_interval(15, 148).low, 0.0624, 5e-5);
  EXPECT_NEAR(wilson_interval(15, 148).high, 0.1605, 5e-5);
  EXPECT_EQ(wilson_interval(0, 20).low, 0.0);
  EXPECT_NEAR(wilson_interval(0, 20).high, 0.1611, 5e-5);
  EXPECT_EQ(wilson_interval(0, 3).low, 0.0);
  EXPECT_EQ(wilson_interval(3, 3).high, 1.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

}  // namespace
}  // namespace sumogamma
