#include "sumo/sumo_arguments.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"

namespace sumogamma {
namespace {

using Words = std::vector<std::string>;

// the value behind an option, "" where it has none or is missing
std::string value_of(const Words& words, const std::string& option) {
  const auto found = std::find(words.begin(), words.end(), option);
  return found == words.end() || found + 1 == words.end() ? "" : *(found + 1);
}
long times(const Words& words, const std::string& option) {
  return std::count(words.begin(), words.end(), option);
}

TEST(SumoArguments, KeepsHeldVehiclesSafe) {
  SumoArguments wish;
  wish.config = "my city.sumocfg";
  wish.step_length = 0.05;
  const Words words = sumo_arguments(wish);
  EXPECT_EQ(value_of(words, "--configuration-file"), "my city.sumocfg");
  EXPECT_EQ(value_of(words, "--step-length"), "0.05");
  EXPECT_EQ(value_of(words, "--time-to-teleport"), "-1");
  EXPECT_EQ(value_of(words, "--collision.action"), "none");
  EXPECT_EQ(value_of(words, "--pedestrian.model"), "striping");
  EXPECT_EQ(times(words, "--start"), 0);
}

TEST(SumoArguments, PlainSumoKeepsItsOwnRules) {
  SumoArguments wish;
  wish.plain = true;
  const Words words = sumo_arguments(wish);
  EXPECT_EQ(times(words, "--time-to-teleport"), 0);
  EXPECT_EQ(times(words, "--collision.action"), 0);
  EXPECT_EQ(times(words, "--configuration-file"), 0);
}

TEST(SumoArguments, TheWindowStartsAtOnce) {
  SumoArguments wish;
  wish.gui = true;
  EXPECT_EQ(value_of(sumo_arguments(wish), "--start"), "true");
  EXPECT_EQ(value_of(sumo_arguments(wish), "--aggregate-warnings"), "5");
  wish.user = {"-S", "false"};
  EXPECT_EQ(times(sumo_arguments(wish), "--start"), 0);
  EXPECT_EQ(value_of(sumo_arguments(wish), "-S"), "false");
}

// SUMO refuses an option that is given twice
TEST(SumoArguments, TheUsersOptionReplacesOurs) {
  SumoArguments wish;
  wish.own = {"--seed", "1", "--begin", "0", "--scale=2"};
  wish.user = {"--time-to-teleport", "120", "--seed=7", "-b", "100", "--scale", "3"};
  const Words words = sumo_arguments(wish);
  EXPECT_EQ(times(words, "--time-to-teleport"), 1);
  EXPECT_EQ(value_of(words, "--time-to-teleport"), "120");
  EXPECT_EQ(times(words, "--seed"), 0);
  EXPECT_EQ(times(words, "--seed=7"), 1);
  EXPECT_EQ(times(words, "--begin"), 0);
  EXPECT_EQ(value_of(words, "-b"), "100");
  EXPECT_EQ(times(words, "--scale=2"), 0);
  EXPECT_EQ(value_of(words, "--scale"), "3");
}

TEST(SumoArguments, DefaultsGiveWayToTheScenario) {
  SumoArguments wish;
  wish.scenario = {{"time-to-teleport", {"120", {}, false}},
                   {"pedestrian.model", {"nonInteracting", {}, false}},
                   {"num-clients", {"2", {}, false}},
                   {"random", {"true", {}, false}}};
  const Words words = sumo_arguments(wish);
  EXPECT_EQ(times(words, "--time-to-teleport"), 0);
  EXPECT_EQ(value_of(words, "--collision.action"), "none");
  // but not what a run rests on
  EXPECT_EQ(value_of(words, "--pedestrian.model"), "striping");
  EXPECT_EQ(value_of(words, "--num-clients"), "1");
  EXPECT_EQ(value_of(words, "--random"), "false");
  wish.clients = 3;
  EXPECT_EQ(value_of(sumo_arguments(wish), "--num-clients"), "3");
}

TEST(SumoArguments, RefusesWhatWeMustChoose) {
  for (const char* option :
       {"--remote-port", "--num-clients", "--step-length", "--remote-port=5", "--random"}) {
    SumoArguments wish;
    wish.user = {option, "1"};
    EXPECT_THROW(sumo_arguments(wish), Error) << option;
  }
  SumoArguments wish;
  wish.config = "a.sumocfg";
  wish.user = {"-c", "b.sumocfg"};
  EXPECT_THROW(sumo_arguments(wish), Error);
  wish.user = {"stray", "--seed", "1"};
  EXPECT_THROW(sumo_arguments(wish), Error);
}

TEST(SplitOptions, ReadsQuotesAsAShellDoes) {
  EXPECT_EQ(split_options("  --a 1\t--b  'two words' "), (Words{"--a", "1", "--b", "two words"}));
  EXPECT_EQ(split_options("--a \"x 'y'\" b\\ c"), (Words{"--a", "x 'y'", "b c"}));
  EXPECT_EQ(split_options("--a=''"), (Words{"--a="}));
  EXPECT_EQ(split_options("''"), (Words{""}));
  EXPECT_EQ(split_options(""), Words{});
  EXPECT_THROW(split_options("--a 'open"), Error);
}

}  // namespace
}  // namespace sumogamma
