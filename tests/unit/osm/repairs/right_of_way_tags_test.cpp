#include "osm/repairs/right_of_way_tags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/converted_map.h"

namespace sumogamma::osm {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

// four equal streets; the numbers of their ways are those of their outer nodes plus ten
constexpr const char* kCrossroads = R"xml(<?xml version="1.0"?>
<osm version="0.6">
  <node id="1" lat="51.0000" lon="-1.0000"/>
  <node id="2" lat="51.0000" lon="-1.0015"/>
  <node id="3" lat="51.0010" lon="-1.0000"/>
  <node id="4" lat="51.0000" lon="-0.9985"/>
  <node id="5" lat="50.9990" lon="-1.0000"/>
  <way id="12"><nd ref="2"/><nd ref="1"/>
    <tag k="highway" v="residential"/><tag k="maxspeed" v="30"/></way>
  <way id="13"><nd ref="1"/><nd ref="3"/>
    <tag k="highway" v="residential"/><tag k="maxspeed" v="30"/></way>
  <way id="14"><nd ref="1"/><nd ref="4"/>
    <tag k="highway" v="residential"/><tag k="maxspeed" v="30"/></way>
  <way id="15"><nd ref="5"/><nd ref="1"/>
    <tag k="highway" v="residential"/><tag k="maxspeed" v="30"/></way>
</osm>)xml";

/// The crossroads as netconvert makes them and, once patched, makes them again.
struct Crossroads : ::testing::TestWithParam<bool> {
  ConvertedMap map{kCrossroads, GetParam()};
  RoadNetwork road;
  Crossroads() {
    run_netconvert(map.request);
    road = map.read();
  }
  void apply(const NetworkPatch& patch) {
    patch_network(map.request, map.load().net(), patch);
    road = map.read();
  }
  /// Edges for whose traffic that from `from` to `to` waits.
  std::set<std::string> waits_for(const std::string& from, const std::string& to) const {
    const auto edge_of = [&](LaneId lane) { return road.edge(road.lane(lane).edge).name; };
    std::set<std::string> others;
    const Junction& junction = road.junction(road.junction_by_name.at("1"));
    for (std::size_t own = 0; own < junction.requests.size(); ++own) {
      const Connection& link = road.connection(junction.links[own]);
      if (edge_of(link.from) != from || edge_of(link.to) != to) continue;
      for (std::size_t other = 0; other < junction.requests.size(); ++other)
        if (junction.requests[own].yields_to[other])
          others.insert(edge_of(road.connection(junction.links[other]).from));
    }
    return others;
  }
};

TEST_P(Crossroads, WhoHasASignWaitsForThoseWithout) {
  ASSERT_EQ(road.junction(road.junction_by_name.at("1")).type, "right_before_left");
  ASSERT_THAT(waits_for(GetParam() ? "15" : "-14", GetParam() ? "14" : "-12"),
              Contains(GetParam() ? "12" : "-13"));
  // from the west and from the north, of which the second is against its way
  NetworkPatch patch;
  patch.prohibitions = give_way_rules(map.load(), {{1, {{12, 1}, {13, -1}}}});
  for (const Prohibition& rule : patch.prohibitions)
    EXPECT_TRUE((rule.waits_from == "12" || rule.waits_from == "-13") &&
                (rule.from == "-14" || rule.from == "15"))
        << rule.from << " before " << rule.waits_from;
  apply(patch);
  EXPECT_THAT(waits_for("12", "14"), ::testing::IsSupersetOf({"15"}));
  EXPECT_THAT(waits_for("-13", "-15"), ::testing::IsSupersetOf({"-14"}));
  for (const char* free : {"15", "-14"})
    for (const char* to : {"-12", "13", "14", "-15"})
      EXPECT_THAT(waits_for(free, to), ::testing::AllOf(Not(Contains("12")), Not(Contains("-13"))))
          << free << " to " << to;
}

TEST_P(Crossroads, SignsOnAllRoadsOrOnNoneChangeNothing) {
  EXPECT_THAT(give_way_rules(map.load(), {}), IsEmpty());
  EXPECT_THAT(give_way_rules(map.load(), {{7, {{12, 1}}}}), IsEmpty()) << "elsewhere";
  EXPECT_THAT(give_way_rules(map.load(), {{1, {{12, -1}}}}), IsEmpty()) << "turned away";
  EXPECT_THAT(give_way_rules(map.load(), {{1, {{12, 1}, {13, -1}, {14, -1}, {15, 1}}}}), IsEmpty());
}

// who comes round the middle of a mini-roundabout comes from the right where traffic keeps left
TEST_P(Crossroads, AtAMiniRoundaboutWhoComesRoundTheMiddleGoesFirst) {
  OsmMap tagged;
  EXPECT_THAT(mini_roundabouts(road, tagged), IsEmpty());
  tagged.nodes[1].tags = {{"highway", "mini_roundabout"}};
  EXPECT_THAT(mini_roundabouts(road, tagged), ElementsAre("1"));
  NetworkPatch patch;
  patch.junction_types["1"] = "left_before_right";
  apply(patch);
  const bool left = GetParam();
  // straight on to the north, past who comes from the west and from the east
  EXPECT_THAT(waits_for("15", "13"), Contains(left ? "-14" : "12"));
  EXPECT_THAT(waits_for("15", "13"), Not(Contains(left ? "12" : "-14")));
}

INSTANTIATE_TEST_SUITE_P(LeftHand, Crossroads, ::testing::Bool());

}  // namespace
}  // namespace sumogamma::osm
