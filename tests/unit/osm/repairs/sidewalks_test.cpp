#include "osm/repairs/sidewalks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

/// What becomes of the tags of a road.
Tags normalised(const std::string& highway, Tags tags) {
  tags["highway"] = highway;
  MapBuilder b;
  b.node(1, 0, 0).node(2, 100, 0).way(10, {1, 2}, std::move(tags));
  rewrite_sidewalks(b.map, b.log);
  return b.map.ways[0].tags;
}

TEST(RewriteSidewalks, WritesSidewalksAsNetconvertReadsThem) {
  const std::pair<Tags, std::string> cases[] = {
      {{{"sidewalk", "separate"}}, "no"},
      {{{"sidewalk", "none"}}, "no"},
      {{{"sidewalk:left", "yes"}}, "left"},
      {{{"sidewalk:right", "yes"}, {"sidewalk:left", "no"}}, "right"},
      {{{"sidewalk:both", "yes"}}, "both"},
      {{{"sidewalk:both", "separate"}}, "no"},
      {{{"sidewalk", "both"}}, "both"},
      {{{"tunnel", "yes"}}, "no"},
      {{{"tunnel", "yes"}, {"sidewalk", "both"}}, "both"},
      {{}, ""}};
  for (const auto& [tags, expected] : cases)
    EXPECT_EQ(tag(normalised("residential", tags), "sidewalk"), expected);
}

// somebody on foot met a bus in a tunnel of one lane to each side, and was pressed back through it
// for four minutes, with a dozen behind the bus
TEST(RewriteSidewalks, NobodyWalksThroughATunnelUnlessTheMapSaysSo) {
  const std::pair<Tags, std::string> cases[] = {{{{"tunnel", "yes"}}, "no"},
                                                {{{"tunnel", "yes"}, {"foot", "yes"}}, "yes"},
                                                {{{"tunnel", "yes"}, {"sidewalk", "both"}}, ""},
                                                {{{"tunnel", "yes"}, {"sidewalk:left", "yes"}}, ""},
                                                {{{"tunnel", "building_passage"}}, ""},
                                                {{}, ""}};
  for (const auto& [tags, expected] : cases)
    EXPECT_EQ(tag(normalised("primary", tags), "foot"), expected);
}

}  // namespace
}  // namespace sumogamma::osm
