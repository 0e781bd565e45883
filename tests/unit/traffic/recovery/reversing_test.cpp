#include "traffic/recovery/reversing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "base/random.h"
#include "geometry/rotation.h"
#include "model/stopping_guard.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

constexpr double kDt = 0.05;

class BackingTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("priority"));
    return network;
  }

  /// Lets one row stand where bodies hold it, and back out, for a time [s]. Way rolled back [m].
  double stand_wedged(std::size_t row, double time, double allowed_speed = 1.0) {
    const Vec2 from = here_.scene.position[row];
    const Vec2 forward = direction_of(here_.scene.heading[row]);
    double farthest = 0;
    for (double t = 0; t < time; t += kDt) {
      prepare_tick(here_.model, here_.scene, workers_, here_.geometry);
      here_.scene.context[row].active = true;
      here_.scene.context[row].allowed_speed = allowed_speed;
      const auto body = back_out(here_.view(), here_.geometry, row, kDt);
      if (body) {
        here_.scene.position[row] = body->position;
        here_.scene.heading[row] = body->heading;
        here_.scene.velocity[row] = body->velocity;
        here_.scene.speed[row] = body->speed;
        here_.scene.steering[row] = body->steering;
      }
      update_held(kDt, here_.scene, row);
      update_backing(here_.view(), here_.geometry, kDt, workers_, next_, here_.traffic);
      gave_way_ = gave_way_ || here_.traffic.gives_way_left[row] > 0.0;
      farthest = std::max(farthest, (from - here_.scene.position[row]).dot(forward));
      fastest_ = std::max(fastest_, here_.scene.velocity[row].norm());
      here_.scene.time += kDt;
    }
    return farthest;
  }

  /// Lets one row wait behind another.
  void waits(std::size_t row, std::size_t foe) {
    here_.scene.context[row].active = true;
    here_.scene.context[row].reason = LimitReason::Leader;
    here_.scene.context[row].foe = here_.scene.id[foe].value;
  }

  void update() {
    prepare_tick(here_.model, here_.scene, workers_, here_.geometry);
    update_backing(here_.view(), here_.geometry, kDt, workers_, next_, here_.traffic);
  }

  RoadScene here_{net()};
  Workers workers_;
  std::vector<Backing> next_;
  double fastest_ = 0;
  bool gave_way_ = false;
};

TEST_F(BackingTest, AWedgedCarRollsBackAndThenGivesWay) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  EXPECT_EQ(stand_wedged(own, 7.0), 0.0) << "not before its patience is over";
  EXPECT_GT(stand_wedged(own, 32.0), 3.0);
  EXPECT_LE(fastest_, 0.5);
  EXPECT_TRUE(gave_way_);
}

// a queue of five rolled back for a motorcycle between them while its light turned green; who is
// narrow may creep on between the others all the same
TEST_F(BackingTest, NobodyBacksOutOfAQueueAtARedLight) {
  const std::size_t own = here_.add("motorcycle", {"WC", "CE"}, 100, 0);
  here_.scene.context[own].at_red = true;
  EXPECT_EQ(stand_wedged(own, 60.0), 0.0);
  EXPECT_TRUE(is_wedged(here_.scene, own));
}

// who backed out at red had its gap beside it when the queue set off, and missed it; two who wanted
// each other's lane stood side by side through three cycles of short greens
TEST_F(BackingTest, WhoFindsNoGapBacksOutAfterSomeTimeAtGreen) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  here_.scene.context[own].reason = LimitReason::Merge;
  const auto rolls = [&](bool at_red, double time) {
    here_.scene.context[own].at_red = at_red;
    return stand_wedged(own, time, 0.0);
  };
  EXPECT_EQ(rolls(true, 60.0), 0.0);
  EXPECT_EQ(rolls(false, 10.0), 0.0) << "the queue beside it sets off";
  EXPECT_FALSE(is_wedged(here_.scene, own));
  EXPECT_EQ(rolls(true, 60.0), 0.0);
  EXPECT_GT(rolls(false, 20.0), 1.0) << "two greens together";
}

TEST_F(BackingTest, NobodyBacksOutOrGivesWayOnceItsGapIsThere) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  here_.traffic.merge_to[own] = here_.model.road.lane_by_name.at("CE_0");
  const auto left = [&](double gate) {
    here_.traffic.gate[own] = gate;
    here_.traffic.backing_left[own] = 0.0;
    here_.traffic.gives_way_left[own] = 10.0;
    update();
    const double gives_way = here_.traffic.gives_way_left[own];
    here_.traffic.backing_left[own] = 5.0;
    update();
    return std::pair(gives_way > 0.0, here_.traffic.backing_left[own] > 0.0);
  };
  EXPECT_EQ(left(101.0), std::pair(true, true)) << "it waits for one";
  EXPECT_EQ(left(std::numeric_limits<double>::infinity()), std::pair(false, false));
  // amid its change others may wedge it
  here_.scene.lane[own].lane = here_.traffic.merge_to[own];
  EXPECT_EQ(left(std::numeric_limits<double>::infinity()), std::pair(true, true));
}

// two motorcycles that wanted each other's lane rolled back until somebody stood behind them and
// drove up to their line again, for minutes
TEST_F(BackingTest, WhoFindsNoGapGivesWayFromWhereItCanRollNoFurther) {
  const std::size_t own = here_.add("motorcycle", {"WC", "CE"}, 100, 0);
  here_.add("car", {"WC", "CE"}, 94.5, 0);
  here_.scene.context[own].reason = LimitReason::Merge;
  double rolled = 0, just_now = 0;
  for (int k = 0; k < 60 && (rolled < 1.0 || just_now > 0.01); ++k)
    rolled += just_now = stand_wedged(own, 1.0);
  EXPECT_GT(rolled, 1.0);
  EXPECT_GT(here_.traffic.gives_way_left[own], 1.0);
}

// a truck whose nose touched a car swung it 11 cm into that, as the place half a metre back was
// free
TEST_F(BackingTest, NobodySwingsItsNoseIntoWhomItTouches) {
  const std::size_t own = here_.add("truck", {"WC", "CE"}, 100, 0);
  const std::size_t beside = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t behind = here_.add("car", {"WC", "CE"}, 90, 0);
  const Vec2 from = here_.scene.position[own];
  const double heading = here_.scene.heading[own];
  const auto draw = [&](int trial, std::uint64_t what, double least, double most) {
    return random_uniform(1, static_cast<std::uint32_t>(trial), what, Draw::Intention, least, most);
  };
  const auto gap = [&] {
    prepare_tick(here_.model, here_.scene, workers_, here_.geometry);
    return separation(here_.geometry.agent[own].box(), here_.geometry.agent[beside].box());
  };
  int touching = 0, rolled = 0;
  for (int trial = 0; trial < 6000; ++trial) {
    here_.scene.position[own] = from;
    here_.scene.heading[own] = heading + draw(trial, 5, -0.6, 0.6);
    here_.set_speed(own, 0);
    const auto place = [&](double ahead, double left) {
      return Vec2(from + from_body(Vec2(ahead, left), direction_of(here_.scene.heading[own])));
    };
    here_.scene.position[beside] = place(draw(trial, 0, 1, 5), draw(trial, 1, 2.4, 3.8));
    here_.scene.heading[beside] = here_.scene.heading[own] + draw(trial, 2, -1.1, -0.3);
    here_.scene.position[behind] = place(draw(trial, 3, -8, -6), draw(trial, 4, -2, 2));
    const double before = gap();
    if (before > 0.03 || before < -0.04) continue;
    ++touching;
    here_.scene.held[own].standing = here_.scene.held[own].blocked = 20.0;
    here_.traffic.backing_left[own] = here_.traffic.gives_way_left[own] = 0.0;
    double least = before;
    for (int k = 0; k < 30; ++k) {
      rolled += stand_wedged(own, 0.5) > 0.01 ? 1 : 0;
      least = std::min(least, gap());
    }
    EXPECT_GT(least, std::min(before, 0.0) - 0.01) << trial;
  }
  EXPECT_GT(touching, 10);
  EXPECT_GT(rolled, 50);
}

// Who stands behind somebody that has no room to back out makes some, and so on down the queue.
TEST_F(BackingTest, AQueueMakesRoomOneAfterTheOther) {
  const std::size_t first = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t second = here_.add("car", {"WC", "CE"}, 94, 0);
  const std::size_t third = here_.add("car", {"WC", "CE"}, 88, 0);
  here_.scene.held = {{20.0}, {20.0}, {20.0}};
  here_.traffic.backing_left[first] = 5.0;
  for (const std::size_t row : {second, third}) {
    here_.scene.context[row].active = true;
    here_.scene.context[row].reason = LimitReason::Leader;
    here_.scene.context[row].foe = static_cast<std::int64_t>(row) - 1;
  }
  update();
  EXPECT_GT(here_.traffic.backing_left[second], 0.0);
  // who makes room for a second, and gets no further, asks for some in its turn
  here_.traffic.backing_left[second] = 10.0;
  update();
  EXPECT_GT(here_.traffic.backing_left[third], 0.0);
}

TEST_F(BackingTest, NobodyMakesRoomForWhoCanRollBack) {
  const std::size_t first = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t second = here_.add("car", {"WC", "CE"}, 94, 0);
  here_.scene.held = {{0.0}, {20.0}};
  here_.traffic.backing_left[first] = 5.0;
  here_.scene.context[second].active = true;
  here_.scene.context[second].reason = LimitReason::Leader;
  here_.scene.context[second].foe = 0;
  update();
  EXPECT_EQ(here_.traffic.backing_left[second], 0.0);
}

// a motorcycle could not leave a small ring for a lorry that stood across its exit, behind a van
// that waited for those behind the motorcycle: each for the next, fifteen of them until the end
TEST_F(BackingTest, WhoStandsAcrossTheWayOfSomebodyWedgedStepsBack) {
  const std::size_t own = here_.add("truck", {"WC", "CE"}, 100, 0);
  const std::size_t wedged = here_.add("motorcycle", {"SC", "CN"}, 0, 0);
  const std::size_t behind = here_.add("car", {"SC", "CN"}, 0, 0);
  const AgentType& type = type_of(here_.model.types, here_.scene.type[own]);
  const Vec2 forward = direction_of(here_.scene.heading[own]);
  here_.scene.heading[wedged] = here_.scene.heading[own] + 0.5 * kPi;
  here_.scene.position[wedged] =
      here_.scene.position[own] + 2.0 * forward -
      (0.5 * type.width + 1.1 + 1.0) * direction_of(here_.scene.heading[wedged]);
  here_.scene.held = {{30.0}, {30.0}, {30.0}};
  waits(own, behind);
  waits(behind, wedged);
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "for nobody who isn't wedged";
  here_.scene.held[wedged].wedge_left = 10.0;
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "nor at once: the light may just have changed";
  here_.scene.held[wedged].blocked = 12.0;
  waits(behind, own);
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "nor for whom it doesn't wait";
  waits(behind, wedged);
  update();
  EXPECT_GT(here_.traffic.backing_left[own], 0.0);
  EXPECT_GT(here_.traffic.gives_way_left[own], here_.traffic.backing_left[own]);
  // not in front of a red light, nor before it has stood for long
  here_.traffic.backing_left[own] = here_.traffic.gives_way_left[own] = 0.0;
  here_.scene.held[own].standing = 10.0;
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0);
  here_.scene.held[own].standing = 30.0;
  here_.scene.context[own].at_red = true;
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0);
}

// a bus, a van and a car: the van before the nose of the car, its tail in the turn of the bus, and
// the car behind the bus, with room to step back from both
TEST_F(BackingTest, WhoStandsBeforeSomebodyWedgedAndWaitsForAnotherStepsBack) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t wedged = here_.add("van", {"SC", "CN"}, 0, 0);
  const std::size_t waited_for = here_.add("bus", {"WC", "CE"}, 150, 0);
  const AgentType& type = type_of(here_.model.types, here_.scene.type[wedged]);
  const Vec2 forward = direction_of(here_.scene.heading[own]);
  // nose to nose
  here_.scene.heading[wedged] = here_.scene.heading[own] + kPi;
  here_.scene.position[wedged] =
      here_.scene.position[own] + (2.25 + 0.5 * type.length + 0.5) * forward;
  here_.scene.held = {{30.0}, {30.0}, {30.0}};
  here_.scene.held[wedged].wedge_left = here_.scene.held[wedged].blocked = 12.0;
  waits(own, waited_for);
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "the bus may go on any time";
  here_.scene.held[waited_for].wedge_left = 10.0;
  update();
  EXPECT_GT(here_.traffic.backing_left[own], 0.0);
}

// it rolled back from a ring, gave way for half a minute, and all the time stood before the nose of
// the one that it gave way to
TEST_F(BackingTest, WhoGivesWayRollsBackFurtherForWhomItStillHolds) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t wedged = here_.add("car", {"SC", "CN"}, 0, 0);
  const Vec2 forward = direction_of(here_.scene.heading[own]);
  here_.scene.heading[wedged] = here_.scene.heading[own] + 0.5 * kPi;
  here_.scene.position[wedged] = here_.scene.position[own] + 1.5 * forward -
                                 (0.9 + 2.25 + 0.5) * direction_of(here_.scene.heading[wedged]);
  here_.traffic.gives_way_left[own] = 4.0;
  here_.scene.held[wedged].wedge_left = 10.0;
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "the other may be about to go";
  here_.scene.held[wedged].blocked = 4.0;
  update();
  EXPECT_GT(here_.traffic.backing_left[own], 0.0);
  EXPECT_GT(here_.traffic.gives_way_left[own], here_.traffic.backing_left[own]);
  here_.traffic.backing_left[own] = 0.0;
  here_.traffic.gives_way_left[own] = 4.0;
  here_.scene.position[wedged] -= 3.0 * direction_of(here_.scene.heading[wedged]);
  update();
  EXPECT_EQ(here_.traffic.backing_left[own], 0.0) << "not for who has room";
}

// it rolled back just when the bus that had stepped back for it had made room, came on again when
// the bus had given way for long enough, and the two stood as before
TEST_F(BackingTest, NobodyRollsBackBeforeWhoMakesRoomForIt) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t other = here_.add("car", {"EC", "CW"}, 50, 0);
  here_.scene.position[other] = here_.scene.position[own] + Vec2(4.5 + 0.5, 0);
  here_.traffic.gives_way_left[other] = 10.0;
  EXPECT_EQ(stand_wedged(own, 30.0), 0.0);
  here_.traffic.gives_way_left[other] = 0.0;
  EXPECT_GT(stand_wedged(own, 30.0), 1.0);
}

// along its path it would have swung into the lorry beside it; both stood for minutes
TEST_F(BackingTest, WhoCanNotFollowItsPathBackwardsRollsBackStraight) {
  const std::size_t own = here_.add("bicycle", {"WC", "CE"}, 100, 0, 0, -1, "WC_1");
  here_.move(own, 100, -2.0);
  const std::size_t beside = here_.add("truck", {"WC", "CE"}, 100, 0, 0, -1, "WC_1");
  const double half_widths = 0.5 * (type_of(here_.model.types, here_.scene.type[own]).width +
                                    type_of(here_.model.types, here_.scene.type[beside]).width);
  here_.move(beside, 98, -2.0 + half_widths + 0.02);
  EXPECT_GT(stand_wedged(own, 40.0), 2.0);
  EXPECT_GT(separation(here_.geometry.agent[own].box(), here_.geometry.agent[beside].box()), 0.0);
}

TEST_F(BackingTest, GivingWayHoldsIt) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  here_.traffic.gives_way_left[own] = 5.0;
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::GivesWay);
  EXPECT_EQ(here_.context(own).allowed_speed, 0.0);
}

// two stood for a minute behind a car that went on giving way when the truck before it was gone
TEST_F(BackingTest, GivingWayEndsOnceNobodyNeedsIt) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  const std::size_t other = here_.add("truck", {"EC", "CW"}, 50, 0);
  here_.scene.position[other] = here_.scene.position[own] + Vec2(9.0, 2.0);
  const auto gives_way_after = [&](double stood, double their_wait, std::int64_t their_foe) {
    here_.traffic.gives_way_left[own] = 15.0;
    here_.scene.held[own].standing = stood;
    here_.traffic.waiting_time[other] = their_wait;
    here_.scene.context[other].active = true;
    here_.scene.context[other].foe = their_foe;
    update();
    return here_.traffic.gives_way_left[own] > 0.0;
  };
  EXPECT_TRUE(gives_way_after(8.0, 20.0, -1));
  EXPECT_FALSE(gives_way_after(8.0, 0.0, -1)) << "it drives";
  EXPECT_TRUE(gives_way_after(3.0, 0.0, -1)) << "not at once";
  EXPECT_FALSE(gives_way_after(8.0, 20.0, here_.scene.id[own].value)) << "it waits for this one";
  here_.scene.position[other] = here_.scene.position[own] - Vec2(9.0, 0.0);
  EXPECT_FALSE(gives_way_after(8.0, 20.0, -1)) << "behind";
}

TEST_F(BackingTest, NobodyBacksIntoWhoStandsBehind) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  here_.add("car", {"WC", "CE"}, 100 - 4.5 - 0.4, 0);
  EXPECT_EQ(stand_wedged(own, 40.0), 0.0);
  EXPECT_FALSE(gave_way_) << "who has not moved does not wait for it";
}

TEST_F(BackingTest, StopsInTimeBeforeWhoStandsFartherBehind) {
  const std::size_t own = here_.add("car", {"WC", "CE"}, 100, 0);
  here_.add("car", {"WC", "CE"}, 100 - 4.5 - 1.5, 0);
  const double way = stand_wedged(own, 40.0);
  EXPECT_GT(way, 0.5);
  EXPECT_LT(way, 1.5 - 0.2);
}

// a bus rolled back in a bend, and its front swung into the lorry that drove past it
TEST_F(BackingTest, NobodyBacksOutAcrossTheWayOfWhoDrivesPast) {
  const std::size_t own = here_.add("bus", {"WC", "CE"}, 100, 0, 0, -1, "WC_1");
  // its path lies to its left: back along it the front swings to the right
  here_.move(own, 100, -1.0);
  here_.scene.heading[own] = here_.scene.heading[own] + 0.15;
  const std::size_t past = here_.add("truck", {"WC", "CE"}, 80, 6, 0, -1, "WC_1");
  here_.scene.heading[past] = here_.scene.heading[own] + std::numbers::pi;
  // it comes towards the bus and passes beside its front with 0.3 m to spare
  const Vec2 forward = direction_of(here_.scene.heading[own]);
  const Vec2 side = here_.scene.position[own] - (1.25 + 0.3) * left_of(forward);
  here_.scene.position[past] = side + 14.0 * forward - 1.25 * left_of(forward);
  auto nearest = [&] {
    double least = 10.0;
    const Vec2 heading = direction_of(here_.scene.heading[own]);
    for (const Vec2& corner : here_.scene.footprint[own].outline()) {
      const Vec2 turned = corner.x() * heading + corner.y() * left_of(heading);
      least = std::min(least, (here_.scene.position[own] + turned - side).dot(left_of(forward)));
    }
    return least;
  };
  here_.set_speed(past, 6);
  here_.parameters.stuck = here_.parameters.pressing + 1.0;  // it begins in time
  EXPECT_GT(stand_wedged(own, 14.0), 0.5) << "straight back it swings out to nobody";
  EXPECT_GT(nearest(), 0.2);
}

TEST(RollBack, TheRearAxleNeverSlides) {
  const AgentTypeTable types = default_agent_types();
  for (const char* name : {"bicycle", "car", "bus"}) {
    const AgentType& type = type_of(types, find_agent_type(types, name));
    BodyState body;
    body.heading = 0.7;
    for (int k = 0; k < 100; ++k) {
      const BodyState next = roll_back(type, body, 0.4, 0.45, kDt);
      const Vec2 before = body.position - type.rear_axle_to_center * rotation(body.heading);
      const Vec2 after = next.position - type.rear_axle_to_center * rotation(next.heading);
      const double middle = body.heading + 0.5 * wrap_angle(next.heading - body.heading);
      EXPECT_NEAR(cross(rotation(middle), after - before), 0.0, 1e-9);
      EXPECT_LT((after - before).dot(rotation(middle)), 0.0);
      EXPECT_LE(std::abs(next.steering), type.max_steering + 1e-12);
      body = next;
    }
  }
}

}  // namespace
}  // namespace sumogamma
