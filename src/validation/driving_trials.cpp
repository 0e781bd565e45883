#include <string>
#include <utility>

#include "validation/trial.h"

namespace sumogamma {

namespace {

constexpr const char* kHcm = "Highway Capacity Manual, 7th edition";
constexpr const char* kProject = "this project's";

Trial queue_at_a_signal() {
  return {
      "V1",
      "How many leave a queue at green?",
      "Cars that queue before a red light on two lanes, limit 50 km/h; headways from the fourth "
      "on, at the stop line.",
      "saturation",
      {{"saturation flow of a lane", "vehicles/h", {1700, 2000}, kHcm, false, "/saturation_flow"},
       {"start-up lost time", "s", {1.0, 3.0}, kHcm, false, "/start_up_lost_time"},
       {"starting wave",
        "m/s",
        {4.5, 6.0},
        "usual figure of queue discharge",
        true,
        "/starting_wave"},
       {"mean acceleration from 0 to 5 m/s",
        "m/s²",
        {1.3, 1.6},
        "recordings of three junctions (facts of drone videos)",
        true,
        "/start_acceleration"},
       {"median gap of those who stand",
        "m",
        {2.0, 2.9},
        "the same recordings",
        true,
        "/standing_gap"}},
      {}};
}

Trial stop_signs() {
  return {"V5",
          "Does everybody halt at an all-way stop, and go in turn?",
          "Forty vehicles from four arms of one lane.",
          "all_way_stop",
          {{"share that halts", "", {1.0, 1.0}, kHcm, false, "/halted_share"},
           {"out of turn", "", {0.0, 0.1}, kHcm, false, "/out_of_turn_share"}},
          {}};
}

Trial rolling_stops() {
  return {"V12b",
          "Do as many roll over stop signs as are asked for?",
          "The all-way stop of V5 with --preset observed.",
          "all_way_stop",
          {{"share that halts",
            "",
            {0.78, 0.88},
            "0.83 of cars at an all-way stop (INTERACTION, MA)",
            true,
            "/halted_share"}},
          {},
          "observed"};
}

Trial minor_road() {
  return {"V12",
          "Does the side road halt at its stop sign, and the main road flow?",
          "A main road and a side road with stop signs.",
          "two_way_stop",
          {{"share of the side road that halts",
            "",
            {1.0, 1.0},
            "the traffic code",
            false,
            "/halted_share"},
           {"slowest on the main road", "m/s", {3.0, kAny}, kProject, false, "/main_road_slowest"},
           {"hardest braking on the main road",
            "m/s²",
            {0.0, 4.5},
            kProject,
            false,
            "/main_road_hardest_braking"}},
          {}};
}

Trial roundabout_entry() {
  Trial trial{"V6",
              "How many enter a roundabout beside those on its ring?",
              "A queue before an entry of one lane, and three stages of ever more vehicles on the "
              "ring; entries over the capacity of HCM 6, 1,380 exp(-0.00102 v).",
              "roundabout_entry",
              {},
              {}};
  const char* const stages[] = {"few", "some", "many"};
  for (int k = 0; k < 3; ++k)
    trial.criteria.push_back({std::string("entries over capacity, ") + stages[k] + " on the ring",
                              "",
                              {0.8, 1.15},
                              "between HCM 2010 and 1.15 of HCM 7",
                              false,
                              "/stages/" + std::to_string(k) + "/entered_over_hcm"});
  return trial;
}

Trial lane_drop() {
  return {"V7",
          "What does the end of a lane let through?",
          "Two lanes become one, with more cars than one takes.",
          "lane_drop",
          {{"flow", "vehicles/h", {1600, 2000}, "usual capacity of a lane drop", true, "/flow"},
           {"in turn", "", {0.6, 1.0}, kProject, false, "/alternating_share"},
           {"hardest braking", "m/s²", {0.0, 4.5}, kProject, false, "/hardest_braking"}},
          {}};
}

Trial platoon() {
  Trial trial{
      "V8",
      "Does a disturbance grow along a platoon?",
      "Three platoons of twelve, at 50, 90 and 120 km/h, whose first car halts and goes on.",
      "platoon",
      {},
      {}};
  for (const char* speed : {"14", "25", "33"}) {
    const std::string road = std::string("/roads/") + speed;
    trial.criteria.push_back({std::string("growth of the dip, limit ") + speed + " m/s",
                              "m/s",
                              {-kAny, 1.0},
                              "string stability",
                              false,
                              road + "/largest_shrink"});
    trial.criteria.push_back({std::string("hardest braking, limit ") + speed + " m/s",
                              "m/s²",
                              {0.0, 5.0},
                              "string stability",
                              false,
                              road + "/hardest_braking"});
  }
  return trial;
}

Trial red_lights() {
  Trial trial{"V13",
              "Do as many go at red as are asked for?",
              "Two-wheelers, cars and people at a signal where little crosses their way, with the "
              "rates of --preset observed; of those who meet red, the share that goes less the "
              "share asked for.",
              "red_lights",
              {},
              {},
              "observed"};
  const std::pair<const char*, const char*> kinds[] = {{"motorcycles", "motorcycle"},
                                                       {"bicycles", "bicycle"},
                                                       {"cars", "car"},
                                                       {"people", "pedestrian"}};
  for (const auto& [words, kind] : kinds)
    trial.criteria.push_back({std::string(words) + " that go at red, beyond those asked for",
                              "",
                              {-0.05, 0.05},
                              "what the preset asks for",
                              false,
                              std::string("/") + kind + "/excess"});
  return trial;
}

Trial two_wheelers() {
  return {
      "V14",
      "Do two-wheelers filter to the front of a queue?",
      "Eight motorcycles and four bicycles behind cars that wait at a red light.",
      "mixed_queue",
      {{"motorcycles that filter", "", {0.6, 1.0}, kProject, false, "/motorcycles/filtered_share"},
       {"bicycles that filter", "", {0.6, 1.0}, kProject, false, "/bicycles/filtered_share"}},
      {}};
}

Trial overtaking() {
  return {"V14b",
          "Are bicycles overtaken with room?",
          "Cars behind bicycles on a road of two lanes and on one with an oncoming lane.",
          "bicycle_overtaken",
          {{"least lateral gap, two lanes",
            "m",
            {1.0, kAny},
            "usual rule of 1 m to 1.5 m",
            false,
            "/two_lanes/least_gap"},
           {"least lateral gap, over the middle",
            "m",
            {1.0, kAny},
            "usual rule of 1 m to 1.5 m",
            false,
            "/one_lane/least_gap"}},
          {}};
}

Trial zebra() {
  return {"V15",
          "Do drivers yield at a zebra crossing?",
          "100 people and 48 cars at a crossing with priority; drivers who keep the rules.",
          "zebra",
          {{"cars that cut somebody off",
            "",
            {0.0, 0.0},
            "the traffic code",
            false,
            "/cars_that_cut_off"},
           {"mean wait at the kerb", "s", {0.0, 2.0}, kProject, false, "/mean_wait_at_kerb"},
           {"mean delay of cars", "s", {0.0, 8.0}, kProject, false, "/mean_car_delay"}},
          {}};
}

Trial mid_block() {
  return {"V15b",
          "Do people cross between junctions where the way is free?",
          "Sixty people cross a road with 72 cars away from its crossing.",
          "mid_block",
          {{"people who got across", "", {60, 60}, kProject, false, "/people_crossed"},
           {"mean wait at the kerb", "s", {0.0, 20.0}, kProject, false, "/mean_wait_at_kerb"},
           {"hardest braking of cars", "m/s²", {0.0, 6.0}, kProject, false, "/hardest_braking"}},
          {}};
}

Trial bus_stop() {
  return {"V17",
          "Do buses halt at their stop, and are they passed where there is a lane?",
          "Four buses halt on the lane of two roads.",
          "bus_stop",
          {{"largest error of place", "m", {0.0, 1.5}, "SUMO's stops", false, "/largest_error"},
           {"cars that pass on two lanes", "", {4, kAny}, kProject, false, "/passed_on_two_lanes"},
           {"mean delay on two lanes", "s", {0.0, 5.0}, kProject, false, "/mean_delay_two_lanes"}},
          {}};
}

Trial ring() {
  return {"V18",
          "Does a roundabout flow?",
          "Four arms of one lane, traffic from all to all.",
          "roundabout",
          {{"vehicles that halt on the ring", "", {0.0, 0.0}, kProject, false, "/halted_on_ring"},
           {"slowest mean speed on the ring",
            "m/s",
            {4.0, kAny},
            kProject,
            false,
            "/slowest_lap_speed"}},
          {}};
}

Trial sidewalk() {
  return {"P2",
          "Do people both ways on a sidewalk walk as fast as their density lets them?",
          "Four sidewalks of 3 m with ever more people both ways; density and speed after Edie.",
          "sidewalk_counterflow",
          {{"largest distance to Weidmann's speed",
            "m/s",
            {0.0, 0.26},
            "Weidmann 1993 ± his spread of 0.26 m/s",
            false,
            "/largest_difference"}},
          {}};
}

}  // namespace

std::vector<Trial> driving_trials() {
  std::vector<Trial> trials{
      queue_at_a_signal(), stop_signs(), roundabout_entry(), lane_drop(),  platoon(), minor_road(),
      rolling_stops(),     red_lights(), two_wheelers(),     overtaking(), zebra(),   mid_block(),
      bus_stop(),          ring(),       sidewalk()};
  for (Trial& trial : trials) {
    trial.criteria.push_back(
        {"colliding pairs", "", {0.0, 0.0}, kProject, false, "/colliding_pairs"});
    trial.criteria.push_back({"stuck", "", {0.0, 0.0}, kProject, false, "/stuck"});
  }
  return trials;
}

}  // namespace sumogamma
