#include "study/shard.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "base/error.h"

namespace sumogamma {
namespace {

TEST(Shards, ShareAListOut) {
  std::vector<int> all(18);
  std::iota(all.begin(), all.end(), 0);
  std::set<int> seen;
  for (std::size_t part = 1; part <= 4; ++part) {
    const std::vector<int> shard = shard_of(all, {part, 4});
    EXPECT_NEAR(static_cast<double>(shard.size()), 4.5, 0.6);
    for (const int one : shard) EXPECT_TRUE(seen.insert(one).second);
  }
  EXPECT_EQ(seen.size(), all.size());
}

TEST(Shards, AreReadOrRefusedByName) {
  const Shard second = parse_shard("2/4");
  EXPECT_EQ(second.part, 2u);
  EXPECT_EQ(second.parts, 4u);
  EXPECT_EQ(parse_shard("").parts, 1u);
  for (const char* wrong : {"0/4", "5/4", "2", "2/", "/4", "a/b", "2/4/", "-1/4", "1/1000001"}) {
    try {
      parse_shard(wrong);
      ADD_FAILURE() << wrong;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(std::string("--shard ") + wrong), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace sumogamma
