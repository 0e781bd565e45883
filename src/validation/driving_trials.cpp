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
       {"start-up lost time", "s", {1.0, 3.0}, kHcm, false, "/start_up_lost_time"}},
      {}};
}

Trial queue_that_starts() {
  return {"V2",
          "How does a queue stand, and start?",
          "The queue of V1 with --preset interaction; its vType asks for gaps of 1.8 m.",
          "saturation",
          {{"starting wave",
            "m/s",
            {4.5, 6.0},
            "usual figure of queue discharge",
            true,
            "/starting_wave"},
           {"mean acceleration from 0 to 5 m/s",
            "m/s²",
            {1.3, 1.6},
            "INTERACTION, three junctions",
            true,
            "/start_acceleration"},
           {"median gap of those who stand",
            "m",
            {1.6, 2.0},
            "what the scenario asks for",
            false,
            "/standing_gap"}},
          {},
          "interaction"};
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

Trial following() {
  return {"V3",
          "How far behind each other do drivers follow, and how unlike are they?",
          "A single file on rings of 20 and 30 cars a km; each driver's median time gap at equal "
          "speed, with --preset interaction.",
          "ring_road",
          {{"mean over drivers",
            "s",
            {1.63, 1.97},
            "INTERACTION, four places: means of 1.63 to 1.97 s",
            true,
            "/time_gap"},
           {"coefficient of variation", "", {0.34, 0.50}, "the same", true, "/time_gap_variation"}},
          {},
          "interaction"};
}

Trial gap_acceptance() {
  Trial trial{
      "V4",
      "How many leave a queue through the gaps of a main road?",
      "Twelve junctions: four movements, each beside 200, 600 and 1,000 vehicles an hour at "
      "random; over the capacity at a two-way stop with the manual's critical headways and "
      "follow-up times, and over that with those of the run itself (Siegloch's regression).",
      "gap_acceptance",
      {},
      {}};
  const std::pair<const char*, const char*> movements[] = {{"right", "right off the side road"},
                                                           {"through", "across"},
                                                           {"left", "left off the side road"},
                                                           {"major", "left off the main road"}};
  for (const auto& [name, words] : movements) {
    for (const char* flow : {"200", "600", "1000"})
      trial.criteria.push_back({std::string(words) + " beside " + flow + " vehicles/h, over HCM",
                                "",
                                {0.8, 1.2},
                                kHcm,
                                false,
                                std::string("/") + name + "/flows/" + flow + "/over_hcm"});
    trial.criteria.push_back({std::string(words) + ", over what its own headways ask for",
                              "",
                              {0.85, 1.15},
                              "consistency with Siegloch's formula",
                              false,
                              std::string("/") + name + "/over_own"});
  }
  return trial;
}

Trial lane_capacity() {
  return {
      "V10",
      "What does a lane carry?",
      "A single file on rings of 1 km with 10 to 110 cars, limit 50 km/h: the largest flow, and "
      "the line of flow over density beyond it.",
      "ring_road",
      {{"largest flow",
        "vehicles/h",
        {1800, 2200},
        "usual capacity of a lane without junctions",
        true,
        "/capacity"},
       {"waves beyond it", "km/h", {-20, -15}, "Treiterer; NGSIM", true, "/wave_speed"},
       {"density at which nobody moves",
        "cars/km",
        {120, 150},
        "usual jam density",
        true,
        "/jam_density"}},
      {}};
}

Trial phantom_jam() {
  constexpr const char* kSugiyama = "Sugiyama et al. 2008: 22 cars on 230 m, 30 km/h";
  return {
      "V9",
      "Do jams come of nothing on a dense ring, and not on one with room?",
      "22 and 15 cars on rings of 230 m, limit 30 km/h; the slowest that anybody is from 200 to "
      "300 s.",
      "ring_road",
      {{"slowest of 22", "m/s", {0.0, 2.0}, kSugiyama, true, "/slowest_of_22"},
       {"slowest of 15", "m/s", {4.0, kAny}, kSugiyama, true, "/slowest_of_15"}},
      {}};
}

Trial network_diagram() {
  return {"V11",
          "Is production of a network a function of how many are in it?",
          "Five by five signalled junctions, a demand that rises and falls within 750 s; vehicle "
          "kilometres an hour beside vehicles, a minute each.",
          "grid",
          {{"scatter at equal accumulation, of the largest production",
            "",
            {0.0, 0.1},
            "macroscopic fundamental diagram (Geroliminis, Daganzo 2008)",
            true,
            "/scatter"},
           {"lost while it empties, of the largest production",
            "",
            {0.0, 0.1},
            "hysteresis of such diagrams is clockwise",
            true,
            "/hysteresis"}},
          {}};
}

Trial yielding_drivers() {
  constexpr const char* kCqut = "CQUT: 0.68 of 209 meetings, 0.63 of 543";
  return {
      "V13b",
      "Do as many drivers let people go first as are asked for?",
      "Five zebra crossings in a row, --preset observed: of drivers to whose way somebody comes "
      "while they are 55 to 30 m before it, the share that lets these go first, less the share "
      "asked for. People and cars less than 5 s apart.",
      "zebras",
      {{"drivers who let people go, beyond those asked for",
        "",
        {-0.05, 0.05},
        "what the preset asks for",
        false,
        "/excess"},
       {"people who are first", "", {0.58, 0.73}, kCqut, true, "/person_first"},
       {"least speed of a car behind people",
        "m/s",
        {0.5, 1.5},
        "CQUT: medians of 0.5 and 1.4 m/s",
        true,
        "/least_speed_behind_people"},
       {"less than 1 s apart",
        "",
        {0.0, 0.12},
        "DUT, shared space and a junction: 0.083, 0.119",
        true,
        "/encroachment_below_1_s"}},
      {},
      "observed"};
}

Trial congested_two_wheelers() {
  return {"V16",
          "Are motorcycles faster than cars in the same congestion?",
          "Two lanes, three signals, more demand than they let through, 37 of 100 are motorcycles, "
          "--preset observed; mean speeds over the road.",
          "arterial",
          {{"speed of motorcycles over that of cars",
            "",
            {1.1, 1.3},
            "pNEUMA: 1.23",
            true,
            "/motorcycles_over_cars"}},
          {},
          "observed"};
}

}  // namespace

std::vector<Trial> driving_trials() {
  std::vector<Trial> trials{queue_at_a_signal(), queue_that_starts(),
                            following(),         gap_acceptance(),
                            stop_signs(),        roundabout_entry(),
                            lane_drop(),         platoon(),
                            phantom_jam(),       lane_capacity(),
                            network_diagram(),   minor_road(),
                            rolling_stops(),     red_lights(),
                            yielding_drivers(),  two_wheelers(),
                            overtaking(),        zebra(),
                            mid_block(),         congested_two_wheelers(),
                            bus_stop(),          ring(),
                            sidewalk()};
  for (Trial& trial : trials) {
    trial.criteria.push_back(
        {"colliding pairs", "", {0.0, 0.0}, kProject, false, "/colliding_pairs"});
    trial.criteria.push_back({"stuck", "", {0.0, 0.0}, kProject, false, "/stuck"});
  }
  return trials;
}

}  // namespace sumogamma
