#include <gtest/gtest.h>

#include "model/context.h"
#include "model/gamma_velocity.h"
#include "model/preferred_velocity.h"
#include "model/tracking.h"
#include "scene/locate.h"
#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::RoadScene;

class ContextTest : public ::testing::Test {
 protected:
  ConstraintSet planes_of(std::size_t row) const {
    ConstraintSet set;
    append_contextual_constraints(here_.model, here_.scene, row, set);
    return set;
  }
  bool admits(std::size_t row, const Vec2& velocity) const {
    for (const HalfPlane& plane : planes_of(row).planes)
      if (slack(plane, velocity) < -1e-9) return false;
    return true;
  }
  /// Somebody of a type at a place [m] on a line of its own, with this room to either side [m], as
  /// fast as the line allows throughout [m/s].
  std::size_t add_on(const std::vector<Vec2>& line, const char* name, const char* lane, double room,
                     double along, double speed) {
    Path path;
    path.line = Polyline(line);
    PathStretch stretch;
    stretch.lane = here_.model.road.lane_by_name.at(lane);
    stretch.to = path.line.length();
    stretch.speed_limit = 6;
    stretch.room_left = stretch.room_right = room;
    path.stretches = {stretch};
    path.speed_profile = PackedValues(std::vector<double>(26, speed));
    const AgentTypeId type = find_agent_type(here_.model.types, name);
    path.walking = type_of(here_.model.types, type).kinematics == Kinematics::Holonomic;
    return here_.add(type, std::make_shared<const Path>(std::move(path)), along, speed);
  }
  /// One step of the model and the body.
  void drive(std::size_t row, Workspace& work) {
    here_.update();
    const Vec2 asked = gamma_velocity(here_.model, here_.scene, here_.geometry, row,
                                      here_.scene.behavior[row], work);
    place_body(track_velocity(here_.model, here_.scene, row, asked, 0.05), here_.scene, row);
  }
  RoadScene here_{testing::small_net()};
};

TEST_F(ContextTest, OffTheRoadNothingIsSaid) {
  const std::size_t own = here_.add("car", {"in", "out"}, 40, 5);
  here_.scene.path[own] = kNoPath;
  here_.update();
  EXPECT_FALSE(here_.context(own).active);
  EXPECT_TRUE(planes_of(own).planes.empty());
}

// two people stood nose to nose on a sidewalk for 410 s: where the way bends each was ahead of the
// other
TEST_F(ContextTest, OfTwoOnFootWhoFollowEachOtherOneGoes) {
  const std::size_t first = here_.add("pedestrian", {"in"}, 40, 0);
  const std::size_t second = here_.add("pedestrian", {"in"}, 40.5, 0);
  here_.update(2);
  ASSERT_EQ(here_.context(first).reason, LimitReason::Leader);
  here_.scene.context[second].reason = LimitReason::Leader;
  here_.scene.context[second].foe = here_.scene.id[first].value;
  here_.update();
  EXPECT_NE(here_.context(first).reason, LimitReason::Leader);
}

TEST_F(ContextTest, AtmostTheRoomOverTheHorizonSideways) {
  const std::size_t own = here_.add("pedestrian", {"in"}, 40, 1);
  here_.update();
  const RoadContext& context = here_.context(own);
  // sidewalk of 2 m, body of 0.48 m in its middle
  EXPECT_NEAR(context.room_left, 1.0 - 0.24, 1e-9);
  EXPECT_NEAR(context.room_right, 1.0 - 0.24, 1e-9);
  const double horizon = type_of(here_.model.types, here_.scene.type[own]).horizon;
  const double limit = context.room_left / horizon;
  EXPECT_TRUE(admits(own, {1.0, limit - 1e-6}));
  EXPECT_FALSE(admits(own, {1.0, limit + 1e-3}));
  EXPECT_FALSE(admits(own, {1.0, -limit - 1e-3}));
}

TEST_F(ContextTest, BeyondTheBoundaryOnlyBackOrAlong) {
  const std::size_t own = here_.add("pedestrian", {"in"}, 40, 1);
  here_.move(own, 40, 1.5);
  here_.update();
  EXPECT_LT(here_.context(own).room_left, 0.0);
  EXPECT_TRUE(admits(own, Vec2::Zero()));
  EXPECT_TRUE(admits(own, {1.0, 0.0}));
  EXPECT_TRUE(admits(own, {1.0, -0.5}));
  EXPECT_FALSE(admits(own, {1.0, 0.1}));
}

// A bicycle that keeps to the inside of its lane leaves that place in a bend which it could not
// turn there, and doesn't cut it.
TEST_F(ContextTest, NobodyAimsFurtherInThanItCanTurn) {
  constexpr double kRadius = 1.4, kAside = 0.6;
  std::vector<Vec2> line = {{-10, 0}};
  for (int degrees = 0; degrees <= 180; degrees += 5)
    line.push_back(
        {kRadius * std::sin(radians(degrees)), kRadius - kRadius * std::cos(radians(degrees))});
  line.push_back({-10, 2 * kRadius});
  const std::size_t own = add_on(line, "bicycle", "in_1", 3.0, 10.0 + 0.5 * kPi * kRadius, 1.0);
  const auto aside_at = [&](double aim) {
    here_.traffic.lateral_aim[own] = aim;
    here_.update();
    const RoadContext& context = here_.context(own);
    return (context.sub_goal - here_.scene.position[own]).dot(left_of(context.tangent));
  };
  const double on_path = aside_at(0.0);
  EXPECT_NEAR(aside_at(-kAside) - on_path, -kAside, 1e-9);
  const double tightest = 1.05;  // of its rear axle
  EXPECT_NEAR(aside_at(kAside) - on_path, kRadius - tightest, 0.2);
}

// Who follows a line of short straight pieces at its inside gets on along it by jumps, which must
// not become jerks: a centimetre here and there is no reason to brake harder.
TEST_F(ContextTest, BrakesSteadilyThoughItGetsOnByJumps) {
  constexpr double kBraking = 2.5, kTop = 12.0, kStep = 0.05, kJerk = 3.0;
  const std::size_t own = add_on({{0, 0}, {25, 0}}, "car", "in_1", 2.0, 10.0, kTop);
  Path path = *here_.road.path(here_.scene.path[own]);
  std::vector<double> profile(path.speed_profile.size());
  for (std::size_t i = 0; i < profile.size(); ++i)
    profile[i] =
        std::sqrt(kTop * kTop - 2.0 * kBraking * static_cast<double>(i) * Path::kProfileStep);
  path.speed_profile = PackedValues(profile);
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[own])] =
      std::make_shared<const Path>(path);
  const auto limit_at = [&](double along) {
    here_.move(own, along, 0.0);
    here_.scene.speed[own] = path.profile_at(10.0);
    here_.scene.preferred_speed[own] = kTop;
    here_.update();
    return here_.context(own).speed_limit;
  };
  const double there = limit_at(10.0);
  EXPECT_NEAR((here_.scene.speed[own] - there) / kStep, kBraking, 0.1);
  EXPECT_NEAR(limit_at(10.08), there, kJerk * kStep * kStep);
  EXPECT_LT(limit_at(10.08), there);
}

// A car across the road, its front over the left boundary: it comes back by turning towards its
// way, the short way round, however far it points beyond.
TEST_F(ContextTest, WhoPointsOutwardComesBackTheShortWay) {
  for (const double heading : {0.9, 1.5, 1.7, 2.2}) {
    RoadScene here{testing::small_net()};
    const std::size_t own = here.add("car", {"in", "out"}, 40, 0.5);
    here.move(own, 40, 3.0);
    here.scene.heading[own] = heading;
    here.scene.velocity[own] = 0.5 * direction_of(heading);
    here.update();
    ConstraintSet set;
    append_contextual_constraints(here.model, here.scene, own, set);
    const auto admitted = [&](double turn) {
      const Vec2 velocity = 0.4 * direction_of(heading + turn);
      for (std::size_t k = 0; k < set.planes.size(); ++k)
        if (set.sources[k].kind == ConstraintKind::LaneBoundary &&
            slack(set.planes[k], velocity) < -1e-9)
          return false;
      return true;
    };
    EXPECT_TRUE(admitted(-0.45)) << heading;
    EXPECT_FALSE(admitted(0.3)) << heading;
  }
}

// who is wedged on a junction finds its way round others beyond the boundary, no further than its
// own width asks for: bicycles left a path of a metre by three, and came back through those who
// came
TEST_F(ContextTest, WhoIsWedgedGetsRoundByItsOwnWidthOnAJunction) {
  const std::vector<Vec2> line = {{-10, 0}, {60, 0}};
  for (const auto& [name, lane, goes] :
       {std::tuple{"bicycle", ":C_0_0", false}, {"car", ":C_0_0", true}, {"car", "in_1", false}}) {
    const std::size_t own = add_on(line, name, lane, -1.5, 20.0, 0.3);
    here_.scene.held[own].wedge_left = 5.0;
    here_.scene.heading[own] = 0.5 * kPi;
    here_.scene.velocity[own] = Vec2(0, 0.3);
    here_.update();
    EXPECT_LT(here_.context(own).room_left, -1.5);
    EXPECT_EQ(admits(own, {0, 0.3}), goes) << name << " on " << lane;
  }
}

// a bicycle wedged in a crowd turned out over the middle of a path of two metres, and rode there
// until it had turned back
TEST_F(ContextTest, TheMiddleOfWhoIsWedgedStaysOnItsCarriageway) {
  const std::size_t own = add_on({{-10, 0}, {60, 0}}, "bicycle", "in_1", 0.5, 20.0, 0.3);
  const auto edge_at = [&](double offset, double heading) {
    here_.move(own, 20.0, offset);
    here_.scene.heading[own] = heading;
    here_.update();
    return here_.context(own).edge_left;
  };
  EXPECT_NEAR(edge_at(0.2, 0.0), 0.3, 1e-6);
  EXPECT_NEAR(edge_at(0.2, -0.5), 0.3, 1e-6) << "it comes back anyway";
  EXPECT_LT(edge_at(0.2, 0.8), 0.1) << "by turning back it gets further out";
  EXPECT_LT(edge_at(0.55, 0.0), 0.0);
}

TEST_F(ContextTest, WhoIsWedgedCreepsRoundOthersOnItsCarriageway) {
  const std::size_t own = add_on({{-10, 0}, {60, 0}}, "bicycle", "in_1", 0.5, 20.0, 2.0);
  const std::size_t wall = add_on({{-10, 0}, {60, 0}}, "pedestrian", "in_1", 3.0, 22.0, 0.0);
  here_.move(wall, 21.5, 0.2);
  here_.move(own, 20.0, -0.2);
  here_.scene.heading[own] = -0.8;
  Workspace work;
  double most = 0;
  for (int tick = 0; tick < 200; ++tick) {
    here_.scene.held[own].wedge_left = 5.0;
    here_.scene.held[wall].standing = 60.0;
    drive(own, work);
    locate_on_path(here_.model.road, here_.road, here_.scene, own);
    most = std::max(most, std::abs(here_.scene.position[own].y()));
  }
  EXPECT_LT(most, 0.5 + 0.05);
  EXPECT_GT(here_.scene.position[own].x(), here_.scene.position[wall].x() + 1.0) << "it got round";
}

// bicycles that a turn had carried onto the other side took 20 m to come back
TEST_F(ContextTest, TheBoundaryBeyondItsLaneSlowsNobodyWhoComesBack) {
  const std::size_t own = here_.add("bicycle", {"in", "out"}, 40, 4);
  here_.move(own, 40, 1.4);
  here_.update();
  const double horizon = type_of(here_.model.types, here_.scene.type[own]).horizon;
  const double room = here_.context(own).room_right;
  ASSERT_GT(room, 1.4);
  EXPECT_TRUE(admits(own, {3.5, -1.4 / 1.6}));
  EXPECT_FALSE(admits(own, {3.5, -1.4 / 1.4})) << "no faster than in a second and a half";
  // once it is where it means to be, the boundary counts as ever
  here_.move(own, 40, 0.0);
  here_.update();
  EXPECT_FALSE(admits(own, {3.5, -here_.context(own).room_right / horizon - 0.01}));
}

TEST_F(ContextTest, WheelsNeverGoAgainstTheirDirection) {
  const std::size_t own = here_.add("car", {"in", "out"}, 40, 5);
  here_.update();
  EXPECT_FALSE(admits(own, {-1.0, 0.0}));
  EXPECT_TRUE(admits(own, {1.0, 0.0}));
  // people may step back
  const std::size_t walker = here_.add("pedestrian", {"in"}, 40, 1);
  here_.update();
  EXPECT_TRUE(admits(walker, {-1.0, 0.0}));
}

TEST_F(ContextTest, TheAllowedSpeedCapsTheSpeedAlongThePath) {
  const std::size_t own = here_.add("car", {"in", "out"}, 68, 10);
  here_.road.signal_states[0] = "rr";
  here_.update();
  const double allowed = here_.context(own).allowed_speed;
  ASSERT_LT(allowed, 10.0);
  EXPECT_TRUE(admits(own, {allowed - 1e-6, 0}));
  EXPECT_FALSE(admits(own, {allowed + 1e-3, 0}));
  bool found = false;
  const ConstraintSet set = planes_of(own);
  for (const ConstraintSource& source : set.sources)
    found |= source.kind == ConstraintKind::RoadLimit;
  EXPECT_TRUE(found);
}

TEST_F(ContextTest, TheSubGoalLiesAheadOnThePath) {
  const std::size_t own = here_.add("car", {"in", "out"}, 40, 10);
  here_.update();
  const RoadContext& context = here_.context(own);
  EXPECT_GT(context.sub_goal.x(), 42.25);
  EXPECT_LT(context.sub_goal.x(), 60.0);
  EXPECT_NEAR(context.sub_goal.y(), 0.0, 1e-9);
  EXPECT_NEAR(context.tangent.x(), 1.0, 1e-9);
  EXPECT_NEAR(context.speed_limit, 13.9, 1e-9);
}

TEST_F(ContextTest, ThePlaceThatAnAgentLikesBesideItsPathIsKeptOnTheRoad) {
  const std::size_t own = here_.add("bicycle", {"in", "out"}, 40, 4);
  here_.traffic.lateral_aim[own] = -0.5;
  here_.update();
  EXPECT_NEAR(here_.context(own).sub_goal.y(), -0.5, 1e-9);
  here_.traffic.lateral_aim[own] = -30;
  here_.update();
  // lane of 3.2 m, body of 0.65 m
  EXPECT_NEAR(here_.context(own).sub_goal.y(), -(1.6 - 0.325 - 0.1), 1e-9);
}

// On a circle everybody steers so as to stay on it, and long bodies keep inside where the kerb is.
class BendTest : public ContextTest {
 protected:
  static constexpr double kRadius = 15.0;
  /// Halfway round half a circle at 5 m/s, which the path allows.
  std::size_t add_in_bend(const char* name, double radius = kRadius) {
    std::vector<Vec2> points;
    for (int degrees = 0; degrees <= 180; degrees += 2)
      points.push_back(radius * Vec2(std::cos(radians(degrees)), std::sin(radians(degrees))));
    return add_on(points, name, "in_1", 3.0, 0.5 * kPi * radius, 5.0);
  }
};

TEST_F(BendTest, ASteadyBendIsNotCut) {
  for (const char* name : {"car", "bus"}) {
    const std::size_t own = add_in_bend(name);
    here_.update();
    const AgentType& type = type_of(here_.model.types, here_.scene.type[own]);
    // asked for its present speed along the tangent, the body keeps to the circle
    const double needed = steering_lead(type, 5.0) / kRadius;
    const double asked = heading_of(here_.context(own).tangent) -
                         heading_of(here_.path(own).line.direction_at(0.5 * kPi * kRadius));
    EXPECT_NEAR(wrap_angle(asked), needed, 0.03) << name;
  }
}

// a van that braked from 8 m/s to 4 for a corner began to turn 6 m before it, and drove over the
// end of the sidewalk
TEST_F(BendTest, WhoBrakesForACornerBeginsItAsLateAsItsSpeedThere) {
  constexpr double kSlow = 3.5, kBraking = 2.5, kCorner = 30.0, kTight = 5.0;
  const auto begins_at = [&](double top) {
    std::vector<Vec2> points = {{0, 0}};
    for (int degrees = 0; degrees <= 90; degrees += 5)
      points.push_back(Vec2(kCorner, -kTight) + kTight * direction_of(radians(90 - degrees)));
    points.push_back({kCorner + kTight, -kTight - 20.0});
    const std::size_t own = add_on(points, "van", "in_1", 3.0, 10.0, top);
    Path path = *here_.road.path(here_.scene.path[own]);
    std::vector<double> profile(60, kSlow);
    for (std::size_t i = 0; i < static_cast<std::size_t>(kCorner); ++i) {
      const double left = kCorner - static_cast<double>(i);
      profile[i] = std::min(top, std::sqrt(kSlow * kSlow + 2.0 * kBraking * left));
    }
    path.speed_profile = PackedValues(profile);
    here_.road.paths[static_cast<std::size_t>(here_.scene.path[own])] =
        std::make_shared<const Path>(path);
    for (double along = 10.0; along < kCorner; along += 0.1) {
      here_.move(own, along, 0.0);
      here_.set_speed(own, path.profile_at(along));
      here_.update();
      if (here_.context(own).tangent.y() < -0.05) return along;
    }
    return kCorner;
  };
  const double slowly = begins_at(kSlow);
  EXPECT_GT(slowly, kCorner - 6.0);
  EXPECT_GT(begins_at(8.0), slowly - 1.5);
}

// asked for a velocity aside, of which it makes what lies along its heading, everybody lost some
// speed with every step in a bend, the more the shorter the steps were
TEST_F(BendTest, TheSpeedIsKeptWhileTheBodyTurns) {
  constexpr double kTight = 7.0;
  const std::size_t own = add_in_bend("car", kTight);
  here_.scene.steering[own] = std::atan(2.7 / kTight);
  Workspace work;
  double slowest = 5.0;
  for (int tick = 0; tick < 20; ++tick) {
    drive(own, work);
    slowest = std::min(slowest, here_.scene.speed[own]);
  }
  EXPECT_GT(slowest, 4.95) << slowest;
}

//                     (10.2,12)
//                         |     cycle paths meet in hooks like this one; bicycles cut across it and
//                         |     arrived before the wheels of who waited in the other direction
//   (0,0) ------> (6,0)  _/
//                 (9,-0.8)
TEST_F(BendTest, BicyclesFollowAHook) {
  std::vector<Vec2> points = {Vec2(0, 0), Vec2(6, 0), Vec2(9, -0.8)};
  for (int degrees = -80; degrees <= 0; degrees += 10)
    points.push_back(Vec2(9, 0.4) + 1.2 * direction_of(radians(degrees)));
  points.push_back(Vec2(10.2, 12));
  const std::size_t own = add_on(points, "bicycle", "in_1", 2.0, 2.0, 1.5);
  Workspace work;
  double farthest = 0.0;
  for (int tick = 0; tick < 200; ++tick) {
    drive(own, work);
    const Polyline& line = here_.path(own).line;
    farthest = std::max(farthest, line.project(here_.scene.position[own], 0, 30).distance);
  }
  EXPECT_GT(here_.scene.position[own].y(), 4.0);
  EXPECT_LT(farthest, 0.4);
}

// (0,0) --------> (10,0)
//                   |   somebody who likes to walk a metre to the right would aim at where it is
//                   v   already, inside the corner
//                 (10,-10)
TEST_F(ContextTest, SlowWalkersGetRoundASharpCorner) {
  const std::size_t own =
      add_on({Vec2(0, 0), Vec2(10, 0), Vec2(10, -10)}, "pedestrian", "in_0", 5.0, 5.0, 0.7);
  here_.traffic.lateral_aim[own] = -1.0;
  for (int tick = 0; tick < 400 && here_.scene.path_along[own] < 15; ++tick) {
    here_.update();
    const Vec2 way = here_.context(own).sub_goal - here_.scene.position[own];
    here_.scene.velocity[own] = 0.7 * way.normalized();
    here_.scene.position[own] += 0.05 * here_.scene.velocity[own];
  }
  EXPECT_GE(here_.scene.path_along[own], 15.0);
  EXPECT_NEAR(here_.scene.position[own].x(), 9.0, 0.2);  // and it keeps to its side after it
}

TEST_F(ContextTest, APlannedHaltIsApproachedAndHeld) {
  const std::size_t own = here_.add("bus", {"in", "out"}, 40, 8);
  Path path = here_.path(own);
  path.stops.push_back({70, 20});
  here_.road.paths[static_cast<std::size_t>(here_.scene.path[own])] =
      std::make_shared<const Path>(path);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Stop);
  // with its front at the stop it stands
  here_.move(own, 70 - 6);
  here_.set_speed(own, 0);
  here_.update();
  EXPECT_LT(here_.context(own).allowed_speed, 0.05);
  // served: the next one, of which there is none
  here_.scene.halt[own].next = 1;
  here_.update();
  EXPECT_GT(here_.context(own).allowed_speed, 0.05);
}

TEST_F(ContextTest, ThePathIsPreferredAtTheRoadsSpeed) {
  const std::size_t own = here_.add("car", {"in", "out"}, 40, 10);
  here_.update();
  const Vec2 preferred =
      preferred_velocity(here_.model, here_.scene, own, here_.scene.behavior[own].intention);
  EXPECT_NEAR(preferred.x(), 13.9, 1e-9);
  EXPECT_NEAR(preferred.y(), 0.0, 1e-9);
}

// whoever had waited at a kerb was sent a random way round, once the road was free
TEST_F(ContextTest, WhoIsFreeToGoAfterAWaitGoesAhead) {
  const std::size_t own = add_on({Vec2(0, 0), Vec2(10, 0)}, "pedestrian", "in_0", 5.0, 5.0, 0.7);
  here_.update();
  ASSERT_EQ(here_.context(own).reason, LimitReason::None);
  here_.scene.held[own].standing = 20.0;
  const auto times_turned = [&](double blocked) {
    here_.scene.held[own].blocked = blocked;
    const Vec2 ahead = here_.context(own).sub_goal - here_.scene.position[own];
    int turned = 0;
    for (int second = 0; second < 10; ++second) {
      here_.scene.time = second;
      const Vec2 preferred =
          preferred_velocity(here_.model, here_.scene, own, here_.scene.behavior[own].intention);
      turned += std::abs(cross(preferred, ahead)) > 0.05 * preferred.norm() * ahead.norm();
    }
    return turned;
  };
  EXPECT_EQ(times_turned(0.5), 0) << "a rule held it so far";
  EXPECT_GT(times_turned(5.0), 5) << "bodies hold it";
}

TEST_F(ContextTest, IntentionsAreWhatTheySay) {
  const std::size_t own = here_.add("car", {"in", "out"}, 40, 10);
  here_.update();
  here_.scene.acceleration[own] = {1.0, 0};
  auto preferred = [&](IntentionKind kind, const Vec2& goal = Vec2::Zero()) {
    return preferred_velocity(here_.model, here_.scene, own, {kind, goal});
  };
  EXPECT_EQ(preferred(IntentionKind::Stop), Vec2(0, 0));
  EXPECT_EQ(preferred(IntentionKind::KeepVelocity), here_.scene.velocity[own]);
  EXPECT_NEAR(preferred(IntentionKind::KeepAcceleration).x(), 12.0, 1e-9);
  EXPECT_NEAR(preferred(IntentionKind::Goal, Vec2(40, 300)).y(), 13.9, 1e-9);
  EXPECT_NEAR(preferred(IntentionKind::Goal, Vec2(40, 2)).norm(), 2.0, 1e-9);
  EXPECT_EQ(preferred(IntentionKind::Goal, Vec2(40, 0)), Vec2(0, 0));
  here_.scene.acceleration[own] = {100, 0};
  EXPECT_LE(preferred(IntentionKind::KeepAcceleration).norm(),
            type_of(here_.model.types, here_.scene.type[own]).max_speed + 1e-9);
}

}  // namespace
}  // namespace sumogamma
