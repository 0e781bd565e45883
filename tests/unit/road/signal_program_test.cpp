#include "road/signal_program.h"

#include <gtest/gtest.h>

namespace sumogamma {
namespace {

TEST(SignalProgram, GoesRound) {
  const Signal signal{"S", 1, {{30, "G"}, {3, "y"}, {27, "r"}}};
  const auto expect = [&](double time, std::size_t phase, double since) {
    SCOPED_TRACE(time);
    const auto at = program_at(signal, time);
    ASSERT_TRUE(at.has_value());
    EXPECT_EQ(at->phase, phase);
    EXPECT_DOUBLE_EQ(at->since, since);
  };
  expect(0, 0, 0);
  expect(29.9, 0, 0);
  expect(30, 1, 30);
  expect(59.9, 2, 33);
  expect(60, 0, 60);
  expect(151, 1, 150);
  // before its beginning it is in the round before
  expect(-1, 2, -27);
}

TEST(SignalProgram, IsNowhereWithoutTime) {
  EXPECT_FALSE(program_at({"S", 1, {}}, 5).has_value());
  EXPECT_FALSE(program_at({"S", 1, {{0, "G"}}}, 5).has_value());
}

}  // namespace
}  // namespace sumogamma
