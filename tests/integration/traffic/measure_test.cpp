// tools/measure_traffic.py on recordings whose figures are known beforehand.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "traffic_run.h"

namespace sumogamma {
namespace {

using nlohmann::json;

/// A coordinate as a function of time, or the same always [m].
struct Coordinate {
  Coordinate(double constant) : at([constant](double) { return constant; }) {}
  template <typename Function>
  Coordinate(Function function) : at(std::move(function)) {}
  std::function<double(double)> at;
};

/// Where an agent is at a time; nothing is written before `from` and after `until` [s].
struct MadeTrack {
  std::string id, type;
  double from, until;
  Coordinate x, y;
};

/// A run folder with these tracks, ten samples a second, and nothing to complain about otherwise.
void write_run(const TemporaryFolder& folder, const std::vector<MadeTrack>& tracks, int pairs,
               int seconds = 120) {
  folder.write("results.json",
               R"({"agents": {"inserted": 1, "arrived": 1, "removed": {}},
 "collisions": {"unique_pairs": )" +
                   std::to_string(pairs) + R"(, "deep_pairs": 0},
 "flow": {"stuck_agents": 0, "longest_standstill_s": 0},
 "behavior": {"by_type": {"car": {"yielding_rate": 0.7}}},
 "rules": {"red_light_crossings": 0, "wrong_way_s": 0, "off_road_s": 0, "sidewalk_by_vehicle_s": 0},
 "smoothness": {"accel_p95": 0, "jerk_p95": 0}})");
  const std::string file = folder.file("trajectories.fcd.xml.gz");
  gzFile stream = gzopen(file.c_str(), "wb");
  gzprintf(stream, "<fcd-export>\n");
  for (int step = 0; step < 10 * seconds; ++step) {
    const double time = 0.1 * step;
    gzprintf(stream, "  <timestep time=\"%.2f\">\n", time);
    for (const MadeTrack& t : tracks) {
      if (time < t.from - 1e-9 || time > t.until) continue;
      const double speed = std::hypot(t.x.at(time + 0.05) - t.x.at(time - 0.05),
                                      t.y.at(time + 0.05) - t.y.at(time - 0.05)) /
                           0.1;
      const bool walks = t.type == "pedestrian";
      gzprintf(stream,
               "    <%s id=\"%s\" x=\"%.2f\" y=\"%.2f\" angle=\"90\" type=\"%s\" "
               "speed=\"%.2f\" pos=\"0\" lane=\"\" slope=\"0\"/>\n",
               walks ? "person" : "vehicle", t.id.c_str(), t.x.at(time), t.y.at(time),
               t.type.c_str(), speed);
    }
    gzprintf(stream, "  </timestep>\n");
  }
  gzprintf(stream, "</fcd-export>\n");
  gzclose(stream);
}

TEST(MeasureTraffic, HeadwaysOfTwoSecondsAreASaturationFlowOf1800) {
  // ten cars stand 7 m apart in lane 0 and cross the stop line two seconds after one another
  std::vector<MadeTrack> tracks;
  for (int i = 0; i < 10; ++i)
    tracks.push_back({"car" + std::to_string(i), "car", 0.0, 110.0,
                      [i](double time) {
                        const double start = -10.0 - 7.0 * i;
                        const double leaves = 57.0 + 2.0 * i;
                        return time < leaves ? start : start + (10.0 + 7.0 * i) * (time - leaves);
                      },
                      -4.8});
  const TemporaryFolder folder;
  write_run(folder, tracks, 0);
  const json figures = measured("saturation", folder.file(""));
  EXPECT_EQ(figures["queues"], json({10, 0})) << figures;
  EXPECT_EQ(figures["headways"], 6);
  EXPECT_NEAR(figures["saturation_flow"].get<double>(), 1800.0, 60.0) << figures;
}

TEST(MeasureTraffic, GapsOfOvertakingsAreBetweenOutlines) {
  // centres 2.5 m apart: 2.5 - (1.8 + 0.65) / 2
  const TemporaryFolder folder;
  write_run(folder,
            {{"two.bicycle.0", "bicycle", 0, 60, [](double t) { return 50 + 4 * t; }, 15.2},
             {"two.car.0", "car", 0, 60, [](double t) { return 5 + 8 * t; }, 17.7},
             {"one.bicycle.0", "bicycle", 0, 60, [](double t) { return 50 + 4 * t; }, -2.0},
             {"one.car.0", "car", 0, 60, [](double t) { return 5 + 4 * t; }, -1.6}},
            3);
  const json figures = measured("bicycle_overtaken", folder.file(""));
  EXPECT_EQ(figures["two_lanes"]["overtakings"], 1) << figures;
  EXPECT_NEAR(figures["two_lanes"]["least_gap"].get<double>(), 1.275, 1e-6) << figures;
  EXPECT_EQ(figures["one_lane"]["overtakings"], 0) << figures;
  EXPECT_EQ(figures["one_lane"]["pairs_met"], 1);
  EXPECT_EQ(figures["colliding_pairs"], 3);
}

TEST(MeasureTraffic, DensityAndSpeedAreThoseOfEdie) {
  // on each sidewalk one person every 2 s at 1 m/s: 1 / (2 s * 1 m/s * 3 m) a square metre
  std::vector<MadeTrack> tracks;
  for (int walk = 0; walk < 4; ++walk)
    for (int i = 0; i < 50; ++i) {
      const double from = 2.0 * i - 30.0;
      tracks.push_back({std::to_string(walk) + "." + std::to_string(i), "pedestrian",
                        std::max(0.0, from), from + 29.0,
                        [from](double time) { return 0.5 + time - from; }, 8.0 * walk - 1.5});
    }
  const TemporaryFolder folder;
  write_run(folder, tracks, 0);
  for (const json& walk : measured("sidewalk_counterflow", folder.file(""))["walks"]) {
    EXPECT_NEAR(walk["density"].get<double>(), 1.0 / 6.0, 0.01) << walk;
    EXPECT_NEAR(walk["speed"].get<double>(), 1.0, 0.01) << walk;
    EXPECT_NEAR(walk["weidmann"].get<double>(), 1.34, 0.01) << walk;
  }
}

TEST(MeasureTraffic, APlatoonThatBrakesEverDeeperShrinks) {
  // each car dips to a lower speed than the one ahead: 10, 9, 8 m/s
  std::vector<MadeTrack> tracks;
  for (int i = 0; i < 3; ++i)
    for (const char* road : {"14", "25", "33"})
      tracks.push_back({std::string(road) + ".0" + std::to_string(i), "car", 0, 100,
                        [i](double time) {
                          const double slow = time < 50 ? time : time < 60 ? 50 : time - 10;
                          const double dip = std::clamp(time - 50, 0.0, 10.0) * (10 - i);
                          return 1500 + 12 * slow + dip - 40 * i;
                        },
                        0.0});
  const TemporaryFolder folder;
  write_run(folder, tracks, 0);
  const json road = measured("platoon", folder.file(""))["roads"]["33"];
  EXPECT_NEAR(road["largest_shrink"].get<double>(), 1.0, 0.05) << road;
  EXPECT_NEAR(road["speed_minima"][2].get<double>(), 8.0, 0.05) << road;
}

TEST(MeasureTraffic, SieglochsLineGivesBackTheHeadwaysThatMadeTheGaps) {
  // gaps of 8, 11, 14 s take 1, 2, 3 vehicles: follow-up time 3 s, critical headway 8 - 3 / 2 s
  std::vector<MadeTrack> tracks;
  double time = 60.0;
  const auto passes_at = [&](const std::string& id, double when) {
    tracks.push_back(
        {id, "car", when - 5, when + 5, [when](double t) { return 500 + 10 * (t - when); }, -1.6});
  };
  int queued = 0;
  passes_at("right_600_west.0", time);
  for (int i = 1; i < 5; ++i)
    for (const int taken : {1, 2, 3}) {
      for (int k = 0; k < taken; ++k) {
        const double when = time + 1.0 + k;
        tracks.push_back({"right_600_queue." + std::to_string(queued++), "car", when - 2, when + 2,
                          501.6, [when](double t) { return -4 + 5 * (t - when); }});
      }
      time += 5.0 + 3.0 * taken;
      passes_at("right_600_west." + std::to_string(tracks.size()), time);
    }
  const TemporaryFolder folder;
  write_run(folder, tracks, 0, 200);
  const json right = measured("gap_acceptance", folder.file(""))["right"];
  EXPECT_NEAR(right["follow_up_time"].get<double>(), 3.0, 0.05) << right;
  EXPECT_NEAR(right["critical_headway"].get<double>(), 6.5, 0.1) << right;
}

TEST(MeasureTraffic, ARingsFlowIsItsDensityTimesItsSpeed) {
  // twenty cars, 50 m apart on a kilometre, at 10 m/s
  std::vector<MadeTrack> tracks;
  constexpr double kRadius = 1000.0 / (2.0 * std::numbers::pi), kMiddle = 400.0;
  const auto angle = [](int i, double t) { return (50.0 * i + 10.0 * t) / kRadius; };
  for (int i = 0; i < 20; ++i)
    tracks.push_back({"cars_20." + std::to_string(i), "car", 0, 301,
                      [=](double t) { return kMiddle + kRadius * std::cos(angle(i, t)); },
                      [=](double t) { return kRadius * std::sin(angle(i, t)); }});
  const TemporaryFolder folder;
  write_run(folder, tracks, 0, 301);
  const json figures = measured("ring_road", folder.file(""));
  EXPECT_NEAR(figures["capacity"].get<double>(), 720.0, 5.0) << figures;
  EXPECT_NEAR(figures["density_at_capacity"].get<double>(), 20.0, 0.1);
  EXPECT_NEAR(figures["time_gap"].get<double>(), 4.55, 0.02);
}

TEST(MeasureTraffic, WhoSpeedsPastSomebodyAtTheKerbLetsNobodyGo) {
  // both meet somebody who comes to the kerb as they are 40 m away: the second halts for it
  const auto walks = [](double kerb, double goes) {
    return [kerb, goes](double t) {
      return t < kerb ? -3.5 - 1.3 * (kerb - t) : t < goes ? -3.5 : -3.5 + 1.3 * (t - goes);
    };
  };
  const auto halts = [](double t) {  // 5 m before the crossing at 200, until 17 s
    const double comes = 60 + 13 * t;
    return comes < 195 ? comes : t < 17 ? 195 : 195 + 13 * (t - 17);
  };
  const TemporaryFolder folder;
  write_run(folder,
            {{"from_west.0", "car", 0, 40, [](double t) { return -90 + 13 * t; }, -1.6},
             {"north_0.0", "pedestrian", 0, 40, 0.0, walks(50.0 / 13, 9)},
             {"from_west.1", "car", 0, 40, halts, -1.6},
             {"north_1.0", "pedestrian", 0, 40, 200.0, walks(100.0 / 13, 12)}},
            0);
  const json figures = measured("zebras", folder.file(""));
  EXPECT_EQ(figures["met"], 2) << figures;
  EXPECT_EQ(figures["let_go"], 1) << figures;
  EXPECT_NEAR(figures["excess"].get<double>(), 0.5 - 0.7, 1e-6) << figures;
  EXPECT_NEAR(figures["least_speed_behind_people"].get<double>(), 0.0, 1e-6) << figures;
}

TEST(MeasureTraffic, SpeedsInCongestionAreMeansOverSpace) {
  // half of the way at 2 m/s and half at 6: 3 m/s; motorcycles at 3.6
  const auto in_two_halves = [](double t) {
    return t < 510 ? 100 + 2 * (t - 240) : 640 + 6 * (t - 510);
  };
  const TemporaryFolder folder;
  write_run(folder,
            {{"car.0", "car", 240, 600, in_two_halves, 0.0},
             {"motorcycle.0", "motorcycle", 240, 540,
              [](double t) { return 120 + 3.6 * (t - 240); }, 0.0}},
            0, 660);
  const json figures = measured("arterial", folder.file(""));
  EXPECT_NEAR(figures["speeds"]["car"].get<double>(), 3.0, 0.02) << figures;
  EXPECT_NEAR(figures["motorcycles_over_cars"].get<double>(), 1.2, 0.01) << figures;
}

TEST(MeasureTraffic, ProductionOfANetworkIsItsVehiclesTimesTheirSpeed) {
  // ever more vehicles, a minute each, then ever fewer, which are slower: 10 m/s and 8 m/s
  std::vector<MadeTrack> tracks;
  for (int i = 0; i < 30; ++i) {
    const double from = 60.0 * (i / 5), until = 720.0 - from;
    tracks.push_back({"car." + std::to_string(i), "car", from, until,
                      [](double t) { return t < 360 ? 10 * t : 3600 + 8 * (t - 360); }, 0.0});
  }
  const TemporaryFolder folder;
  write_run(folder, tracks, 0, 720);
  const json figures = measured("grid", folder.file(""));
  EXPECT_NEAR(figures["most_production"].get<double>(), 30 * 36.0, 10.0) << figures;
  EXPECT_NEAR(figures["most_accumulation"].get<double>(), 30.0, 0.2) << figures;
  // 28.8 instead of 36 for each of 30, 25, 20, 15, 10 vehicles
  EXPECT_NEAR(figures["hysteresis"].get<double>(), 7.2 * 20 / 1080, 0.02) << figures;
}

}  // namespace
}  // namespace sumogamma
