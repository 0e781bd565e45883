#include "osm/repairs/tag_values.h"

#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

/// The value of a key of a road after correct_tag_values(), "" where it was taken out.
std::string corrected(const std::string& key, const std::string& value, MapBuilder& b,
                      const std::string& highway = "secondary") {
  b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, {{"highway", highway}, {key, value}});
  correct_tag_values(b.map, b.log);
  return tag(b.map.ways.back().tags, key);
}

std::string corrected(const std::string& key, const std::string& value) {
  MapBuilder b;
  return corrected(key, value, b);
}

TEST(SpeedLimit, ReadsWhatMappersWrite) {
  EXPECT_NEAR(speed_limit("50").value(), 50, 1e-9);
  EXPECT_NEAR(speed_limit("30 mph").value(), 48.28032, 1e-9);
  EXPECT_NEAR(speed_limit("30mph").value(), 48.28032, 1e-9);
  EXPECT_NEAR(speed_limit("50 km/h").value(), 50, 1e-9);
  EXPECT_NEAR(speed_limit("walk").value(), 5, 1e-9);
  EXPECT_NEAR(speed_limit("DE:zone30").value(), 30, 1e-9);
  EXPECT_NEAR(speed_limit("FR:30").value(), 30, 1e-9);
  EXPECT_NEAR(speed_limit("30 mph;40 mph").value(), 48.28032, 1e-9);
  EXPECT_NEAR(speed_limit("70|100").value(), 70, 1e-9);
}

TEST(SpeedLimit, RefusesWhatNobodyMeans) {
  for (const char* value : {"0", "-10", "999", "0 mph", "fast", "", "50 apples", "nan", "1e400"})
    EXPECT_FALSE(speed_limit(value)) << value;
}

TEST(CorrectTagValues, TakesOutSpeedsThatNobodyMeans) {
  for (const char* value : {"0", "-10", "999", "5000 mph", "fast"}) {
    MapBuilder b;
    EXPECT_EQ(corrected("maxspeed", value, b), "") << value;
    EXPECT_EQ(b.log.count("maxspeed_not_meant"), 1) << value;
    EXPECT_EQ(b.log.issues().at("maxspeed_not_meant").severity, Severity::Warning);
  }
  EXPECT_EQ(corrected("maxspeed", "70|100"), "70");
  EXPECT_EQ(corrected("maxspeed", "30mph"), "48.3");
  for (const char* value : {"50", "none", "DE:urban", "5"})
    EXPECT_EQ(corrected("maxspeed", value), value);
  EXPECT_EQ(corrected("maxspeed", "signals"), "");
  EXPECT_EQ(corrected("maxspeed:backward", "0"), "");
}

TEST(CorrectTagValues, BoundsLanes) {
  for (const char* value : {"99", "0", "-1", "abc", "1e9", "2147483648"}) {
    MapBuilder b;
    EXPECT_EQ(corrected("lanes", value, b), "") << value;
    EXPECT_EQ(b.log.count("lanes_not_meant"), 1) << value;
  }
  EXPECT_EQ(corrected("lanes", "3"), "3");
  EXPECT_EQ(corrected("lanes", "2 "), "2");
  EXPECT_EQ(corrected("lanes", "1.5"), "2");
  EXPECT_EQ(corrected("lanes", "2;3"), "2");
  EXPECT_EQ(corrected("lanes", "12"), "12");
  EXPECT_EQ(corrected("lanes:forward", "12"), "");
  EXPECT_EQ(corrected("turn:lanes", "left|through|right"), "left|through|right");
  EXPECT_EQ(corrected("turn:lanes", std::string(40, '|')), "");
}

TEST(CorrectTagValues, BoundsLayersAndKnowsDirections) {
  EXPECT_EQ(corrected("layer", "-2"), "-2");
  for (const char* value : {"99", "1;2", "up", "0.5"}) EXPECT_EQ(corrected("layer", value), "");
  EXPECT_EQ(corrected("oneway", "-1"), "-1");
  for (const char* value : {"reversible", "weird"}) {
    MapBuilder b;
    EXPECT_EQ(corrected("oneway", value, b), "");
    EXPECT_EQ(b.log.count("oneway_by_hour") + b.log.count("oneway_unknown"), 1);
  }
}

TEST(CorrectTagValues, ALaneForTurningInTheMiddleIsNoLaneStraightOn) {
  for (const auto& [all, forward, left] :
       {std::tuple{"3", "", "2"}, std::tuple{"3", "1", "2"}, std::tuple{"5", "", "4"}}) {
    MapBuilder b;
    Tags tags = {{"highway", "secondary"},
                 {"lanes", all},
                 {"lanes:both_ways", "1"},
                 {"turn:lanes:both_ways", "left"}};
    if (*forward != 0) tags["lanes:forward"] = tags["lanes:backward"] = forward;
    b.node(1, 0, 0).node(2, 200, 0).way(10, {1, 2}, tags);
    correct_tag_values(b.map, b.log);
    EXPECT_EQ(tag(b.map.ways[0].tags, "lanes"), left);
    EXPECT_EQ(tag(b.map.ways[0].tags, "turn:lanes:both_ways"), "");
    EXPECT_EQ(b.log.count("center_turn_lane"), 1);
  }
}

TEST(CorrectTagValues, LeavesPathsAlone) {
  MapBuilder b;
  EXPECT_EQ(corrected("maxspeed", "0", b, "footway"), "0");
  EXPECT_TRUE(b.log.issues().empty());
}

}  // namespace
}  // namespace sumogamma::osm
