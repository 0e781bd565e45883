// tools/measure_traffic.py on recordings whose figures are known beforehand.
#include <algorithm>
#include <cmath>
#include <functional>

#include "traffic_run.h"

namespace sumogamma {
namespace {

using nlohmann::json;

/// Where an agent is at a time; nothing is written before `from` and after `until` [s].
struct MadeTrack {
  std::string id, type;
  double from, until;
  std::function<double(double)> x;
  double y;
};

/// A run folder with these tracks, ten samples a second, and nothing to complain about otherwise.
void write_run(const TemporaryFolder& folder, const std::vector<MadeTrack>& tracks, int pairs) {
  folder.write("results.json",
               R"({"agents": {"inserted": 1, "arrived": 1, "removed": {}},
 "collisions": {"unique_pairs": )" +
                   std::to_string(pairs) + R"(, "deep_pairs": 0},
 "flow": {"stuck_agents": 0, "longest_standstill_s": 0},
 "rules": {"red_light_crossings": 0, "wrong_way_s": 0, "off_road_s": 0, "sidewalk_by_vehicle_s": 0},
 "smoothness": {"accel_p95": 0, "jerk_p95": 0}})");
  const std::string file = folder.file("trajectories.fcd.xml.gz");
  gzFile stream = gzopen(file.c_str(), "wb");
  gzprintf(stream, "<fcd-export>\n");
  for (int step = 0; step < 1200; ++step) {
    const double time = 0.1 * step;
    gzprintf(stream, "  <timestep time=\"%.2f\">\n", time);
    for (const MadeTrack& t : tracks) {
      if (time < t.from - 1e-9 || time > t.until) continue;
      const double speed = std::abs(t.x(time + 0.05) - t.x(time - 0.05)) / 0.1;
      const bool walks = t.type == "pedestrian";
      gzprintf(stream,
               "    <%s id=\"%s\" x=\"%.2f\" y=\"%.2f\" angle=\"90\" type=\"%s\" "
               "speed=\"%.2f\" pos=\"0\" lane=\"\" slope=\"0\"/>\n",
               walks ? "person" : "vehicle", t.id.c_str(), t.x(time), t.y, t.type.c_str(), speed);
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

}  // namespace
}  // namespace sumogamma
