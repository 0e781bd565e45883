// One test a small scenario: what traffic does there, as tools/measure_traffic.py computes it from
// the trajectories. Bands: docs/micro_scenarios.md.
#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "traffic_run.h"

namespace sumogamma {
namespace {

using nlohmann::json;

/// A scenario with one seed: desired speeds and departures differ from seed to seed.
class MicroScenarios : public ::testing::TestWithParam<const char*> {
 protected:
  static json run(const std::string& scenario) { return figures_of(scenario, GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Seed, MicroScenarios, ::testing::Values("1", "2"));

/// Nobody touches anybody (but for `brushes` pairs that do so by centimetres), stands for ever, is
/// taken away or breaks a rule.
void expect_sound(const json& figures, int brushes = 0) {
  EXPECT_LE(figures["colliding_pairs"], brushes) << figures;
  EXPECT_EQ(figures["deep_pairs"], 0) << figures;
  EXPECT_EQ(figures["stuck"], 0);
  EXPECT_TRUE(figures["removed"].empty());
  EXPECT_EQ(figures["red_light_crossings"], 0);
  EXPECT_EQ(figures["wrong_way_s"], 0.0);
  EXPECT_EQ(figures["off_road_s"], 0.0);
  EXPECT_EQ(figures["sidewalk_by_vehicle_s"], 0.0);
}

void expect_all_arrive(const json& figures, int expected) {
  EXPECT_EQ(figures["inserted"], expected);
  EXPECT_EQ(figures["arrived"], expected);
}

TEST_P(MicroScenarios, ASignalledLaneDischargesAtItsSaturationFlow) {
  const json figures = run("saturation");
  expect_sound(figures);
  expect_all_arrive(figures, 99);
  EXPECT_GE(figures["headways"], 30) << "the queues are too short to measure";
  EXPECT_GE(figures["saturation_flow"], 1600.0) << figures;
  EXPECT_LE(figures["saturation_flow"], 2000.0) << figures;
}

TEST_P(MicroScenarios, AtATwoWayStopTheSideRoadHaltsAndTheMainRoadDoesNot) {
  const json figures = run("two_way_stop");
  expect_sound(figures);
  expect_all_arrive(figures, 33);
  EXPECT_EQ(figures["halted_share"], 1.0) << figures;
  EXPECT_GE(figures["main_road_slowest"], 3.0) << "somebody with the right of way was held up";
  EXPECT_LE(figures["main_road_hardest_braking"], 4.5);
}

TEST_P(MicroScenarios, AtAnAllWayStopEverybodyHaltsAndGoesInTurn) {
  const json figures = run("all_way_stop");
  expect_sound(figures);
  expect_all_arrive(figures, 40);
  EXPECT_EQ(figures["halted_share"], 1.0) << figures;
  EXPECT_LE(figures["out_of_turn_share"], 0.1) << figures;
  EXPECT_LE(figures["mean_wait"], 10.0) << figures;
}

TEST_P(MicroScenarios, ARoundaboutFlowsAndIsNotEnteredInFrontOfWhoIsOnIt) {
  const json figures = run("roundabout");
  expect_sound(figures);
  expect_all_arrive(figures, 44);
  EXPECT_EQ(figures["clockwise"], 0);
  EXPECT_EQ(figures["halted_on_ring"], 0) << figures;
  EXPECT_GE(figures["slowest_lap_speed"], 4.0) << figures;
  EXPECT_LE(figures["mean_wait_at_entry"], 5.0) << figures;
}

TEST_P(MicroScenarios, AnEntryOfARoundaboutTakesWhatGapsOnTheRingLeave) {
  const json figures = run("roundabout_entry");
  expect_sound(figures);
  double before = 2000;
  for (const json& stage : figures["stages"]) {
    // more than that manual says where few are on the ring: its drivers follow each other over the
    // line after 2.6 s, a queue that moves needs 2 s
    const double entered = stage["entered"], expected = stage["hcm"];
    EXPECT_GE(entered, 0.8 * expected) << stage;
    EXPECT_LE(entered, 1.5 * expected) << stage;
    EXPECT_LT(entered, before) << "the more on the ring the fewer enter";
    before = entered;
  }
}

/// `people` got across, on average after `wait` [s] at the kerb at the most, and cars lost `delay`
/// [s] and braked no harder than 6 m/s^2.
void expect_across(const json& figures, int people, double wait, double delay) {
  EXPECT_EQ(figures["people_crossed"], people);
  EXPECT_LE(figures["mean_wait_at_kerb"], wait) << figures;
  EXPECT_LE(figures["hardest_braking"], 6.0) << figures;
  EXPECT_LE(figures["mean_car_delay"], delay) << figures;
}

TEST_P(MicroScenarios, DriversYieldAtAZebraAndGetAcrossThemselves) {
  const json figures = run("zebra");
  expect_sound(figures);
  expect_all_arrive(figures, 148);
  expect_across(figures, 100, 2.0, 8.0);
  EXPECT_EQ(figures["cars_that_cut_off"], 0) << figures;
}

TEST_P(MicroScenarios, PeopleCrossBetweenJunctionsWhereTheWayIsFree) {
  const json figures = run("mid_block");
  expect_sound(figures);
  expect_all_arrive(figures, 132);
  expect_across(figures, 60, 20.0, 5.0);
  EXPECT_EQ(figures["on_the_crossing"], 0) << figures;
}

TEST_P(MicroScenarios, WhoOvertakesLeavesAGapAndMeetsNobodyWhoComes) {
  const json figures = run("bicycle_overtaken");
  expect_sound(figures);
  expect_all_arrive(figures, 33);
  const json two = figures["two_lanes"];
  EXPECT_GE(two["overtakings"].get<double>(), 0.75 * two["pairs_met"].get<double>()) << figures;
  EXPECT_GE(two["least_gap"], 1.0) << figures;
  const json one = figures["one_lane"];
  ASSERT_TRUE(one["least_gap"].is_number()) << "nobody was overtaken over the middle of the road";
  EXPECT_GE(one["least_gap"], 1.0) << figures;
  if (figures["least_time_to_oncoming"].is_number()) {
    EXPECT_GE(figures["least_time_to_oncoming"], 2.0) << figures;
  }
}

// of both seeds together: how often the road is free differs a lot from one to the other
TEST(BothSeeds, BicyclesAreOvertakenOverTheMiddleByAThird) {
  double overtaken = 0, met = 0;
  for (const char* seed : {"1", "2"}) {
    const json one = figures_of("bicycle_overtaken", seed)["one_lane"];
    overtaken += one["overtakings"].get<double>();
    met += one["pairs_met"].get<double>();
  }
  EXPECT_GE(overtaken, met / 3);
}

TEST_P(MicroScenarios, BusesHaltAtTheirStopAndArePassedWhereThereIsALane) {
  const json figures = run("bus_stop");
  expect_sound(figures);
  expect_all_arrive(figures, 34);
  EXPECT_EQ(figures["stops"], 4);
  EXPECT_LE(figures["largest_error"], 1.5) << figures;
  EXPECT_GE(figures["shortest_stand"], 19.0) << figures;
  EXPECT_LE(figures["longest_stand"], 25.0) << figures;
  EXPECT_GE(figures["passed_on_two_lanes"], 4) << figures;
  EXPECT_EQ(figures["passed_on_one_lane"], 0) << figures;
  EXPECT_LE(figures["mean_delay_two_lanes"], 5.0) << figures;
  EXPECT_GE(figures["oncoming_slowest"], 8.0) << figures;
}

// of eight motorcycles and four bicycles it is chance how many do, of 64 and 32 it is not
TEST(MicroScenariosOverSeeds, TwoWheelersFilterToTheFrontOfAQueue) {
  constexpr int kSeeds = 8;
  std::map<std::string, double> filtered, passed;
  std::vector<double> gaps;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const json figures = figures_of("mixed_queue", std::to_string(seed));
    expect_sound(figures);
    expect_all_arrive(figures, 26);
    EXPECT_EQ(figures["crossed_in_green"], 1.0) << figures;
    for (const char* kind : {"motorcycles", "bicycles"}) {
      filtered[kind] += figures[kind]["filtered_share"].get<double>() / kSeeds;
      passed[kind] += figures[kind]["cars_passed_each"].get<double>() / kSeeds;
    }
    gaps.push_back(figures["least_gap_while_filtering"].get<double>());
  }
  for (const char* kind : {"motorcycles", "bicycles"}) {
    EXPECT_GE(filtered[kind], 0.6) << kind;
    EXPECT_GE(passed[kind], 4.0) << kind;
  }
  // the least of a whole run: in half of them at the least
  std::sort(gaps.begin(), gaps.end());
  EXPECT_GE(gaps[kSeeds / 2], 0.15);
}

TEST_P(MicroScenarios, PeopleBothWaysOnASidewalkWalkAsFastAsWeidmannSays) {
  const json figures = run("sidewalk_counterflow");
  expect_sound(figures, 1);  // of some 400 who are put into a crowd
  double densest = 0;
  for (const json& walk : figures["walks"]) {
    // his spread of walking speeds, 0.26 m/s
    EXPECT_NEAR(walk["speed"].get<double>(), walk["weidmann"].get<double>(), 0.26) << walk;
    EXPECT_EQ(walk["off_the_sidewalk"], 0) << walk;
    densest = std::max(densest, walk["density"].get<double>());
  }
  EXPECT_GE(densest, 1.5) << figures;
}

TEST_P(MicroScenarios, TwoLanesBecomeOneInTurnAndAtTheFlowOfALane) {
  const json figures = run("lane_drop");
  expect_sound(figures);
  expect_all_arrive(figures, 60);
  EXPECT_GE(figures["flow"], 1500.0) << figures;
  EXPECT_GE(figures["alternating_share"], 0.6) << figures;
  EXPECT_LE(figures["hardest_braking"], 4.5) << figures;
}

TEST_P(MicroScenarios, APlatoonIsStableUpTo33MetresASecond) {
  const json figures = run("platoon");
  expect_sound(figures);
  expect_all_arrive(figures, 36);
  const double limit[] = {13.89, 25.0, 33.0};
  int row = 0;
  for (const char* name : {"14", "25", "33"}) {
    const json road = figures["roads"][name];
    EXPECT_GE(road["leader_cruise"], 0.93 * limit[row++]) << road;
    // who comes behind never has to brake down to less than who is ahead
    EXPECT_LE(road["largest_shrink"], 0.1) << road;
    EXPECT_LE(road["most_stops"], 1) << road;
    EXPECT_GE(road["least_gap"], 1.0) << road;
    // in an emergency most drivers brake harder than this
    for (const json& braking : road["hardest_braking"]) EXPECT_LE(braking, 5.0) << road;
  }
}

/// results.json of a run of sumo_scenarios/red_lights with a preset.
json red_lights(const std::string& preset, const std::string& seed) {
  const TemporaryFolder folder;
  run_scenario("red_lights", {"--preset", preset, "--seed", seed}, folder);
  json results = json::parse(std::ifstream(folder.file("out/results.json")), nullptr, false);
  EXPECT_FALSE(results.is_discarded());
  EXPECT_EQ(results["agents"]["arrived"], 1268);
  EXPECT_EQ(results["flow"]["stuck_agents"], 0);
  // people brush each other; nobody on wheels touches anybody
  for (const auto& [pair, count] : results["collisions"]["by_types"].items())
    EXPECT_EQ(pair, "pedestrian-pedestrian") << count;
  return results;
}

/// Red lights run over those met by who could go.
double red_share(const json& results, const char* type) {
  const json& counts = results["rules"]["by_types"][type];
  EXPECT_GE(counts["red_lights_met"], 40) << type << " meets too few to tell";
  return counts["red_light_crossings"].get<double>() / counts["red_lights_met"].get<double>();
}

TEST_P(MicroScenarios, ThePresetSaysHowManyGoAtRed) {
  const json compliant = red_lights("compliant", GetParam());
  // who comes late at amber may be over the line a moment after
  for (const char* type : {"motorcycle", "bicycle", "car", "pedestrian"})
    EXPECT_LE(red_share(compliant, type), 0.05) << type;
  const json observed = red_lights("observed", GetParam());
  EXPECT_EQ(observed["behavior"]["by_type"]["motorcycle"]["red_light_running"], 0.465);
  EXPECT_NEAR(red_share(observed, "motorcycle"), 0.465, 0.15);
  EXPECT_NEAR(red_share(observed, "bicycle"), 0.391, 0.13);
  EXPECT_LE(red_share(observed, "car"), 0.05);
  EXPECT_NEAR(red_share(observed, "pedestrian"), 0.15, 0.12);
}

}  // namespace
}  // namespace sumogamma
