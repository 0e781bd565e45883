#include "traffic/junction/signals.h"

#include <gtest/gtest.h>

#include "support/junction_scenes.h"
#include "support/lights.h"
#include "support/road_scene.h"
#include "support/small_net.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;
using testing::show;
using testing::show_across_green;
using testing::SignalTest;

TEST_F(SignalTest, RedStopsAndGreenDoesNot) {
  const std::size_t own = here_.add("car", {"in", "out"}, 68, 10);
  show('r');
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 10.0);
  show('G');
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
  EXPECT_GT(here_.context(own).allowed_speed, 10.0);
}

TEST_F(SignalTest, RedHoldsWhoStandsAtTheLine) {
  const std::size_t own = here_.add("car", {"in", "out"}, 95 - 2.25 - 0.5, 0);
  show('r');
  here_.update();
  EXPECT_EQ(here_.context(own).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own).allowed_speed, 0.1);
}

// A motorcycle that drifted over the edge of its lane while it braked for amber took itself for too
// near to halt, drove on and passed at red.
TEST_F(SignalTest, AmberHoldsWhoGetsOverTheEdgeOfItsLaneAtTheLine) {
  const std::size_t own = here_.add("motorcycle", {"in", "out"}, 60, 0.5);
  const PathLink& link = here_.path(own).links.front();
  const double half = 0.5 * type_of(here_.model.types, here_.scene.type[own]).length;
  show('y');
  for (const double before : {1.0, 0.8, 0.7, 0.65}) {
    here_.move(own, link.stop_line - half - before, 1.5);
    here_.update();
    EXPECT_EQ(here_.context(own).reason, LimitReason::Signal) << before;
    EXPECT_LT(here_.context(own).allowed_speed, 0.5) << before;
  }
}

// A bus that braked for amber came to rest a hand's breadth before its line, as it turned there,
// took itself for too near to halt, rolled on and was over the line at red.
TEST_F(SignalTest, WhoCrawlsBeforeTheLineLateAtAmberStands) {
  const std::size_t own = here_.add("bus", {"in", "out"}, 60, 0.3);
  show('y');
  here_.scene.time = 100;
  auto is_held = [&](double since, double before) {
    here_.road.signal_since.assign(here_.road.signal_states.size(), 100 - since);
    here_.move(own, here_.path(own).links.front().stop_line - 6.0 - before);
    here_.update();
    return here_.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(2.6, 0.1));
  EXPECT_TRUE(is_held(2.0, 0.18));
  EXPECT_FALSE(is_held(0.1, 0.1)) << "it will be over the line in time";
}

// A bicycle that had a green arrow rode past the queue before it in the lane beside, which was red,
// and over that lane's line.
TEST(SignalBeside, WhoRidesWhollyInTheLaneBesideGoesByItsLight) {
  RoadScene here{testing::read_plain_net(testing::crossroads("traffic_light"))};
  const std::size_t own = here.add("bicycle", {"WC", "CE"}, 20, 3, 0, -1, "WC_1");
  auto is_held = [&](double aside, char beside) {
    show(here, "WC_1", 'G');
    show(here, "WC_0", beside);
    here.move(own, here.path(own).links.front().stop_line - 4.0, -aside);
    here.update();
    return here.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(3.2, 'r'));
  EXPECT_FALSE(is_held(3.2, 'G'));
  EXPECT_FALSE(is_held(0.0, 'r')) << "its own lane has green";
  EXPECT_FALSE(is_held(1.5, 'r')) << "on the edge of its lane";
}

// the gap that amber makes: a car that turns left, and one that comes towards it

class AmberGap : public ::testing::Test {
 protected:
  AmberGap() {
    own_ = here_.add("car", {"WC", "CN"}, 20, 0, 0, -1, "WC_1");
    oncomer_ = here_.add("car", {"EC", "CW"}, 20, 10, 0, -1, "EC_0");
    here_.scene.time = 100;
    stand(0.5, 80);
    come(50);
  }
  /// The one that turns stands so far before its line [m], since a time [s].
  void stand(double before, double since) {
    const PathLink& link = here_.path(own_).links.front();
    here_.move(own_, link.stop_line - 2.25 - before);
    here_.traffic.halted_for[own_] = link.connection;
    here_.traffic.halted_at[own_] = since;
  }
  /// The other comes at 10 m/s, with so much way to its line [m].
  void come(double before) {
    here_.move(oncomer_, here_.path(oncomer_).links.front().stop_line - 2.25 - before, 10);
  }
  /// What holds the one that turns so long after both lights showed a letter [s].
  LimitReason held_by(char letter, double since) {
    show(here_, "WC_1", letter);
    show(here_, "EC_0", letter);
    here_.road.signal_since.assign(here_.road.signal_states.size(), 100 - since);
    here_.update();
    return here_.context(own_).reason;
  }
  RoadScene here_{read_plain_net(crossroads("traffic_light"))};
  std::size_t own_ = 0, oncomer_ = 0;
};

TEST_F(AmberGap, IsTakenByWhoStoodAtItsLine) {
  EXPECT_EQ(held_by('g', 15), LimitReason::Yield);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::None);
  EXPECT_EQ(held_by('y', 2.2), LimitReason::Signal) << "it would not be over the line before red";
  EXPECT_EQ(held_by('r', 0.5), LimitReason::Signal);
}

TEST_F(AmberGap, IsNotForWhoComesLate) {
  stand(0.5, 99.8);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Signal);
  stand(3.0, 80);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Signal) << "not near its line";
}

TEST_F(AmberGap, IsNoneBeforeWhoCannotHaltAtEase) {
  come(15);
  EXPECT_EQ(held_by('y', 0.5), LimitReason::Yield);
}

TEST_F(SignalTest, WhoStandsDownTheQueueKnowsThatItIsRed) {
  const std::size_t own = here_.add("car", {"in", "out"}, 30, 0);
  here_.scene.held[own].standing = 5.0;
  show('r');
  here_.update();
  EXPECT_TRUE(here_.context(own).at_red);
  show('G');
  here_.update();
  EXPECT_FALSE(here_.context(own).at_red);
}

TEST_F(SignalTest, AmberStopsWhoCanStopAtEaseAndLetsTheOthersThrough) {
  show('y');
  const std::size_t far = here_.add("car", {"in", "out"}, 50, 10);
  here_.update();
  EXPECT_EQ(here_.context(far).reason, LimitReason::Signal);
  RoadScene other(testing::small_net());
  other.road.signal_states[0] = "yr";
  const std::size_t near = other.add("car", {"in", "out"}, 83, 13);
  other.update();
  EXPECT_NE(other.context(near).reason, LimitReason::Signal);
}

// Amber of one second: who reckoned with two and a half drove on from where it could halt still,
// and passed at red.
TEST_F(SignalTest, WhoGetsOverNoMoreWithinAShortAmberBrakesAsHardAsItCan) {
  const std::size_t own = here_.add("car", {"in", "out"}, 60, 13);
  show('y');
  here_.scene.time = 100;
  here_.road.signal_since.assign(here_.road.signal_states.size(), 100);
  auto is_held = [&](double lasts, double before) {
    here_.road.amber_until.assign(here_.road.signal_states.size(), 100 + lasts);
    here_.move(own, here_.path(own).links.front().stop_line - 2.25 - before);
    here_.update();
    return here_.context(own).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(is_held(1.0, 14.5));
  EXPECT_FALSE(is_held(1.0, 12.5)) << "it gets over";
  EXPECT_FALSE(is_held(3.0, 14.5)) << "it gets over";
}

TEST_F(SignalTest, WhoIsInsideClearsTheJunction) {
  show('r');
  const std::size_t own = here_.add("car", {"in", "out"}, 97, 5);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
  EXPECT_GT(here_.context(own).allowed_speed, 5.0);
}

TEST_F(SignalTest, AnUnknownStateIsNoSignal) {
  here_.road.signal_states.clear();
  const std::size_t own = here_.add("car", {"in", "out"}, 60, 10);
  here_.update();
  EXPECT_NE(here_.context(own).reason, LimitReason::Signal);
}

/// W to E over two signals with ten metres between them; a road from N crosses at the second.
RoadNetwork two_boxes() {
  testing::PlainNet plain;
  plain.nodes =
      "<node id='W' x='-100' y='0'/><node id='E' x='200' y='0'/>"
      "<node id='A' x='0' y='0' type='traffic_light'/>"
      "<node id='B' x='24' y='0' type='traffic_light'/><node id='N' x='0' y='100'/>"
      "<node id='S' x='0' y='-100'/><node id='M' x='24' y='100'/><node id='T' x='24' y='-100'/>";
  for (const std::string road : {"WA", "AB", "BE", "NA", "AS", "MB", "BT"})
    plain.edges += "<edge id='" + road + "' from='" + road[0] + "' to='" + road[1] +
                   "' numLanes='1' speed='13'/>";
  return read_plain_net(plain);
}

// Buses stood between the boxes that one crossing of dual carriageways is drawn as, at red lights
// that no such crossing has, and shut the first.
TEST(InnerSignal, WhoGotGreenAtTheOuterOneClearsTheJunction) {
  RoadScene here(two_boxes());
  const std::size_t own = here.add("car", {"WA", "AB", "BE"}, 0, 0);
  const PathLink link = here.path(own).links.at(1);
  ASSERT_GT(here.model.road.connection(link.connection).storage, 0.0);
  const std::size_t foe = here.add("car", {"MB", "BT"}, 0, 0);
  const PathLink their = here.path(foe).links.at(0);
  here.move(own, link.stop_line - 0.6 - 2.25);
  for (std::size_t i = 0; i < here.model.road.signals.size(); ++i)
    here.road.signal_states[i].assign(here.model.road.signals[i].size, 'r');
  here.road.signal_since.assign(here.model.road.signals.size(), 0.0);
  const Connection& green = here.model.road.connection(their.connection);
  here.road.signal_states[index_of(green.signal)][static_cast<std::size_t>(green.signal_link)] =
      'G';
  // who stands at its line, and has just got green, lets it go first
  here.set_speed(own, 1.0);
  here.move(foe, their.stop_line - 0.6 - 2.25);
  here.scene.time = 2.0;
  here.update(2);
  EXPECT_GT(here.context(own).allowed_speed, 0.3);
  EXPECT_LT(here.context(foe).allowed_speed, 0.3);
  EXPECT_EQ(here.context(foe).foe, here.scene.id[own].value);
  // later on it gives way
  here.scene.time = 30.0;
  here.set_speed(own, 0.0);
  here.set_speed(foe, 10.0);
  here.move(foe, their.stop_line - 20.0);
  here.update(2);
  EXPECT_LT(here.context(own).allowed_speed, 0.3);
  EXPECT_EQ(here.context(own).foe, here.scene.id[foe].value);
  EXPECT_GT(here.context(foe).allowed_speed, 9.0);
  // and goes where nobody comes
  here.move(foe, here.path(foe).arrival - 5.0);
  here.update(2);
  EXPECT_GT(here.context(own).allowed_speed, 0.3);
}

// going at red: the crossroads with signals, where the south-north road shows red

class RedLightRunning : public ::testing::Test {
 protected:
  RedLightRunning() {
    show_across_green(here_, 'r');
    own_ = here_.add("motorcycle", {"SC", "CN"}, 0, 0);
    here_.scene.manners[own_].key = 1;
    here_.move(own_, here_.path(own_).links.front().halt - 1.1 - 0.7);
    here_.scene.held[own_].standing = 1.0;
  }
  static const RoadNetwork& net() {
    static const RoadNetwork network = read_plain_net(crossroads("traffic_light"));
    return network;
  }
  void set_rate(double rate) {
    for (AgentType& type : here_.model.types) type.compliance.red_light_running = rate;
  }
  RoadScene here_{net()};
  std::size_t own_ = 0;
};

// a bus that was left on the junction stood in everybody's way for the whole of the next green
TEST_F(RedLightRunning, WhoIsLeftOnTheJunctionLeavesItBeforeOthersCome) {
  const std::size_t left = here_.add("bus", {"SC", "CN"}, 0, 0);
  here_.move(left, here_.path(left).links.front().stop_line + 0.5 - 6.0);
  const std::size_t green = here_.add("car", {"WC", "CE"}, 0, 0, 0, -1, "WC_0");
  here_.move(green, here_.path(green).links.front().stop_line - 2.25 - 0.7);
  for (const std::size_t row : {left, green}) {
    here_.scene.context[row].reason = LimitReason::Yield;
    here_.scene.context[row].foe = here_.scene.id[row == left ? green : left].value;
    here_.traffic.waiting_time[row] = 30;
  }
  here_.road.signal_since.assign(here_.road.signal_states.size(), here_.scene.time - 2.0);
  here_.update();
  EXPECT_EQ(here_.context(green).foe, here_.scene.id[left].value);
  EXPECT_NE(here_.context(left).foe, here_.scene.id[green].value);
  // but not for ever
  here_.road.signal_since.assign(here_.road.signal_states.size(), here_.scene.time - 25.0);
  here_.scene.context[left].reason = LimitReason::Leader;
  here_.update();
  EXPECT_NE(here_.context(green).foe, here_.scene.id[left].value);
}

TEST_F(RedLightRunning, WhoKeepsTheRuleStaysThoughTheWayIsFree) {
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own_).allowed_speed, 0.1);
}

TEST_F(RedLightRunning, WhoDoesNotGoesWhereTheWayIsFree) {
  set_rate(1.0);
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::None);
  EXPECT_GT(here_.context(own_).allowed_speed, 0.1);
}

TEST_F(RedLightRunning, WhoCreepsWaitsOverTheLine) {
  const PathLink& link = here_.path(own_).links.front();
  ASSERT_EQ(link.halt, link.stop_line);
  here_.update();  // halts
  here_.scene.time += 60.0;
  const auto waits_at = [&](double over_line) {
    here_.move(own_, link.stop_line - 1.1 + over_line);
    here_.update();
    EXPECT_EQ(here_.context(own_).reason, LimitReason::Signal);
    return here_.context(own_).allowed_speed < 0.1;
  };
  EXPECT_TRUE(waits_at(-0.6));
  for (AgentType& type : here_.model.types) type.compliance.creeping = 1.0;
  EXPECT_FALSE(waits_at(-0.6));
  EXPECT_FALSE(waits_at(0.1));
  EXPECT_TRUE(waits_at(0.6)) << "it goes no further";
}

TEST_F(RedLightRunning, ItHaltsFirst) {
  set_rate(1.0);
  here_.move(own_, here_.path(own_).links.front().halt - 15);
  here_.set_speed(own_, 8);
  here_.scene.held[own_].standing = 0.0;
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Signal);
  EXPECT_LT(here_.context(own_).allowed_speed, 8.0);
}

TEST_F(RedLightRunning, ItWaitsForWhoHasGreen) {
  set_rate(1.0);
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 165, 12);
  here_.update();
  EXPECT_EQ(here_.context(own_).reason, LimitReason::Yield);
  EXPECT_EQ(here_.context(own_).foe, here_.scene.id[foe].value);
  EXPECT_LT(here_.context(own_).allowed_speed, 0.1);
  EXPECT_GT(here_.context(foe).allowed_speed, 12.0);
}

TEST_F(RedLightRunning, ItWaitsForWhoGoesAtRedToo) {
  set_rate(1.0);
  const std::size_t foe = here_.add("car", {"NC", "CE"}, 0, 4);
  here_.scene.manners[foe].key = 2;
  here_.move(foe, here_.path(foe).links.front().halt - 6);
  here_.update();
  EXPECT_EQ(here_.context(own_).foe, here_.scene.id[foe].value);
}

}  // namespace
}  // namespace sumogamma
