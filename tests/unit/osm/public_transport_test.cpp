// Lines and stops of tests/support/osm/bus_lines_*.osm (a sketch stands there) on the network that
// netconvert makes of it.
#include "osm/public_transport.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "osm/build_network.h"
#include "osm/import_report.h"
#include "osm/osm_reader.h"

namespace sumogamma::osm {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const fs::path kLineMaps = fs::path(SUMOGAMMA_SOURCE_DIR) / "tests/support/osm";

TEST(HeadwayOf, ReadsMinutesTimesAndRanges) {
  EXPECT_DOUBLE_EQ(headway_of("10"), 600);
  EXPECT_DOUBLE_EQ(headway_of("00:06"), 360);
  EXPECT_DOUBLE_EQ(headway_of("00:07:30"), 450);
  EXPECT_DOUBLE_EQ(headway_of("00:06-00:12"), 540);
  for (const char* const none : {"", "irregular", "10 min", "-", "00:00:00:10", "-5", "1e9"})
    EXPECT_DOUBLE_EQ(headway_of(none), 0) << none;
}

TEST(FindLines, KnowsDirectionsStopsAndWhatRunsElsewhere) {
  const MapLines lines = find_lines(read_osm(kLineMaps / "bus_lines_right.osm"));
  ASSERT_EQ(lines.lines.size(), 5u);
  const MapLine &first = lines.lines[0], &second = lines.lines[1], &third = lines.lines[2];
  EXPECT_EQ(lines.others, (std::map<std::string, long>{{"tram", 1}}));

  EXPECT_TRUE(first.directed);
  EXPECT_DOUBLE_EQ(first.headway, 300);
  ASSERT_EQ(first.runs.size(), 1u);
  ASSERT_EQ(first.runs[0].size(), 4u);
  for (const LineWay& way : first.runs[0])  // eastwards, whichever way each is drawn
    EXPECT_LT(way.places.front().lon, way.places.back().lon) << way.way;
  // the place on the road is that of the first platform
  std::vector<std::string> names;
  for (const LineStop& stop : first.stops) names.push_back(stop.id);
  EXPECT_THAT(names, ElementsAre("n21", "n22", "n23"));

  EXPECT_FALSE(second.directed);
  EXPECT_EQ(second.line, "2 A");
  ASSERT_EQ(second.runs.size(), 1u);
  EXPECT_EQ(second.runs[0].size(), 4u);  // two ways, both directions
  EXPECT_EQ(third.runs[0].back().way, 109);
}

/// The network and the lines of a map.
class Lines : public ::testing::Test {
 protected:
  ~Lines() override { fs::remove_all(folder_); }
  BuildResult build(const fs::path& map, std::optional<Side> side = std::nullopt) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    BuildRequest request;
    request.map = map;
    request.folder = folder_;
    request.side = side.value_or(Side::Auto);
    return build_network(request);
  }
  fs::path folder_ = fs::temp_directory_path() / ("sumogamma_lines_" + std::to_string(getpid()));
};

std::vector<std::string> names_of(const BuildResult& built, const LinePart& part) {
  std::vector<std::string> names;
  for (const ServedStop& served : part.stops)
    names.push_back(built.transport.stops[served.stop].name);
  return names;
}

/// Every edge leads onto the next, buses may use all, and stops lie on it in order.
void expect_drivable(const BuildResult& built, const LinePart& part) {
  const RoadNetwork& road = built.road;
  for (std::size_t i = 0; i + 1 < part.route.size(); ++i) {
    bool leads_on = false;
    for (const LaneId lane : road.edge(part.route[i]).lanes)
      for (const ConnectionId out : road.lane(lane).outgoing) {
        const Lane& target = road.lane(road.connection(out).to);
        leads_on = leads_on || (target.edge == part.route[i + 1] &&
                                (target.allowed & road.lane(lane).allowed & vehicle_class::kBus));
      }
    EXPECT_TRUE(leads_on) << part.id << ": " << road.edge(part.route[i]).name;
  }
  std::size_t before = 0;
  for (const ServedStop& served : part.stops) {
    const BusStop& stop = built.transport.stops[served.stop];
    const Lane& lane = road.lane(stop.lane);
    EXPECT_EQ(lane.edge, part.route[served.edge]) << stop.id;
    EXPECT_GE(served.edge, before);
    before = served.edge;
    EXPECT_TRUE(lane.allowed & vehicle_class::kBus) << stop.id;
    EXPECT_GE(stop.begin, 0);
    EXPECT_LE(stop.end, lane.length);
    EXPECT_GE(stop.end - stop.begin, 12.0);  // a bus
  }
}

class LinesOnASide : public Lines, public ::testing::WithParamInterface<const char*> {};

TEST_P(LinesOnASide, RunAsTheMapSaysAndHaltAtTheKerb) {
  const std::string side = GetParam();
  const BuildResult built = build(kLineMaps / ("bus_lines_" + side + ".osm"));
  ASSERT_EQ(built.left_hand, side == "left");
  const auto& parts = built.transport.parts;
  ASSERT_EQ(parts.size(), 5u);
  for (const LinePart& part : parts) expect_drivable(built, part);
  EXPECT_EQ(parts[0].line, "1");
  EXPECT_DOUBLE_EQ(parts[0].headway, 300);
  EXPECT_THAT(names_of(built, parts[0]), ElementsAre("West End", "Town Hall", "Market"));
  // one relation, two directions
  EXPECT_EQ(parts[1].line, "2_A");
  EXPECT_EQ(parts[2].line, "2_A");
  std::vector<std::vector<std::string>> both{names_of(built, parts[1]), names_of(built, parts[2])};
  std::sort(both.begin(), both.end());
  EXPECT_THAT(both, ElementsAre(ElementsAre("Church", "Mill"), ElementsAre("Mill", "Church")));
  // out of the map and back: two parts
  EXPECT_THAT(names_of(built, parts[3]), ElementsAre("Town Hall", "Market"));
  EXPECT_THAT(names_of(built, parts[4]), ElementsAre("Park", "School"));
  // a stop that two lines share is there once
  EXPECT_EQ(built.transport.stops.size(), 9u);
  std::set<std::string> ids;
  for (const BusStop& stop : built.transport.stops) {
    EXPECT_TRUE(ids.insert(stop.id).second) << stop.id;
    // the lane next to the kerb, and the pavement beside it
    const Lane& lane = built.road.lane(stop.lane);
    ASSERT_NE(lane.outer, kNoLane) << stop.id;
    EXPECT_EQ(built.road.lane(lane.outer).allowed, vehicle_class::kPedestrian);
    EXPECT_FALSE(stop.access.has_value());
  }
}

TEST_P(LinesOnASide, AreNamedWhereTheyAreLeftOut) {
  const BuildResult built = build(kLineMaps / (std::string("bus_lines_") + GetParam() + ".osm"));
  EXPECT_EQ(built.lines.driven, 3);
  EXPECT_EQ(built.lines.found,
            (std::map<std::string, long>{{"bus", 3}, {"minibus", 1}, {"trolleybus", 1}}));
  EXPECT_THAT(
      built.lines.left_out,
      ElementsAre(::testing::Pair("4 (relation/1004)", "fewer than two stops in the map"),
                  ::testing::Pair("5 (relation/1005)", "no road of it that a bus may use")));
  const auto report = import_report(built, "x")["public_transport"];
  EXPECT_EQ(report["not_on_roads"]["tram"], 1);
  EXPECT_EQ(report["left_out"].size(), 2u);
  EXPECT_THAT(built.lines.at_all_stops, IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Sides, LinesOnASide, ::testing::Values("right", "left"),
                         [](const auto& row) { return std::string(row.param); });

TEST_F(Lines, WithoutStopsOfTheirOwnHaltAtThoseOnTheirSide) {
  std::ifstream stream(kLineMaps / "bus_lines_right.osm");
  std::ostringstream whole;
  whole << stream.rdbuf();
  std::string text = whole.str();
  for (const char* const stop : {"31", "32", "33", "34"}) {
    const std::string member =
        std::string("    <member type=\"node\" ref=\"") + stop + "\" role=\"\"/>\n";
    ASSERT_NE(text.find(member), std::string::npos);
    text.erase(text.find(member), member.size());
  }
  fs::create_directories(folder_);
  const fs::path map =
      fs::temp_directory_path() / ("sumogamma_lines_" + std::to_string(getpid()) + ".osm");
  std::ofstream(map) << text;
  const BuildResult built = build(map);
  fs::remove(map);
  EXPECT_THAT(built.lines.at_all_stops, ElementsAre("2 A (relation/1002)"));
  ASSERT_EQ(built.transport.parts.size(), 5u);
  EXPECT_EQ(built.transport.parts[1].stops.size(), 2u);
  EXPECT_EQ(built.transport.parts[2].stops.size(), 2u);
  EXPECT_NE(built.transport.parts[1].stops[0].stop, built.transport.parts[2].stops[1].stop);
}

}  // namespace
}  // namespace sumogamma::osm
