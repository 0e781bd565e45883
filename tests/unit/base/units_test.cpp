#include "base/units.h"

#include <gtest/gtest.h>

#include <limits>

namespace sumogamma {
namespace {

TEST(Units, DegreesAndRadiansUndoEachOther) {
  static_assert(radians(180.0) == kPi);
  static_assert(degrees(kPi) == 180.0);
  for (double angle = -720.0; angle <= 720.0; angle += 7.5)
    EXPECT_NEAR(degrees(radians(angle)), angle, 1e-12 * 720.0);
}

TEST(Units, WrappedAngleIsTheSameDirectionAboveMinusPiUpToPi) {
  for (int step = -500; step <= 500; ++step) {
    const double angle = 0.1 * step;
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
}

TEST(Units, HalfTurnWrapsToPlusPiFromEitherSide) {
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
}

TEST(Units, WrapPassesOnWhatIsNotFinite) {
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_TRUE(std::isnan(wrap_angle(std::numeric_limits<double>::infinity())));
}

//        0            SUMO: degrees clockwise from north
//        |            here: radians counter-clockwise from east
//  270 --+-- 90
//        |
//       180
TEST(Units, SumoAnglesOfTheCompassPoints) {
  EXPECT_NEAR(heading_from_sumo(0.0), kPi / 2.0, 1e-15);     // north
  EXPECT_NEAR(heading_from_sumo(90.0), 0.0, 1e-15);          // east
  EXPECT_NEAR(heading_from_sumo(180.0), -kPi / 2.0, 1e-15);  // south
  EXPECT_NEAR(heading_from_sumo(270.0), kPi, 1e-15);         // west
  EXPECT_EQ(sumo_from_heading(0.0), 90.0);
  EXPECT_EQ(sumo_from_heading(kPi / 2.0), 0.0);
  EXPECT_EQ(sumo_from_heading(kPi), 270.0);
  EXPECT_EQ(sumo_from_heading(-kPi / 2.0), 180.0);
}

TEST(Units, SumoAngleOfAnyHeadingLiesIn0To360AndComesBack) {
  for (int step = -1000; step <= 1000; ++step) {
    const double heading = 0.013 * step;
    const double sumo = sumo_from_heading(heading);
    EXPECT_GE(sumo, 0.0);
    EXPECT_LT(sumo, 360.0);
    EXPECT_NEAR(std::remainder(heading_from_sumo(sumo) - heading, 2.0 * kPi), 0.0, 1e-12);
  }
}

// a tiny turn to the right of north must not print as 360
TEST(Units, SumoAngleJustLeftOfNorthIsNot360) {
  EXPECT_LT(sumo_from_heading(std::nextafter(kPi / 2.0, 4.0)), 360.0);
  EXPECT_LT(sumo_from_heading(kPi / 2.0 + 1e-17), 360.0);
}

}  // namespace
}  // namespace sumogamma
