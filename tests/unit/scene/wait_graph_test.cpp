#include "scene/wait_graph.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/random.h"

namespace sumogamma {
namespace {

/// Rows that wait for one another: -1 for nobody.
Scene waiting(const std::vector<int>& foes) {
  Scene scene;
  for (std::size_t row = 0; row < foes.size(); ++row) {
    AgentState agent;
    agent.id = {static_cast<std::uint32_t>(10 * row + 3)};
    append_agent(scene, agent);
    scene.context[row].active = true;
    scene.context[row].foe = foes[row] < 0 ? -1 : 10 * foes[row] + 3;
  }
  return scene;
}

TEST(WaitGraph, KnowsChainsAndRings) {
  // 0 -> 1 -> 2; 3 -> 4 -> 5 -> 3 is a ring that 6 waits for; 7 waits for itself
  const WaitGraph graph(waiting({1, 2, -1, 4, 5, 3, 4, 7}));
  EXPECT_EQ(graph.foe(0), 1u);
  EXPECT_EQ(graph.foe(2), graph.size());
  for (std::size_t row = 0; row < graph.size(); ++row)
    EXPECT_EQ(graph.in_ring(row), (row >= 3 && row <= 5) || row == 7) << row;
  EXPECT_TRUE(graph.waits_for(0, 2));
  EXPECT_FALSE(graph.waits_for(2, 0));
  EXPECT_TRUE(graph.waits_for(6, 3));
  EXPECT_FALSE(graph.waits_for(6, 6));
  EXPECT_TRUE(graph.waits_for(5, 5)) << "over the others of its ring";
  EXPECT_FALSE(graph.waits_for(6, 0));
}

TEST(WaitGraph, WhoHasLeftIsWaitedForByNobody) {
  Scene scene = waiting({1, -1});
  scene.context[0].foe = 77;
  const WaitGraph graph(scene);
  EXPECT_EQ(graph.foe(0), graph.size());
}

TEST(WaitGraph, AgreesWithAWalkByHand) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    constexpr int kRows = 12;
    std::vector<int> foes;
    for (std::uint32_t row = 0; row < kRows; ++row)
      foes.push_back(
          static_cast<int>(random_uniform(seed, row, 0, Draw::Intention, -2.0, kRows - 0.01)));
    const WaitGraph graph(waiting(foes));
    for (int row = 0; row < kRows; ++row) {
      std::vector<bool> met(kRows, false);
      for (int next = foes[static_cast<std::size_t>(row)], k = 0; next >= 0 && k < kRows; ++k) {
        met[static_cast<std::size_t>(next)] = true;
        next = foes[static_cast<std::size_t>(next)];
      }
      for (std::size_t other = 0; other < kRows; ++other)
        EXPECT_EQ(graph.waits_for(static_cast<std::size_t>(row), other), met[other])
            << seed << ' ' << row << ' ' << other;
      EXPECT_EQ(graph.in_ring(static_cast<std::size_t>(row)), met[static_cast<std::size_t>(row)]);
    }
  }
}

}  // namespace
}  // namespace sumogamma
