#include "traffic/junction/turning_room.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/road_scene.h"
#include "traffic/junction/arbitration.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

// narrow corners: a bus from the west that turns right, into the south, sweeps the end of SC
class TurningRoomTest : public ::testing::Test {
 protected:
  static const RoadNetwork& net() {
    static const RoadNetwork network =
        read_plain_net(crossroads("priority", {"--default.junctions.radius", "3"}));
    return network;
  }
  std::size_t add_bus(const std::string& type = "bus") {
    const std::size_t bus = here_.add(type, {"WC", "CS"}, 0, 4);
    here_.move(bus, here_.path(bus).links.front().stop_line - 12.0);
    return bus;
  }
  /// Somebody on SC whose front is so far before its stop line.
  std::size_t add_waiting(double before, double speed) {
    const std::size_t car = here_.add("car", {"SC", "CN"}, 0, speed);
    here_.move(car, here_.path(car).links.front().stop_line - before - 2.25);
    return car;
  }
  double halt_of(std::size_t row) {
    const PathLink& link = here_.path(row).links.front();
    const Traveller traveller{row, here_.scene.path_along[row] + 2.25, 4.5, 5.0};
    return link.halt - halt_for_long_bodies(here_.view(), traveller, link);
  }
  /// Where the first link of `row` and that of `other` are in each other's way, for cars; the foe
  /// there is `other`.
  const SweptWay* shared_way(std::size_t row, std::size_t other, bool other_is_long) {
    const ConnectionId foe = here_.path(other).links.front().connection;
    const auto& ways = here_.model.swept_ways[index_of(here_.path(row).links.front().connection)];
    const auto way = std::find_if(ways.begin(), ways.end(), [&](const SweptWay& each) {
      return each.foe == foe && each.foe_sweeps == other_is_long && !each.for_wide &&
             each.body == TurningBody::Bus;
    });
    return way != ways.end() ? &*way : nullptr;
  }
  /// Moves a car so that its front is so far before the place that a way tells [m].
  void come_up_to(const SweptWay& way, std::size_t car, double before) {
    here_.move(car, here_.path(car).links.front().stop_line + way.begin - before - 2.25);
  }
  /// Does a car that drives at a speed halt for the room of somebody, as the scene is?
  bool leaves_room(std::size_t car, double speed) const {
    const Traveller traveller{car, here_.scene.path_along[car] + 2.25, 4.5, speed};
    return leave_turning_room(here_.view(), traveller, here_.path(car).links.front()).must_stop;
  }
  RoadScene here_{net()};
};

TEST_F(TurningRoomTest, WhoWaitsLeavesRoomForABusThatComes) {
  const std::size_t car = add_waiting(30.0, 8.0);
  here_.update();
  EXPECT_EQ(halt_of(car), 0.0) << "nobody comes";
  add_bus();
  here_.update();
  EXPECT_GT(halt_of(car), 2.0);
  EXPECT_LT(halt_of(car), 17.0);
}

// a truck of 7 m needed 75 s of backing and filling round a car at its line, with twenty behind it
TEST_F(TurningRoomTest, WhoWaitsLeavesLessRoomForATruck) {
  const std::size_t car = add_waiting(30.0, 8.0);
  here_.update();
  EXPECT_EQ(halt_of(car), 0.0) << "nobody comes";
  add_bus("truck");
  here_.update();
  const double for_truck = halt_of(car);
  EXPECT_GT(for_truck, 1.0);
  add_bus();
  here_.update();
  EXPECT_GT(halt_of(car), for_truck);
}

TEST_F(TurningRoomTest, ACarThatTurnsNeedsNoMoreThanItsLane) {
  const std::size_t car = add_waiting(30.0, 8.0);
  add_bus("car");
  here_.update();
  EXPECT_EQ(halt_of(car), 0.0);
}

TEST_F(TurningRoomTest, ABusLetsThosePastWhoStandWhereItWillSweep) {
  const std::size_t bus = add_bus();
  here_.update();
  EXPECT_NE(here_.context(bus).reason, LimitReason::TurningRoom);
  const std::size_t car = add_waiting(0.6, 0.0);
  here_.update();
  EXPECT_EQ(here_.context(bus).reason, LimitReason::TurningRoom);
  EXPECT_EQ(here_.context(bus).foe, here_.scene.id[car].value);
  EXPECT_LT(here_.context(bus).allowed_speed, 4.0);
}

// it rolled 7 cm past its place, took that for too late to halt, and stood amid the junction
TEST_F(TurningRoomTest, ABusThatRollsOutALittleFurtherHaltsAllTheSame) {
  const std::size_t bus = add_bus();
  add_waiting(0.6, 0.0);
  here_.move(
      bus, here_.path(bus).links.front().stop_line - TrafficParameters{}.stop_margin + 0.07 - 6.0);
  here_.set_speed(bus, 1.2);
  here_.update();
  EXPECT_EQ(here_.context(bus).reason, LimitReason::TurningRoom);
}

TEST_F(TurningRoomTest, ABusThatHasLetOthersPastForLongGoesOnForAWhile) {
  const std::size_t bus = add_bus();
  here_.move(bus, here_.path(bus).links.front().stop_line - 6.0 - 0.7);
  here_.set_speed(bus, 0.0);
  add_waiting(0.6, 0.0);
  const double waited = here_.held_for(bus, LimitReason::TurningRoom, 60.0);
  EXPECT_NEAR(60.0 - waited, 10.0, 1.5);
  EXPECT_GT(waited, 40.0);
}

// a queue that crept past over its corner held buses for minutes
TEST_F(TurningRoomTest, WhoCreepsUpToThePlaceLetsABusPastThatHasStoodForLong) {
  const std::size_t bus = add_bus();
  here_.move(bus, here_.path(bus).links.front().stop_line - 6.0 - 0.7);
  here_.set_speed(bus, 0.0);
  add_waiting(0.6, 0.0);
  const std::size_t next = add_waiting(30.0, 2.0);
  const SweptWay* way = shared_way(next, bus, true);
  ASSERT_NE(way, nullptr);
  come_up_to(*way, next, 2.0);
  const auto is_held = [&](double stood) {
    here_.scene.held[bus].standing = stood;
    here_.update(2);
    return leaves_room(next, 2.0);
  };
  EXPECT_FALSE(is_held(5.0));
  EXPECT_TRUE(is_held(12.0));
}

// a truck wedged amid its turn shuffled for minutes, since the queue crept on past it
TEST_F(TurningRoomTest, WhoCreepsUpToThePlaceLetsABusOutThatBodiesHaveHeldForLong) {
  const std::size_t bus = add_bus();
  here_.set_speed(bus, 0.0);
  const std::size_t next = add_waiting(30.0, 2.0);
  const SweptWay* way = shared_way(next, bus, true);
  ASSERT_NE(way, nullptr);
  come_up_to(*way, next, 2.0);
  here_.move(bus, here_.path(bus).links.front().stop_line + way->foe_begin + 2.0 - 6.0);
  const auto is_held = [&](double waited, double blocked) {
    here_.traffic.waiting_time[bus] = waited;
    here_.scene.held[bus].blocked = blocked;
    here_.update();
    return leaves_room(next, 2.0);
  };
  EXPECT_FALSE(is_held(5.0, 4.0));
  EXPECT_TRUE(is_held(15.0, 4.0)) << "it stands still only since its last shuffle";
}

// a truck that had driven out to the place stood there for 40 s and went back from it for those who
// came one after another, with its own queue behind it
TEST_F(TurningRoomTest, WhoCreepsUpToThePlaceSoonLetsABusPastThatStandsOnTheJunction) {
  const std::size_t bus = add_bus();
  here_.set_speed(bus, 0.0);
  const std::size_t next = add_waiting(30.0, 2.0);
  const SweptWay* way = shared_way(next, bus, true);
  ASSERT_NE(way, nullptr);
  ASSERT_GT(way->foe_begin, 1.0) << "there is no room to drive out";
  come_up_to(*way, next, 2.0);
  here_.move(bus, here_.path(bus).links.front().stop_line + way->foe_begin - 0.5 - 6.0);
  const auto is_held = [&](double waited, LimitReason reason) {
    here_.traffic.waiting_time[bus] = waited;
    here_.scene.context[bus].reason = reason;
    here_.approaches.rebuild(here_.view());
    return leaves_room(next, 2.0);
  };
  EXPECT_FALSE(is_held(1.0, LimitReason::TurningRoom));
  EXPECT_TRUE(is_held(4.0, LimitReason::TurningRoom));
  EXPECT_TRUE(is_held(4.0, LimitReason::GivesWay)) << "it has backed out";
  EXPECT_FALSE(is_held(4.0, LimitReason::Yield)) << "it waits for somebody else";
}

// a truck and a car each drove on, and the truck stood before the car's side for a minute
TEST_F(TurningRoomTest, ALongBodyLetsWhoCannotHaltAtEaseDriveIn) {
  const std::size_t bus = add_bus();
  const std::size_t car = add_waiting(25.0, 6.0);
  const SweptWay* way = shared_way(bus, car, false);
  ASSERT_NE(way, nullptr);
  here_.move(bus, here_.path(bus).links.front().stop_line + way->begin - 0.5 - 6.0);
  here_.set_speed(bus, 0.6);
  const double place = here_.path(car).links.front().stop_line + way->foe_begin - 2.25;
  const auto is_held_by_one_at = [&](double before) {
    here_.move(car, place - before);
    here_.set_speed(car, 6.0);
    here_.update();
    return here_.context(bus).reason == LimitReason::TurningRoom;
  };
  EXPECT_TRUE(is_held_by_one_at(4.5));
  EXPECT_FALSE(is_held_by_one_at(20.0));
}

// a truck drove into a bend on whose outer side a car stood: its way was free, its nose swung out
TEST_F(TurningRoomTest, WhoStandsOutsideABendIsBesideACarsWayButNotATrucks) {
  const std::size_t car = here_.add("car", {"WC", "CS"}, 0, 4);
  const std::size_t truck = here_.add("truck", {"WC", "CS"}, 0, 4);
  const PathLink& link = here_.path(car).links.front();
  const std::size_t waiting = here_.add("car", {"WC", "CS"}, 0, 0);
  here_.move(waiting, 0.5 * (link.stop_line + link.end), 3.4);
  const auto is_beside = [&](std::size_t row) {
    here_.move(row, link.stop_line - 12.0);
    here_.update();
    const Traveller traveller{row, link.stop_line - 8.0, row == car ? 4.5 : 7.5, 4.0};
    const Approach foe{link.connection, static_cast<std::uint32_t>(waiting), 0, 0, 0, true};
    return stands_beside(here_.view(), traveller, link, 0.0, link.end - link.stop_line, foe);
  };
  EXPECT_TRUE(is_beside(car));
  EXPECT_FALSE(is_beside(truck));
  here_.scene.type[waiting] = find_agent_type(here_.model.types, "pedestrian");
  EXPECT_TRUE(is_beside(truck)) << "on foot one steps back from a nose that swings";
}

// each reckoned to be there first: the bus with who drives, the car with its own 20 cm, and they
// stood nose to nose for minutes
TEST_F(TurningRoomTest, WhoStandsBeforeThePlaceLetsABusPastThatDrives) {
  const std::size_t bus = add_bus();
  const std::size_t car = add_waiting(25.0, 0.0);
  const SweptWay* way = shared_way(car, bus, true);
  ASSERT_NE(way, nullptr);
  come_up_to(*way, car, 0.2);
  here_.move(bus, here_.path(bus).links.front().stop_line + way->foe_begin - 4.0 - 6.0);
  const auto is_held_by_bus_at = [&](double speed) {
    here_.set_speed(bus, speed);
    here_.update();
    return leaves_room(car, 0.0);
  };
  EXPECT_TRUE(is_held_by_bus_at(3.5));
  EXPECT_FALSE(is_held_by_bus_at(0.0)) << "a bus that stands there waits for it";
}

// its trip ended at the end of the lane, so that it looked at no link, and met a bus there
TEST_F(TurningRoomTest, WhoseTripEndsAtTheLineLeavesRoomAllTheSame) {
  const std::size_t car = here_.add("car", {"SC"}, 0, 5);
  here_.move(car, here_.path(car).arrival - 20.0 - 2.25);
  here_.update();
  EXPECT_NE(here_.context(car).reason, LimitReason::TurningRoom);
  const std::size_t bus = add_bus();
  here_.move(bus, here_.path(bus).links.front().stop_line - 6.0);
  here_.update();
  EXPECT_EQ(here_.context(car).reason, LimitReason::TurningRoom);
  EXPECT_EQ(here_.context(car).foe, here_.scene.id[bus].value);
}

TEST_F(TurningRoomTest, ABusWhoseTripEndsAtTheLineSweepsNothingBehindIt) {
  const std::size_t bus = here_.add("bus", {"WC"}, 0, 4);
  here_.move(bus, here_.path(bus).arrival - 12.0);
  add_waiting(0.6, 0.0);
  here_.update();
  EXPECT_NE(here_.context(bus).reason, LimitReason::TurningRoom);
}

// a bus found a car at the line whenever it had green, as the car had red, and stood for minutes
class DrawnLine : public ::testing::Test {
 protected:
  DrawnLine() { show('G'); }
  void show(char state) {
    for (std::string& states : here_.road.signal_states) states = std::string(100, state);
  }
  /// Its front so far before the end of its lane [m].
  void place(double before, double speed) {
    here_.move(car_, link().stop_line - before - 2.25);
    here_.set_speed(car_, speed);
    here_.update();
  }
  const PathLink& link() { return here_.path(car_).links.front(); }
  /// How far before the end of its lane it halts [m].
  double halt() {
    const Traveller traveller{car_, here_.scene.path_along[car_] + 2.25, 4.5, 5.0};
    return link().stop_line - halt_for_long_bodies(here_.view(), traveller, link());
  }
  RoadScene here_{read_plain_net(crossroads("traffic_light", {"--default.junctions.radius", "3"}))};
  std::size_t car_ = here_.add("car", {"SC", "CN"}, 0, 0);
};

TEST_F(DrawnLine, LiesAtASignalBehindWhatABusWouldSweep) {
  place(30.0, 5.0);
  EXPECT_GT(halt(), 4.0);
  EXPECT_LT(halt(), 12.0);
}

// it halted at amber where the bus turns, since it could no longer halt before that
TEST_F(DrawnLine, WhoCannotHaltThereAndGetsOverInTimeDoesAtAmber) {
  show('y');
  here_.scene.time = 100;
  const auto halts_at = [&](double before, double since) {
    here_.road.signal_since.assign(here_.road.signal_states.size(), 100 - since);
    place(before, 9.0);
    return here_.context(car_).reason == LimitReason::Signal;
  };
  EXPECT_TRUE(halts_at(30.0, 0.0)) << "before the line";
  EXPECT_FALSE(halts_at(18.0, 0.0)) << "2.3 m/s^2 would do at the end of its lane";
  EXPECT_TRUE(halts_at(18.0, 2.4)) << "it would not be over in time";
}

// it gave up after 40 s and wedged itself before the queue, which had got green by then
TEST_F(TurningRoomTest, AtASignalABusLetsSomeCyclesPass) {
  const RoadNetwork network =
      read_plain_net(crossroads("traffic_light", {"--default.junctions.radius", "3"}));
  RoadScene here(network);
  for (std::string& states : here.road.signal_states) states = std::string(100, 'G');
  const std::size_t bus = here.add("bus", {"WC", "CS"}, 0, 0);
  here.move(bus, here.path(bus).links.front().stop_line - 6.0 - 0.7);
  const std::size_t car = here.add("car", {"SC", "CN"}, 0, 0);
  here.move(car, here.path(car).links.front().stop_line - 0.6 - 2.25);
  EXPECT_EQ(here.held_for(bus, LimitReason::TurningRoom, 120.0), 120.0);
}

TEST_F(TurningRoomTest, NobodyWaitsForABusThatLetsItPast) {
  const std::size_t bus = add_bus();
  here_.move(bus, here_.path(bus).links.front().stop_line - 6.0 - 0.7);
  here_.set_speed(bus, 0.0);
  const std::size_t car = add_waiting(0.6, 0.0);
  here_.update(2);
  EXPECT_EQ(here_.context(bus).reason, LimitReason::TurningRoom);
  EXPECT_NE(here_.context(car).foe, here_.scene.id[bus].value);
}

// it went on to where one waits on the junction for those who come towards it, though somebody
// stood where it would sweep: there it was in the way of everybody else, for good
TEST_F(TurningRoomTest, ABusThatWouldWaitOnTheJunctionLeavesRoomBeforeIt) {
  const RoadNetwork network = read_plain_net(
      crossroads("priority", {"--default.junctions.radius", "2.5", "--default.lanewidth", "2.75"}));
  RoadScene here(network);
  const std::size_t bus = here.add("bus", {"WC", "CN"}, 0, 0);
  const PathLink& link = here.path(bus).links.front();
  here.move(bus, link.stop_line - 6.0 - 0.7);
  const std::size_t oncoming = here.add("car", {"EC", "CW"}, 0, 10);
  here.move(oncoming, here.path(oncoming).links.front().stop_line - 30.0);
  here.update();
  ASSERT_EQ(here.context(bus).reason, LimitReason::Yield);
  ASSERT_GT(here.context(bus).to_halt, 2.0) << "on the junction";
  const std::size_t car = here.add("car", {"NC", "CS"}, 0, 0);
  here.move(car, here.path(car).links.front().stop_line - 0.6 - 2.25);
  here.update(2);
  EXPECT_EQ(here.context(bus).reason, LimitReason::TurningRoom);
  EXPECT_EQ(here.context(bus).foe, here.scene.id[car].value);
  EXPECT_LT(here.context(bus).to_halt, 0.7);
}

// on its way already, but in nobody's yet: a bus and a lorry met in the bend and stood there for
// good
TEST_F(TurningRoomTest, ABusMayHaltOnTheJunctionWhereItIsInNobodysWay) {
  const std::size_t bus = add_bus();
  const std::size_t car = add_waiting(0.6, 0.0);
  const SweptWay* way = shared_way(bus, car, false);
  ASSERT_NE(way, nullptr);
  ASSERT_GT(way->begin, 1.0);
  auto waits_with_front_at = [&](double past) {
    here_.move(bus, here_.path(bus).links.front().stop_line + past - 6.0);
    here_.set_speed(bus, 0.5);
    here_.update();
    return here_.context(bus).reason == LimitReason::TurningRoom;
  };
  EXPECT_TRUE(waits_with_front_at(way->begin - 0.8));
  EXPECT_FALSE(waits_with_front_at(way->begin + 0.5)) << "there already";
}

// it waited for its exit with its nose where it would turn, and a car that had room before it stood
// there for 35 s, and so did those who waited for the car
TEST_F(TurningRoomTest, WhoHasRoomBesideABusThatWaitsDrivesPast) {
  const std::size_t bus = add_bus();
  const std::size_t car = add_waiting(25.0, 5.0);
  const PathLink& link = here_.path(car).links.front();
  const PathLink& turn = here_.path(bus).links.front();
  const SweptWay* way = shared_way(car, bus, true);
  ASSERT_NE(way, nullptr);
  here_.set_speed(bus, 0.0);
  auto is_held_by_bus_at = [&](double past) {
    here_.move(bus, turn.stop_line + past - 6.0);
    here_.update();
    const Traveller traveller{car, here_.scene.path_along[car] + 2.25, 4.5, 5.0};
    return leave_turning_room(here_.view(), traveller, link).must_stop;
  };
  EXPECT_TRUE(is_held_by_bus_at(way->foe_begin + 2.0));
  const double round = way->foe_begin + 6.0;
  ASSERT_LT(round, way->foe_end + 12.0) << "its tail isn't out of the way that it sweeps";
  EXPECT_FALSE(is_held_by_bus_at(round));
}

}  // namespace
}  // namespace sumogamma
