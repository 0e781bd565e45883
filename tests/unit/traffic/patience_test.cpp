#include "traffic/patience.h"

#include <gtest/gtest.h>

#include <limits>

#include "model/stopping_guard.h"

namespace sumogamma {
namespace {

// a vehicle that creeps from zone to zone has not got on
TEST(CountWaiting, CreepingIsStillWaiting) {
  Scene scene;
  AgentState car, walker;
  car.id = {1};
  walker.id = {2};
  car.preferred_speed = 13.0;
  walker.preferred_speed = 1.3;
  append_agent(scene, car);
  append_agent(scene, walker);
  TrafficState traffic;
  match_rows(scene, {}, traffic);
  auto tick = [&](double speed) {
    for (std::size_t row = 0; row < scene.size(); ++row) {
      scene.velocity[row] = {speed, 0};
      count_waiting(TrafficParameters{}, 0.5,
                    row == 0 ? Kinematics::SingleTrack : Kinematics::Holonomic, scene, traffic,
                    row);
      update_held(0.5, scene, row);
    }
  };
  EXPECT_EQ(traffic.stood_at[0], -std::numeric_limits<double>::infinity()) << "never";
  scene.time = 7.0;
  tick(0.0);
  scene.time = 7.5;
  tick(0.5);
  EXPECT_EQ(traffic.stood_at[0], 7.0);
  EXPECT_EQ(scene.held[0].standing, 0.0);
  EXPECT_EQ(traffic.waiting_time[0], 1.0);
  EXPECT_EQ(traffic.waiting_time[1], 0.0) << "on foot this is walking";
  tick(1.5);
  EXPECT_EQ(traffic.waiting_time[0], 0.0);
}

// somebody who was pressed half a step forward at the kerb had waited for nothing
TEST(CountWaiting, AStepDoesNotEndTheWaitOfPeople) {
  Scene scene;
  AgentState walker;
  walker.preferred_speed = 1.3;
  append_agent(scene, walker);
  TrafficState traffic;
  match_rows(scene, {}, traffic);
  auto waits_after = [&](double seconds, double speed) {
    scene.velocity[0] = {speed, 0};
    for (int k = 0; k < 10; ++k)
      count_waiting(TrafficParameters{}, 0.1 * seconds, Kinematics::Holonomic, scene, traffic, 0);
    return traffic.waiting_time[0];
  };
  EXPECT_NEAR(waits_after(60.0, 0.0), 60.0, 1e-9);
  EXPECT_NEAR(waits_after(0.5, 1.0), 55.0, 1e-9);
  EXPECT_EQ(waits_after(6.0, 1.0), 0.0);
}

TEST(CountWaiting, WhoIsPressedBackDoesNotGetOn) {
  Scene scene;
  AgentState walker;
  walker.id = {1};
  walker.preferred_speed = 1.3;
  append_agent(scene, walker);
  TrafficState traffic;
  match_rows(scene, {}, traffic);
  scene.context[0].active = true;
  scene.context[0].tangent = {1, 0};
  auto waits_after = [&](double vx, double vy) {
    scene.velocity[0] = {vx, vy};
    count_waiting(TrafficParameters{}, 0.5, Kinematics::Holonomic, scene, traffic, 0);
    update_held(0.5, scene, 0);
    return traffic.waiting_time[0];
  };
  EXPECT_EQ(waits_after(1.0, 0.0), 0.0);
  EXPECT_EQ(waits_after(-1.0, 0.0), 0.5) << "back along its way";
  EXPECT_EQ(waits_after(0.0, 1.0), 1.0) << "aside";
  EXPECT_EQ(scene.held[0].standing, 0.0) << "it moves all the same";
}

TEST(TrafficState, KeepsWhatItKnowsOfWhoStaysAndNothingOfWhoCame) {
  Scene scene;
  for (const std::uint32_t id : {1u, 4u, 9u}) {
    AgentState agent;
    agent.id = {id};
    agent.manners.path_offset = 0.1 * id;
    append_agent(scene, agent);
  }
  TrafficState traffic;
  match_rows(scene, {}, traffic);
  EXPECT_EQ(traffic.lateral_aim[2], 0.9) << "begins where it likes to be";
  EXPECT_EQ(traffic.merge_to[0], kNoLane);
  traffic.waiting_time = {1.0, 4.0, 9.0};
  remove_agents(scene, {true, false, false});
  AgentState newcomer;
  newcomer.id = {12};
  append_agent(scene, newcomer);
  match_rows(scene, {}, traffic);
  EXPECT_EQ(traffic.id, scene.id);
  EXPECT_EQ(traffic.waiting_time, (std::vector<double>{4.0, 9.0, 0.0}));
  EXPECT_EQ(traffic.gate[2], std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace sumogamma
