#include "traffic/lateral/overtaking.h"

#include <gtest/gtest.h>

#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::RoadScene;

// a straight road of 1,200 m with one lane each way; the car drives behind a bicycle
//
//       <- - - - - - - oncoming - - - -
//       car   bicycle                      -> E
PlainNet two_way() {
  PlainNet net;
  net.nodes =
      "<node id='W' x='0' y='0'/><node id='M' x='1200' y='0' type='priority'/>"
      "<node id='E' x='2400' y='0'/>";
  for (const char* edge : {"id='east_1' from='W' to='M'", "id='east_2' from='M' to='E'",
                           "id='west_1' from='E' to='M'", "id='west_2' from='M' to='W'"})
    net.edges += "<edge " + std::string(edge) + " numLanes='1' speed='13.89' width='3.2'/>";
  net.options = {"--opposites.guess", "true"};
  return net;
}

class Overtaking : public ::testing::Test {
 protected:
  double room() {
    here_.update();
    Surroundings around, far;
    look_around(here_.view(), car_, 60.0, 8.0, around);
    return overtaking_room(here_.view(), around, car_, far);
  }
  RoadScene here_{testing::read_plain_net(two_way())};
  std::size_t car_ = here_.add("car", {"east_1", "east_2"}, 300, 5);
  std::size_t bicycle_ = here_.add("bicycle", {"east_1", "east_2"}, 311, 4);
};

TEST_F(Overtaking, MayUseTheOppositeLaneWhereItIsFree) { EXPECT_NEAR(room(), 3.2, 1e-9); }

TEST_F(Overtaking, WaitsForWhoeverComes) {
  // 1200 - 900 on the lane is 300 + 900 on the path: far away, then near
  const std::size_t oncoming = here_.add("car", {"west_2"}, 1200 - 850, 13);
  EXPECT_GT(room(), 0.0);
  here_.move(oncoming, 1200 - 480);
  EXPECT_EQ(room(), 0.0);
  here_.move(oncoming, 1200 - 290);  // gone by
  EXPECT_GT(room(), 0.0);
}

TEST_F(Overtaking, NeedsAGapToReturnInto) {
  const std::size_t truck = here_.add("truck", {"east_1", "east_2"}, 322, 4);
  EXPECT_EQ(room(), 0.0);
  here_.move(truck, 360);
  EXPECT_GT(room(), 0.0);
}

// a car passed one bicycle behind a slower queue, found the gap closed, and stayed over the middle
TEST_F(Overtaking, NeedsAGapThatIsLeftOnceItIsPast) {
  const std::size_t truck = here_.add("truck", {"east_1", "east_2"}, 330, 4);
  EXPECT_GT(room(), 0.0);
  here_.set_speed(truck, 3);
  EXPECT_EQ(room(), 0.0);
}

TEST_F(Overtaking, NotBeforeAJunction) {
  here_.move(car_, 1140);
  here_.move(bicycle_, 1151);
  EXPECT_EQ(room(), 0.0);
}

TEST_F(Overtaking, NobodyIsOvertakenWhoIsHardlySlowerOrNotThere) {
  here_.scene.preferred_speed[car_] = 5.0;
  EXPECT_EQ(room(), 0.0);
  here_.scene.preferred_speed[car_] = 13.9;
  here_.move(bicycle_, 290);
  EXPECT_EQ(room(), 0.0);
}

// the queue ahead of a bicycle was no reason to stay over the middle beside it
TEST_F(Overtaking, WhoIsPastGoesBackUnlessRightBeforeANose) {
  here_.traffic.overtaking_room[car_] = 3.2;
  here_.add("truck", {"east_1", "east_2"}, 330, 4);
  here_.move(car_, 316, 1.7);
  here_.move(bicycle_, 312.2);
  EXPECT_GT(room(), 0.0);
  here_.move(bicycle_, 310.5);
  EXPECT_EQ(room(), 0.0);
}

// a van past one bicycle drove on over the middle towards the next, and gave that up
TEST_F(Overtaking, WhoIsPastOneBeginsWithTheNextAnewOrGoesBack) {
  here_.traffic.overtaking_room[car_] = 3.2;
  const std::size_t next = here_.add("bicycle", {"east_1", "east_2"}, 345, 4);
  here_.move(car_, 318, 1.7);
  here_.set_speed(car_, 10);
  EXPECT_GT(room(), 0.0);
  // near enough to be overtaken by who is at it, too near to begin
  const std::size_t oncoming = here_.add("car", {"west_2"}, 1200 - 550, 13);
  EXPECT_EQ(room(), 0.0);
  here_.move(bicycle_, 200);
  EXPECT_GT(room(), 0.0);
  here_.move(bicycle_, 311);
  here_.move(next, 328);
  here_.move(oncoming, 1200 - 550);
  EXPECT_GT(room(), 0.0) << "no room between the two";
}

TEST_F(Overtaking, WhoIsAbreastGetsPastAndThenBack) {
  here_.traffic.overtaking_room[car_] = 3.2;
  here_.move(car_, 310, 1.7);
  here_.add("car", {"west_2"}, 1200 - 380, 13);
  EXPECT_GT(room(), 0.0);
  here_.move(car_, 302, 1.7);  // behind yet: gives up
  EXPECT_EQ(room(), 0.0);
  // a metre behind, but much faster: one braked with 7 m/s^2 over the middle
  here_.move(car_, 306.8, 1.7);
  EXPECT_EQ(room(), 0.0);
  here_.set_speed(car_, 6.5);
  EXPECT_GT(room(), 0.0);
}

}  // namespace
}  // namespace sumogamma
