#include "sumo/entry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace sumogamma {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Entry, PeopleWhosePlaceIsTakenStartFurtherAside) {
  EXPECT_THAT(other_entry_offsets(-0.3, -1.2, 1.2, 0.5), ElementsAre(DoubleNear(-1.0, 1e-9)));
  EXPECT_THAT(other_entry_offsets(0.8, -2.4, 2.4, 0.5),
              ElementsAre(DoubleNear(1.5, 1e-9), DoubleNear(0.1, 1e-9), DoubleNear(2.2, 1e-9)));
}

TEST(Entry, PeopleStartNeitherAmongThoseWhoComeTowardsThemNorOffTheSidewalk) {
  EXPECT_THAT(other_entry_offsets(-0.5, -1.1, 1.1, 0.5), IsEmpty());
}

}  // namespace
}  // namespace sumogamma
