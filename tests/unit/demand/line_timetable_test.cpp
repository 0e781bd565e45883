// A road of four edges with a spur back off the third:
//
//   A --ab-- B --bc-- C --cd-- D --de-- E      300 m each, 13.89 m/s, one lane
//                               \ df: back by 150 degrees
#include "demand/line_timetable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "support/plain_net.h"

namespace sumogamma {
namespace {

using testing::PlainNet;
using testing::route_of;

class LineTimetable : public ::testing::Test {
 protected:
  LineTimetable() {
    PlainNet net;
    net.nodes =
        "<node id='A' x='0' y='0'/><node id='B' x='300' y='0'/><node id='C' x='600' y='0'/>"
        "<node id='D' x='900' y='0'/><node id='E' x='1200' y='0'/><node id='F' x='640' y='-150'/>";
    for (const char* const edge : {"AB", "BC", "CD", "DE", "DF"})
      net.edges += std::string("<edge id='") + edge + "' from='" + edge[0] + "' to='" + edge[1] +
                   "' numLanes='1' speed='13.89'/>";
    road_ = testing::read_plain_net(net);
  }
  /// A part with a stop on each edge of its route.
  LinePart part(const std::string& id, const std::vector<std::string>& edges) {
    LinePart part{id, "7", "bus", 0, route_of(road_, edges), {}};
    for (std::size_t row = 0; row < part.route.size(); ++row) {
      part.stops.push_back({request_.transport->transport.stops.size(), row});
      request_.transport->transport.stops.push_back(
          {id + std::to_string(row), "", road_.edge(part.route[row]).lanes.front(), 100, 115, {}});
    }
    return part;
  }
  const AgentType& bus() const { return type_of(types_, find_agent_type(types_, "bus")); }
  std::vector<BusRun> timetable(std::vector<LinePart> parts) {
    request_.transport->transport.parts = std::move(parts);
    return line_timetable(road_, bus(), request_, report_);
  }

  AgentTypeTable types_ = default_agent_types();
  RoadNetwork road_;
  DemandRequest request_ = [] {
    DemandRequest request;
    request.transport.emplace();
    request.duration = 3000;
    return request;
  }();
  TransportDemand report_;
};

TEST_F(LineTimetable, KeepsHeadwaysFromTheMapAndOthers) {
  LinePart usual = part("1.0", {"AB", "BC", "CD", "DE"}), own = part("2.0", {"AB", "BC"});
  own.headway = 200;
  const std::vector<BusRun> runs = timetable({usual, own});
  for (const auto& [id, headway] : {std::pair("1.0", 600.0), std::pair("2.0", 200.0)}) {
    double last = -1;
    int count = 0;
    for (const BusRun& run : runs) {
      if (run.part->id != id || run.time <= request_.warm_up) continue;  // or on the way before
      EXPECT_TRUE(last < 0 || std::abs(run.time - last - headway) < 1e-6) << run.time - last;
      EXPECT_EQ(run.first, 0u);
      last = run.time;
      ++count;
    }
    EXPECT_NEAR(count, 3000 / headway, 1.0) << id;
  }
  EXPECT_EQ(report_.buses, static_cast<long>(runs.size()));
  EXPECT_EQ(report_.parts, 2);
  std::set<std::string> ids;
  double before = 0;
  for (const BusRun& run : runs) {
    EXPECT_TRUE(ids.insert(run.id).second) << run.id;
    EXPECT_GE(run.time, before);
    before = run.time;
  }
}

TEST_F(LineTimetable, ALineIsDrivenFromTheBeginOn) {
  // as it takes 1200 m at 13.89 m/s, 1.3 times as long, and four stops of 20 s: 192 s
  LinePart line = part("1.0", {"AB", "BC", "CD", "DE"});
  EXPECT_NEAR(arrival_times(road_, bus(), line, 1.3).back(), 1200 / 13.89 * 1.3 + 80, 3.0);
  line.headway = 40;
  long on_the_way = 0;
  for (const BusRun& run : timetable({line}))
    if (run.first > 0) {
      EXPECT_LE(run.time, request_.warm_up);
      EXPECT_LT(run.first, 3u);  // before the last stop
      ++on_the_way;
    }
  EXPECT_GE(on_the_way, 2);
  EXPECT_LE(on_the_way, report_.initial);
  EXPECT_NEAR(report_.alive, 192.0 / 40, 0.2);
}

TEST_F(LineTimetable, GoesOnBehindATurnThatNoBusCanTake) {
  const std::vector<LinePart> parts =
      drivable_parts(road_, bus(), {part("1.0", {"AB", "BC", "CD", "DF"})}, report_);
  ASSERT_EQ(parts.size(), 1u);  // the spur has one stop alone
  EXPECT_EQ(parts[0].route, route_of(road_, {"AB", "BC", "CD"}));
  EXPECT_EQ(parts[0].stops.size(), 3u);
  EXPECT_EQ(parts[0].line, "7:0");
  EXPECT_TRUE(report_.left_out.empty());

  EXPECT_TRUE(drivable_parts(road_, bus(), {part("2.0", {"CD", "DF"})}, report_).empty());
  ASSERT_EQ(report_.left_out.size(), 1u);
  EXPECT_EQ(report_.left_out[0].first, "7 (2.0)");
}

TEST_F(LineTimetable, BusesOfEachDirectionAreALineOfTheirOwn) {
  const auto parts =
      drivable_parts(road_, bus(), {part("1.0", {"AB", "BC"}), part("1.1", {"CD", "DE"})}, report_);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].line, "7:0");
  EXPECT_EQ(parts[1].line, "7:1");
}

}  // namespace
}  // namespace sumogamma
