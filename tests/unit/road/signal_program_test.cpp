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

TEST(SignalProgram, ShowsALinkItsLight) {
  RoadNetwork network;
  network.signals = {{"S", 2, {{30, "Gr"}, {3, "yr"}, {27, "r"}}}};
  Connection first, second, free;
  first.signal = second.signal = static_cast<SignalId>(0);
  first.signal_link = 0;
  second.signal_link = 1;
  EXPECT_EQ(light_by_program(network, first, 10), Light::GreenFirst);
  EXPECT_EQ(light_by_program(network, second, 10), Light::Red);
  EXPECT_EQ(light_by_program(network, first, 31), Light::Amber);
  EXPECT_EQ(light_by_program(network, first, 40), Light::Red);
  EXPECT_EQ(light_by_program(network, second, 40), Light::None) << "the program is too short";
  EXPECT_EQ(light_by_program(network, free, 40), Light::None);
}

}  // namespace
}  // namespace sumogamma
