#include "ego/futures.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/ego_scene.h"

namespace sumogamma {
namespace {

class FuturesTest : public testing::LookingEgo {
 protected:
  void watch(int looks) {
    for (int k = 0; k < looks; ++k) {
      look();
      advance();
    }
  }
  Futures ask(int samples, bool knows = false) {
    return with_view([&](const EgoView& seen) {
      return sample_futures(seen, {{0.0}, samples, 1, knows}, beliefs_, forward_);
    });
  }
  /// Ways of the only other agent until the end of each sample [m].
  static std::vector<double> ways(const Futures& futures, const Vec2& from) {
    std::vector<double> found;
    const std::size_t samples = futures.poses.size() / futures.steps / 2;
    for (std::size_t sample = 1; sample <= samples; ++sample)
      found.push_back((futures.poses[sample * futures.steps * 2 - 1].position - from).norm());
    return found;
  }
};

TEST_F(FuturesTest, OfWhoIsKeptStandingBySomethingUnseenStands) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 165, 0, 0, -1, "WC_1");
  here_.scene.control[foe] = Control::Parked;  // for a reason that the ego can't know
  watch(8);
  const Futures futures = ask(20);
  ASSERT_EQ(futures.agents.size(), 2u);
  int set_off = 0;
  for (const double way : ways(futures, here_.scene.position[foe])) set_off += way > 1.0;
  EXPECT_LE(set_off, 1);
}

TEST_F(FuturesTest, OfWhoDrivesFreelyGoOnAtItsSpeed) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 158, 8, 0, -1, "WC_1");
  here_.scene.preferred_speed[foe] = 8;  // well under what a car's driver mostly wants
  watch(3);
  const Futures futures = ask(8);
  ASSERT_EQ(futures.agents.size(), 2u);
  for (const double way : ways(futures, here_.scene.position[foe]))
    EXPECT_LT(way, 8 * 4 * 1.15 + 1.0);
}

TEST_F(FuturesTest, TakeEachWayAsOftenAsItIsBelieved) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 176, 10, 0, -1, "WC_1");
  watch(1);
  const WayBelief* belief = beliefs_.of(here_.scene.id[foe]);
  ASSERT_NE(belief, nullptr);
  ASSERT_GT(belief->weights.size(), 2u);
  const Futures futures = ask(40);
  int stopped = 0;
  for (const double way : ways(futures, here_.scene.position[foe])) stopped += way < 15.0;
  EXPECT_NEAR(stopped, 40 * belief->weights.back(), 1.0);
}

TEST_F(FuturesTest, OfWhoKnowsFollowEverybodysOwnWay) {
  const std::size_t foe = here_.add("car", {"WC", "CE"}, 176, 10, 0, -1, "WC_1");
  watch(1);
  const Path& way = *here_.road.path(here_.scene.path[foe]);
  const Futures futures = ask(3, true);
  const std::vector<double> covered = ways(futures, here_.scene.position[foe]);
  ASSERT_EQ(covered.size(), 3u);
  for (const double one : covered) EXPECT_GT(one, 25.0) << "stops as likely, as far as is believed";
  const Vec2 end = futures.poses[futures.steps * 2 - 1].position;
  EXPECT_LT(way.line.project(end).distance, 1.0);
}

TEST_F(FuturesTest, ChangeNothingAndAreTheSameAgain) {
  here_.add("car", {"WC", "CE"}, 176, 10, 0, -1, "WC_1");
  watch(1);
  const auto before = hash_state(here_.scene);
  const Futures once = ask(5), again = ask(5);
  EXPECT_EQ(hash_state(here_.scene), before);
  ASSERT_EQ(once.poses.size(), again.poses.size());
  for (std::size_t k = 0; k < once.poses.size(); ++k)
    EXPECT_EQ(once.poses[k].position, again.poses[k].position);
}

}  // namespace
}  // namespace sumogamma
