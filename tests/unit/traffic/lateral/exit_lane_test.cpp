#include <gtest/gtest.h>

#include "support/lane_looks.h"
#include "support/road_scene.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::RoadScene;

/// A signalled junction out of which a short road of two lanes leads; who turns left into it comes
/// out on its left lane, who goes straight on either.
PlainNet short_exit() {
  PlainNet net;
  net.nodes =
      "<node id='C' x='0' y='0' type='traffic_light' radius='20'/><node id='W' x='-150' y='0'/>"
      "<node id='N' x='0' y='150'/><node id='M' x='50' y='0'/><node id='E' x='250' y='0'/>";
  net.edges =
      "<edge id='WC' from='W' to='C' numLanes='2' speed='13.89'/>"
      "<edge id='NC' from='N' to='C' numLanes='1' speed='13.89'/>"
      "<edge id='CM' from='C' to='M' numLanes='2' speed='13.89'/>"
      "<edge id='ME' from='M' to='E' numLanes='2' speed='13.89'/>";
  net.connections =
      "<connection from='NC' to='CM' fromLane='0' toLane='1'/>"
      "<connection from='WC' to='CM' fromLane='0' toLane='0'/>"
      "<connection from='WC' to='CM' fromLane='1' toLane='1'/>";
  return net;
}

// a file of cars stood in the middle of a junction, and two lanes before them were empty
class EntryBeside : public ::testing::Test {
 protected:
  /// The lane by which somebody who has green comes out, where a queue fills its own.
  std::string lane_of_exit(const std::string& type, bool queue, char for_others) {
    RoadScene here{testing::read_plain_net(short_exit())};
    const std::size_t own = here.add(type, {"NC", "CM", "ME"}, 100, 4);
    const PathLink link = here.path(own).links.front();
    here.move(own, link.stop_line - 8.0);
    const Lane& lane = here.model.road.lane(here.model.road.lane_by_name.at("CM_1"));
    for (double place = lane.length - 2.5; queue && place > 0.0; place -= 6.5)
      here.add("car", {"CM", "ME"}, place, 0, 0, -1, "CM_1");
    for (std::string& letters : here.road.signal_states) letters.assign(8, for_others);
    const Connection& connection = here.model.road.connection(link.connection);
    here.road.signal_states[index_of(connection.signal)]
                           [static_cast<std::size_t>(connection.signal_link)] = 'G';
    here.update();
    const Vec2 before = here.path(own).line.point_at(here.scene.path_along[own]);
    testing::let_all_look(here);
    const Path& path = here.path(own);
    EXPECT_LT((path.line.point_at(here.scene.path_along[own]) - before).norm(), 0.1);
    const PathLink& taken = path.links.front();
    EXPECT_EQ(taken.connection, link.connection);
    return here.model.road.lane(path.stretch_at(taken.end + 1.0).lane).name;
  }
};

TEST_F(EntryBeside, IsTakenWhereTheOwnLaneIsFull) {
  EXPECT_EQ(lane_of_exit("car", true, 'r'), "CM_0");
  EXPECT_EQ(lane_of_exit("car", false, 'r'), "CM_1");
}

TEST_F(EntryBeside, IsLeftToThoseWhoHaveGreenForIt) {
  EXPECT_EQ(lane_of_exit("car", true, 'G'), "CM_1");
}

// its path began on a lane that it was still to change into
TEST_F(EntryBeside, IsNotForThoseWhoChangeLanesBefore) {
  PlainNet net = short_exit();
  net.edges.replace(net.edges.find("'C' numLanes='1'"), 16, "'C' numLanes='2'");
  net.connections.replace(net.connections.find("to='CM' fromLane='0'"), 20, "to='CM' fromLane='1'");
  RoadScene here{testing::read_plain_net(net)};
  const std::size_t own = here.add("car", {"NC", "CM", "ME"}, 5, 4, 0, -1, "NC_0");
  const LaneId other = here.model.road.lane_by_name.at("CM_0");
  for (const bool there : {false, true}) {
    const double along = there ? here.path(own).links.front().stop_line - 2.0 : 5.0;
    EXPECT_EQ(enter_beside({here.model.road, here.path(own), along, 20.0}, other).has_value(),
              there);
  }
}

// a truck and a bus wedged each other over the two lanes for 50 s
TEST_F(EntryBeside, IsNotForLongBodies) { EXPECT_EQ(lane_of_exit("bus", true, 'r'), "CM_1"); }

}  // namespace
}  // namespace sumogamma
