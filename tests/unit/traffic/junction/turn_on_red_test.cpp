#include <gtest/gtest.h>

#include "support/lights.h"
#include "support/plain_net.h"
#include "support/road_scene.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

/// Somebody who stands at its line before a light, on crossroads where the south-north road shows
/// `shown` and the other one green.
class TurnOnRed : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("traffic_light"));
    return network;
  }
  void show(char letter) { testing::show_across_green(here_, letter); }
  /// At its line, where it has stood for a second.
  std::size_t waits(const char* to) {
    const std::size_t row = here_.add("car", {"SC", to}, 0, 0);
    here_.move(row, here_.path(row).links.front().halt - 2.25 - 0.7);
    here_.scene.held[row].standing = 1.0;
    return row;
  }
  RoadScene here_{net()};
};

TEST_F(TurnOnRed, WaitsWhereTheLawHasNone) {
  show('r');
  const std::size_t own = waits("CE");
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 0.1);
}

TEST_F(TurnOnRed, GoesAfterItsHaltWhereTheLawHasIt) {
  here_.code.turn_on_red = true;
  show('r');
  const std::size_t own = waits("CE");
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::None);
  EXPECT_GT(here_.context(own).allowed_speed, 0.1);
}

TEST_F(TurnOnRed, NobodyGoesStraightOnOrAcross) {
  here_.code.turn_on_red = true;
  show('r');
  for (const char* to : {"CN", "CW"}) {
    const std::size_t own = waits(to);
    EXPECT_FALSE(goes_at_red(here_.view(), own, here_.path(own).links.front().connection)) << to;
  }
}

TEST_F(TurnOnRed, HaltsFirst) {
  here_.code.turn_on_red = true;
  show('r');
  const std::size_t own = here_.add("car", {"SC", "CE"}, 0, 8);
  here_.move(own, here_.path(own).links.front().halt - 15);
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 8.0);
}

TEST_F(TurnOnRed, LetsThoseGoFirstWhoHaveGreen) {
  here_.code.turn_on_red = true;
  show('r');
  const std::size_t own = waits("CE");
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 165, 12);
  here_.update();
  EXPECT_EQ(here_.context(own).foe, here_.scene.id[foe].value);
  EXPECT_LT(here_.context(own).allowed_speed, 0.1);
  EXPECT_GT(here_.context(foe).allowed_speed, 12.0);
}

TEST_F(TurnOnRed, ASignalThatSaysSoAdmitsItAnywhere) {
  show('s');
  const std::size_t own = waits("CE");
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::None);
  const std::size_t comes = here_.add("car", {"NC", "CW"}, 0, 8);
  here_.move(comes, here_.path(comes).links.front().halt - 15);
  here_.update();
  EXPECT_EQ(here_.context(comes).reason, LimitReason::Signal) << "it hasn't halted";
}

TEST(TurnOnRedCode, IsToTheSideThatTrafficKeepsTo) {
  const TrafficCode code{.turn_on_red = true};
  RoadNetwork network;
  Connection link;
  for (const bool left_hand : {false, true}) {
    network.left_hand = left_hand;
    link.direction = left_hand ? TurnDirection::Left : TurnDirection::Right;
    EXPECT_TRUE(admits_turn_on_red(code, network, link, Light::Red));
    EXPECT_FALSE(admits_turn_on_red({}, network, link, Light::Red));
    EXPECT_FALSE(admits_turn_on_red(code, network, link, Light::Amber));
    link.direction = left_hand ? TurnDirection::Right : TurnDirection::Left;
    EXPECT_FALSE(admits_turn_on_red(code, network, link, Light::Red));
    EXPECT_TRUE(admits_turn_on_red({}, network, link, Light::StopThenGo));
  }
}

}  // namespace
}  // namespace sumogamma
