#include "osm/repairs/turn_restrictions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/map_builder.h"

namespace sumogamma::osm {
namespace {

using ::testing::SizeIs;

TEST(TurnRestrictions, KeepsOnlyWholeOnes) {
  MapBuilder b = crossroads_with_stop_lines();
  const auto restriction = [](std::int64_t id, std::int64_t to, std::int64_t via) {
    return MapRelation{id,
                       {{'w', 101, "from"}, {'n', via, "via"}, {'w', to, "to"}},
                       {{"restriction", "no_left_turn"}}};
  };
  b.map.relations = {restriction(1, 104, 1), restriction(2, 999, 1), restriction(3, 104, 2)};
  drop_broken_restrictions(b.map, b.log);
  ASSERT_THAT(b.map.relations, SizeIs(1));
  EXPECT_EQ(b.map.relations[0].id, 1);
}

}  // namespace
}  // namespace sumogamma::osm
