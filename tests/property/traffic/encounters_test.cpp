#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/random.h"
#include "model/stopping_guard.h"
#include "scene/extent.h"
#include "support/road_scene.h"
#include "traffic/junction/laws.h"
#include "traffic/patience.h"

namespace sumogamma {
namespace {

using testing::crossroads;
using testing::read_plain_net;
using testing::RoadScene;

constexpr std::uint64_t kDrawn = 100;

/// Two vehicles that stand at their lines on different arms of a crossroads.
struct Pair {
  std::size_t first, second;
};

/// Draws vehicles at their lines.
class Drawn {
 public:
  Drawn(RoadScene& here, std::uint64_t seed) : here_(here), seed_(seed) {}
  std::size_t below(std::size_t n) {
    const double draw = random_uniform(seed_, count_++, 0, Draw::Demand);
    return std::min(n - 1, static_cast<std::size_t>(draw * static_cast<double>(n)));
  }
  /// One of any kind on an arm, bound for another.
  std::size_t stand(std::size_t arm) {
    static const std::vector<std::string> kArms{"W", "N", "E", "S"};
    static const std::vector<std::string> kKinds{"car", "bus", "bicycle", "truck", "motorcycle"};
    const std::string to = kArms[(arm + 1 + below(3)) % 4];
    const std::size_t row = here_.add(kKinds[below(5)], {kArms[arm] + "C", "C" + to}, 100, 0);
    const double past = here_.past_line(row);
    here_.move(row, here_.scene.path_along[row] - past - 0.6);
    return row;
  }

 private:
  RoadScene& here_;
  std::uint64_t seed_, count_ = 0;
};

Pair draw_pair(RoadScene& here, std::uint64_t seed) {
  Drawn drawn(here, seed);
  const std::size_t from = drawn.below(4), other = (from + 1 + drawn.below(3)) % 4;
  const std::size_t first = drawn.stand(from);
  return {first, drawn.stand(other)};
}

/// By right of way, or for the room in which a long body turns.
bool waits_for(const RoadScene& here, std::size_t row, std::size_t other) {
  const LimitReason reason = here.context(row).reason;
  return (reason == LimitReason::Yield || reason == LimitReason::TurningRoom) &&
         here.context(row).foe == static_cast<std::int64_t>(here.scene.id[other].value);
}

/// Lets time pass in which nobody moves [s].
void stand_for(RoadScene& here, double duration) {
  constexpr double kStep = 0.1;  // [s]
  for (double time = 0.0; time < duration; time += kStep) {
    here.update(1, kStep);
    for (std::size_t row = 0; row < here.scene.size(); ++row) {
      count_waiting(TrafficParameters{}, kStep, Kinematics::SingleTrack, here.scene, here.traffic,
                    row);
      update_held(kStep, here.scene, row);
    }
    here.scene.time += kStep;
    ++here.scene.tick;
  }
}

/// Do their ways cross in an area in which both would be at a time? Where they come together in a
/// lane the second follows the first.
bool would_meet(const RoadScene& here, const Pair& pair) {
  const ConnectionId own = here.path(pair.first).links.front().connection;
  const ConnectionId their = here.path(pair.second).links.front().connection;
  const RoadNetwork& network = here.model.road;
  if (network.connection(own).to == network.connection(their).to) return false;
  const bool wide = is_wide(here.scene, pair.first) || is_wide(here.scene, pair.second);
  for (const ConflictZone& zone : here.model.conflicts[index_of(own)]) {
    if (zone.foe != their) continue;
    const auto area = zone_for(zone, wide);
    if (!area) continue;
    const Occupation ours = here.occupation_of(pair.first, area->begin, area->end);
    const Occupation theirs = here.occupation_of(pair.second, area->foe_begin, area->foe_end);
    if (ours.begin < theirs.end && theirs.begin < ours.end) return true;
  }
  return false;
}

class Encounters : public ::testing::TestWithParam<const char*> {};

// of two who stand at their lines and would meet, exactly one waits for the other, whoever is asked
TEST_P(Encounters, OfTwoAtTheirLinesOneGoesFirst) {
  const RoadNetwork network = read_plain_net(crossroads(GetParam()));
  int met = 0;
  for (std::uint64_t seed = 0; seed < kDrawn; ++seed) {
    SCOPED_TRACE(seed);
    RoadScene here(network);
    const Pair pair = draw_pair(here, seed);
    stand_for(here, 2.0);
    const bool first_waits = waits_for(here, pair.first, pair.second);
    const bool second_waits = waits_for(here, pair.second, pair.first);
    EXPECT_FALSE(first_waits && second_waits) << "both wait";
    if (!would_meet(here, pair)) continue;
    ++met;
    const auto way = [&](std::size_t row) {
      const Connection& link = network.connection(here.path(row).links.front().connection);
      return network.lane(link.from).name + " to " + network.lane(link.to).name;
    };
    EXPECT_TRUE(first_waits || second_waits)
        << "both go: " << type_of(here.model.types, here.scene.type[pair.first]).name << " from "
        << way(pair.first) << ", " << type_of(here.model.types, here.scene.type[pair.second]).name
        << " from " << way(pair.second);
  }
  EXPECT_GT(met, 10);
}

/// What another means for a row where their first links conflict; none where they don't.
std::optional<Verdict> verdict_of(const RoadScene& here, std::size_t row, std::size_t other) {
  const TrafficView view = here.view();
  const PathLink &link = here.path(row).links.front(), &their = here.path(other).links.front();
  const EgoOnPath& ego = view.perception.ego[row];
  const Traveller traveller{row, ego.along + ego.half_length, 2.0 * ego.half_length, ego.speed};
  const bool wide = is_wide(here.scene, row) || is_wide(here.scene, other);
  for (const ConflictZone& of_table : here.model.conflicts[index_of(link.connection)]) {
    const auto zone = zone_for(of_table, wide);
    if (of_table.foe != their.connection || !zone) continue;
    for (const Approach& foe : view.approaches.of(their.connection))
      if (foe.row == other) return judge(meet(view, traveller, link, *zone, foe));
  }
  return {};
}

// wherever two are, however fast and for how long they have waited for whom: never both are told to
// wait for the other, and one is where both drive and would be in the area at a time
TEST_P(Encounters, WhoeverIsAskedOneAnswerGoesWithTheOther) {
  const RoadNetwork network = read_plain_net(crossroads(GetParam()));
  int met = 0;
  for (std::uint64_t seed = 0; seed < 10 * kDrawn; ++seed) {
    SCOPED_TRACE(seed);
    RoadScene here(network);
    const Pair pair = draw_pair(here, seed);
    Drawn drawn(here, seed + 10 * kDrawn);
    const auto draw = [&](double low, double high) {
      return low + (high - low) * static_cast<double>(drawn.below(1000)) / 1000.0;
    };
    for (const std::size_t row : {pair.first, pair.second}) {
      here.set_speed(row, std::max(draw(-4.0, 14.0), 0.0));
      here.move(row, here.scene.path_along[row] - draw(-8.0, 40.0));
      here.traffic.waiting_time[row] = std::max(draw(-60.0, 60.0), 0.0);
    }
    here.update();
    for (const std::size_t row : {pair.first, pair.second}) {
      static const std::vector<LimitReason> kReasons{LimitReason::None, LimitReason::Yield,
                                                     LimitReason::Leader, LimitReason::LetsIn,
                                                     LimitReason::BlockedJunction};
      const std::size_t other = row == pair.first ? pair.second : pair.first;
      here.scene.context[row].reason = kReasons[drawn.below(kReasons.size())];
      here.scene.context[row].foe = static_cast<std::int64_t>(other);
      here.scene.held[row].standing = here.traffic.waiting_time[row];
    }
    here.update();
    const auto first = verdict_of(here, pair.first, pair.second);
    const auto second = verdict_of(here, pair.second, pair.first);
    if (!first || !second) continue;
    EXPECT_FALSE(first == Verdict::Blocks && second == Verdict::Blocks) << "both wait";
    const auto comes = [&](std::size_t row) {
      const LimitReason why = here.approaches.waiting(row).reason;
      const bool halts = why == LimitReason::LetsIn || why == LimitReason::BlockedJunction;
      return here.scene.speed[row] > 1.0 && here.past_line(row) < 0.0 && !halts;
    };
    if (!comes(pair.first) || !comes(pair.second) || !would_meet(here, pair)) continue;
    ++met;
    EXPECT_TRUE(first == Verdict::Blocks || second == Verdict::Blocks) << "both go";
  }
  EXPECT_GT(met, 20);
}

// four who stand at their lines and wait for one another in a ring have somebody go before they are
// Pressing, and don't form one again
TEST_P(Encounters, NoRingOfWaitsLastsLongerThanPatience) {
  const RoadNetwork network = read_plain_net(crossroads(GetParam()));
  for (std::uint64_t seed = 0; seed < kDrawn / 4; ++seed) {
    SCOPED_TRACE(seed);
    RoadScene here(network);
    Drawn drawn(here, seed);
    for (std::size_t arm = 0; arm < 4; ++arm) drawn.stand(arm);
    stand_for(here, here.parameters.pressing + 1.0);
    const WaitGraph waits(here.scene);
    for (std::size_t row = 0; row < here.scene.size(); ++row)
      EXPECT_FALSE(waits.in_ring(row)) << "row " << row;
  }
}

INSTANTIATE_TEST_SUITE_P(Junctions, Encounters,
                         ::testing::Values("priority", "priority_stop", "right_before_left",
                                           "allway_stop"));

}  // namespace
}  // namespace sumogamma
