#include "planning/belief_tree.h"

#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "base/hash.h"
#include "support/belief_episodes.h"
#include "support/recorded_bits.h"

namespace sumogamma {
namespace {

using testing::RockSample;
using testing::RockSampleWorld;
using testing::TagWorld;

template <class Problem>
std::uint64_t hash_of(const BeliefTree<Problem>& tree) {
  std::uint64_t hash = kFnvBasis;
  const auto take = [&](std::uint64_t word) {
    for (int byte = 0; byte < 8; ++byte)
      hash = fnv1a(hash, static_cast<unsigned char>(word >> (8 * byte)));
  };
  for (const BeliefNode& node : tree.beliefs()) {
    for (const double value : {node.bounds.lower, node.bounds.upper, node.bounds.utility})
      take(std::bit_cast<std::uint64_t>(value));
    take(node.parent);
    take(node.particles);
  }
  for (const ActionNode& node : tree.action_nodes()) {
    take(std::bit_cast<std::uint64_t>(node.bounds.lower));
    take(static_cast<std::uint64_t>(node.action));
  }
  return hash;
}

template <class World>
std::uint64_t hash_of_search(World world, double pruning) {
  using Problem = typename World::Problem;
  world.begin(0.4);
  std::vector<typename Problem::State> states;
  testing::draw_scenarios(world, 5, 200, states);
  const std::vector<double> weights(200, 1.0 / 200);
  BeliefTree<Problem> tree;
  tree.search(world.problem, {states, weights, 5}, {.pruning = pruning}, {.expansions = 60});
  return hash_of(tree);
}

// The exact bits of whole trees: a changed hash is a changed search.
TEST(GoldenBeliefTrees, HaveTheRecordedBits) {
  if (!test::computes_as_recorded()) GTEST_SKIP() << test::kOtherLibrary;
  EXPECT_EQ(hash_of_search(RockSampleWorld{.problem = RockSample::of_size(7)}, 0),
            3982417540135199812ULL);
  EXPECT_EQ(hash_of_search(TagWorld{}, 0.01), 8306432010190302651ULL);
}

}  // namespace
}  // namespace sumogamma
