#include "model/kinematic_set.h"

#include <gtest/gtest.h>

#include "base/units.h"
#include "model/model.h"
#include "model/tracking.h"

namespace sumogamma {
namespace {

class KinematicSetTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    types_ = new AgentTypeTable(default_agent_types());
    Workers workers(2);
    tables_ = new std::vector<KinematicTable>(build_kinematic_tables(*types_, workers));
  }
  static void TearDownTestSuite() {
    delete types_;
    delete tables_;
  }
  static const AgentTypeTable& types() { return *types_; }
  static const std::vector<KinematicTable>& tables() { return *tables_; }

  /// Planes of K for a body at the origin facing +x.
  static ConstraintSet planes(std::size_t type, double speed, double steering) {
    Model model;
    model.types = types();
    model.kinematics = tables();
    Scene scene;
    AgentState agent;
    agent.type = static_cast<AgentTypeId>(type);
    agent.speed = speed;
    append_agent(scene, agent);
    scene.steering[0] = steering;
    ConstraintSet set;
    append_kinematic_constraints(model, scene, 0, Vec2(1, 0), set);
    return set;
  }
  static bool contains(const ConstraintSet& set, const Vec2& v) {
    for (const HalfPlane& plane : set.planes)
      if (slack(plane, v) < -1e-9) return false;
    return true;
  }

 private:
  static inline AgentTypeTable* types_ = nullptr;
  static inline std::vector<KinematicTable>* tables_ = nullptr;
};

TEST_F(KinematicSetTest, StandingIsAlwaysInAndGoingBackwardsNeverOnWheels) {
  for (std::size_t type = 0; type < types().size(); ++type)
    for (double speed : {0.0, 0.3, 2.0, 7.7, 20.0})
      for (double share : {-1.0, -0.3, 0.0, 1.0}) {
        SCOPED_TRACE(types()[type].name);
        const ConstraintSet set = planes(type, speed, share * types()[type].max_steering);
        EXPECT_TRUE(contains(set, Vec2(0, 0)));
        if (types()[type].kinematics == Kinematics::Holonomic) continue;
        EXPECT_FALSE(contains(set, Vec2(-0.1, 0)));
        EXPECT_FALSE(contains(set, Vec2(0, 0.5))) << "sideways";
        EXPECT_FALSE(contains(set, Vec2(0, -0.5)));
      }
}

TEST_F(KinematicSetTest, WhatEquationOneAdmitsIsIn) {
  // Eq. 1 at the table's own nodes: every tracked velocity lies in the hull
  for (std::size_t type = 0; type < types().size(); ++type) {
    const AgentType& t = types()[type];
    if (t.kinematics == Kinematics::Holonomic) continue;
    SCOPED_TRACE(t.name);
    for (double speed : {0.0, 0.5}) {
      const ConstraintSet set = planes(type, speed, 0);
      for (int angle = -10; angle <= 10; angle += 5)
        for (double target = 0.2; target < 2.0; target += 0.2) {
          const Vec2 v = target * direction_of(radians(angle));
          if (tracking_error(t, speed, 0, v, t.horizon) <= t.tracking_error) {
            // a tenth less: the grid of speeds and angles is that coarse
            EXPECT_TRUE(contains(set, 0.9 * v)) << v.transpose();
          }
        }
    }
  }
}

TEST_F(KinematicSetTest, WhatCanNotBeTrackedIsOut) {
  for (std::size_t type = 0; type < types().size(); ++type) {
    const AgentType& t = types()[type];
    SCOPED_TRACE(t.name);
    // far beyond what the accelerator gives within the tolerated error
    const double leap = std::sqrt(2 * t.max_acceleration * t.tracking_error) + 1.5;
    if (2.0 + leap < t.max_speed) {
      EXPECT_FALSE(contains(planes(type, 2.0, 0), Vec2(2.0 + leap, 0)));
    }
  }
}

TEST_F(KinematicSetTest, FasterBodiesHaveANarrowerWedge) {
  const std::size_t car = static_cast<std::size_t>(find_agent_type(types(), "car"));
  double last = 10;
  for (double speed : {1.0, 5.0, 10.0, 20.0, 30.0}) {
    const double widest = heading_of(tables()[car].at(speed, 0).left);
    EXPECT_LE(widest, last + 1e-6) << speed;
    EXPECT_GT(widest, 0);
    last = widest;
  }
  EXPECT_LT(last, radians(6));
}

TEST_F(KinematicSetTest, IsTheSameForAnyNumberOfWorkersAndMirrored) {
  Workers one(1);
  const std::vector<KinematicTable> again = build_kinematic_tables(types(), one);
  for (std::size_t type = 0; type < types().size(); ++type)
    for (double speed : {0.0, 1.3, 9.0})
      for (double share : {-0.7, 0.0, 0.4}) {
        const double steering = share * types()[type].max_steering;
        const KinematicSet a = tables()[type].at(speed, steering),
                           b = again[type].at(speed, steering);
        for (std::size_t k = 0; k < tables()[type].normals().size(); ++k)
          EXPECT_EQ(a.support[k], b.support[k]);
        EXPECT_EQ(a.left, b.left);
        const KinematicSet mirrored = tables()[type].at(speed, -steering);
        if (tables()[type].has_sides()) {
          EXPECT_NEAR((a.left - Vec2(mirrored.right.x(), -mirrored.right.y())).norm(), 0, 1e-9);
        }
      }
}

TEST_F(KinematicSetTest, HugeAndBrokenStatesAreClamped) {
  for (const KinematicTable& table : tables())
    for (double speed : {-5.0, 1e9, std::nan("")})
      for (double steering : {-9.0, 9.0, std::nan("")}) {
        const KinematicSet set = table.at(speed, steering);
        for (std::size_t k = 0; k < table.normals().size(); ++k) EXPECT_GE(set.support[k], 0);
        EXPECT_TRUE(set.left.allFinite());
      }
}

}  // namespace
}  // namespace sumogamma
