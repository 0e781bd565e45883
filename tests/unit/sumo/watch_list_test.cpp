#include "sumo/watch_list.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/random.h"

namespace sumogamma {
namespace {

TEST(WatchList, KeepsTheOrderOfAsking) {
  WatchList list;
  EXPECT_TRUE(list.add("b", false));
  EXPECT_TRUE(list.add("a", false));
  EXPECT_TRUE(list.add("b", true));  // a person of a vehicle's name
  EXPECT_FALSE(list.add("b", false));
  EXPECT_TRUE(list.drop("b", false));
  EXPECT_FALSE(list.drop("b", false));
  ASSERT_EQ(list.entries().size(), 2u);
  EXPECT_EQ(list.entries()[0].id, "a");
  EXPECT_TRUE(list.entries()[1].is_person);
}

// law: the same as a plain vector searched from front to back
TEST(WatchList, AgreesWithAPlainList) {
  WatchList list;
  std::vector<std::pair<std::string, bool>> plain;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const std::uint64_t bits = random_bits(1, i, 0, Draw::Demand);
    const std::pair<std::string, bool> who = {std::to_string(bits % 40), (bits >> 20) % 2 == 0};
    const auto found = std::find(plain.begin(), plain.end(), who);
    if ((bits >> 30) % 2 == 0) {
      EXPECT_EQ(list.add(who.first, who.second), found == plain.end());
      if (found == plain.end()) plain.push_back(who);
    } else {
      EXPECT_EQ(list.drop(who.first, who.second), found != plain.end());
      if (found != plain.end()) plain.erase(found);
    }
    if ((bits >> 40) % 4 != 0) continue;
    const auto& entries = list.entries();
    ASSERT_EQ(entries.size(), plain.size());
    for (std::size_t k = 0; k < plain.size(); ++k) {
      EXPECT_EQ(entries[k].id, plain[k].first);
      EXPECT_EQ(entries[k].is_person, plain[k].second);
    }
  }
}

}  // namespace
}  // namespace sumogamma
