#include "ego/way_beliefs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "support/ego_scene.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;

class WayBeliefsTest : public testing::LookingEgo {
 protected:
  /// What is believed of a row's way into an edge.
  double weight_of(std::size_t row, const std::string& edge) const {
    const WayBelief* belief = beliefs_.of(here_.scene.id[row]);
    if (belief == nullptr) return -1;
    double sum = 0;
    for (std::size_t i = 0; i < belief->ways.size(); ++i) {
      if (belief->ways[i].path == nullptr) continue;
      for (const PathLink& link : belief->ways[i].path->links) {
        const LaneId to = net().connection(link.connection).to;
        if (net().edge(net().lane(to).edge).name == edge) sum += belief->weights[i];
      }
    }
    return sum;
  }
};

TEST_F(WayBeliefsTest, ConcentrateOnALeftTurnerBeforeTheJunction) {
  const std::size_t foe = here_.add("car", {"WC", "CN"}, 158, 10, 0, -1, "WC_1");
  const double line = here_.path(foe).links.front().stop_line;
  look();
  const double begin = weight_of(foe, "CN");
  EXPECT_GT(begin, 0.1);
  EXPECT_LT(begin, 0.6);
  double before_line = begin;
  for (int k = 0; k < 60; ++k) {
    advance();
    look();
    const WayBelief* belief = beliefs_.of(here_.scene.id[foe]);
    ASSERT_NE(belief, nullptr);
    EXPECT_NEAR(std::accumulate(belief->weights.begin(), belief->weights.end(), 0.0), 1, 1e-12);
    if (here_.scene.path_along[foe] + 2.25 < line) before_line = weight_of(foe, "CN");
    if (here_.scene.path_along[foe] > line + 3) break;
  }
  EXPECT_GT(before_line, 0.6);
  EXPECT_GT(weight_of(foe, "CN"), 0.9);
}

TEST_F(WayBeliefsTest, AreUniformAgainOnANewLane) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 158, 10, 0, -1, "WC_1");
  const LaneId begin = [&] {
    look();
    return beliefs_.of(here_.scene.id[foe])->lane;
  }();
  bool moved = false;
  for (int k = 0; k < 40 && !moved; ++k) {
    advance();
    look();
    const WayBelief* belief = beliefs_.of(here_.scene.id[foe]);
    ASSERT_NE(belief, nullptr);
    if (belief->lane == begin) continue;
    moved = true;
    for (const double weight : belief->weights)
      EXPECT_DOUBLE_EQ(weight, 1.0 / static_cast<double>(belief->weights.size()));
  }
  EXPECT_TRUE(moved);
}

TEST_F(WayBeliefsTest, OfWhoWalksAreOnUntilItTurnsOff) {
  const std::size_t walker = here_.add("car", {"WC", "CE"}, 175, 0, 0, -1, "WC_1");
  const AgentTypeId on_foot = find_agent_type(here_.model.types, "pedestrian");
  here_.scene.type[walker] = on_foot;
  here_.scene.path[walker] = kNoPath;
  const auto walk_to = [&](IntentionKind kind, const Vec2& place) {
    here_.scene.behavior[walker].intention = {kind, place};
    advance();
    look();
    const WayBelief* belief = beliefs_.of(here_.scene.id[walker]);
    EXPECT_NEAR(std::accumulate(belief->weights.begin(), belief->weights.end(), 0.0), 1, 1e-12);
    return *belief;
  };
  const Vec2 east = here_.scene.position[walker] + Vec2(1000, 0);
  WayBelief belief;
  for (int k = 0; k < 9; ++k) belief = walk_to(IntentionKind::Goal, east);
  ASSERT_EQ(belief.ways.size(), 5u);
  EXPECT_GT(belief.ways.front().intention.goal.x(), 1.0);
  EXPECT_GT(belief.weights.front(), 0.9);
  EXPECT_GT(belief.weights[1], 0) << "nobody is sure for ever";
  const Vec2 north = here_.scene.position[walker] + Vec2(0, 1000);
  double least = 1;
  for (int k = 0; k < 9; ++k) {
    belief = walk_to(IntentionKind::Goal, north);
    least = std::min(least, belief.weights.front());
  }
  EXPECT_LT(least, 0.5) << "it was seen to turn";
  EXPECT_GT(belief.ways.front().intention.goal.y(), 1.0);
  EXPECT_GT(belief.weights.front(), 0.9);
  for (int k = 0; k < 9; ++k) belief = walk_to(IntentionKind::Stop, north);
  EXPECT_GT(belief.weights.back(), 0.9) << "it stands";
}

TEST_F(WayBeliefsTest, OfWhoIsGoneAreForgotten) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 190, 10, 0, -1, "WC_1");
  const AgentId id = here_.scene.id[foe];
  look();
  EXPECT_NE(beliefs_.of(id), nullptr);
  remove_agents(here_.scene, {false, true});
  for (int k = 0; k < 8; ++k) {
    advance();
    look();
  }
  EXPECT_EQ(beliefs_.of(id), nullptr);
}

TEST(Likelihood, FallsWithTurnAndWay) {
  const Vec2 ahead(3, 0);
  EXPECT_NEAR(likelihood(ahead, ahead), 1.001 * 1.001, 1e-12);
  EXPECT_LT(likelihood(ahead, Vec2(3.2, 0)), 0.2);
  EXPECT_LT(likelihood(ahead, 3 * direction_of(0.3)), 0.01);
  EXPECT_NEAR(likelihood(Vec2(0, 0), Vec2(0, 0)), 1.001 * 1.001, 1e-12);
  EXPECT_GT(likelihood(ahead, Vec2(0, 9)), 0);
}

TEST(CandidateWaysTest, LeadToEveryEdgeAtTheJunction) {
  const RoadNetwork network = read_plain_net(crossroads("priority"));
  CandidateWays ways(network);
  const AgentTypeTable types = default_agent_types();
  const AgentTypeId car = find_agent_type(types, "car");
  const auto found = ways.ways(type_of(types, car), car, network.lane_by_name.at("WC_0"));
  EXPECT_EQ(found.size(), 3u);
  for (const auto& path : found) {
    EXPECT_EQ(path->stretches.front().lane, network.lane_by_name.at("WC_0"));
    EXPECT_GT(path->line.length(), 290);
  }
  const AgentTypeId walker = find_agent_type(types, "pedestrian");
  EXPECT_TRUE(ways.ways(type_of(types, walker), walker, network.lane_by_name.at("WC_0")).empty());
  EXPECT_TRUE(ways.ways(type_of(types, car), car, kNoLane).empty());
}

}  // namespace
}  // namespace sumogamma
