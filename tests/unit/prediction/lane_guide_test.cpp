#include "prediction/lane_guide.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/units.h"
#include "prediction/methods.h"
#include "support/plain_net.h"

namespace sumogamma {
namespace {

/// A crossroads with signals (tests/support/plain_net.h) and cars that are seen on it.
class LaneGuideTest : public ::testing::Test {
 protected:
  static const RoadNetwork& crossing() {
    static const RoadNetwork network =
        testing::read_plain_net(testing::crossroads("traffic_light"));
    return network;
  }
  void SetUp() override {
    network_ = crossing();
    set_.name = "made";
    show(1e9, 'G', 'G');
  }
  /// Every signal shows `first` until `time` [s] and then `second`.
  void show(double time, char first, char second) {
    for (Signal& signal : network_.signals)
      signal.phases = {{time, std::string(signal.size, first)},
                       {1e9, std::string(signal.size, second)}};
  }
  PredictionMap map(bool recorded = true) const {
    PredictionMap map;
    map.name = "made.net.xml";
    map.network = &network_;
    map.offset = offset_;
    map.recorded.assign(network_.signals.size(), recorded);
    return map;
  }
  /// A car that goes from `from` on at `velocity` [m/s] for `frames` frames.
  void add(const Vec2& from, const Vec2& velocity, double heading, std::size_t frames = 8) {
    Track track;
    track.id = static_cast<std::uint32_t>(set_.tracks.size() + 1);
    track.type = find_agent_type(types_, "car");
    for (std::size_t k = 0; k < frames; ++k) {
      track.position.push_back(from - offset_ + 0.4 * static_cast<double>(k) * velocity);
      track.heading.push_back(heading);
    }
    set_.tracks.push_back(track);
    set_.last_frame = std::max(set_.last_frame, static_cast<int>(frames) - 1);
  }
  std::array<ExpertPath, kLaneMotions> paths(const LaneGuide& guide, std::size_t row) const {
    std::array<double, FlowMemory::kSteps> changing{};
    std::array<ExpertPath, kLaneMotions> paths;
    guide.paths(row, changing, paths);
    return paths;
  }
  LaneGuide looked(const PredictionMap& map, int frame = 7) const {
    LaneGuide guide(types_, map);
    guide.look(observe(set_, frame));
    return guide;
  }
  static const ExpertPath& of(const std::array<ExpertPath, kLaneMotions>& paths,
                              LaneMotion motion) {
    return paths[static_cast<std::size_t>(motion)];
  }

  AgentTypeTable types_ = recorded_agent_types();
  RoadNetwork network_;
  TrackSet set_;
  Vec2 offset_ = Vec2::Zero();
};

TEST_F(LaneGuideTest, KnowsTheWaysOfALane) {
  add({1.6, -60}, {0, 8}, radians(90));
  const LaneGuide guide = looked(map());
  ASSERT_TRUE(guide.guides(0));
  ASSERT_EQ(guide.ways(0).size(), 3u) << "straight on, left and right";
  double sum = 0;
  for (const LaneWay& way : guide.ways(0)) {
    sum += way.weight;
    EXPECT_NEAR(way.offset, 0.0, 0.1);
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  // well before the junction all ways are one
  EXPECT_NEAR(of(paths(guide, 0), LaneMotion::Steady)[2].y(), 3 * 0.4 * 8, 0.05);
}

TEST_F(LaneGuideTest, WeighsWaysByHowSomebodyGoes) {
  // on the junction, going straight on: nobody turns who doesn't
  add({1.6, -28}, {0, 10}, radians(90));
  const LaneGuide guide = looked(map());
  ASSERT_TRUE(guide.guides(0));
  for (const LaneWay& way : guide.ways(0)) {
    const Vec2 end = way.path->line.point_at(way.path->line.length());
    EXPECT_TRUE(way.weight > 0.9 || std::abs(end.x()) > 50) << way.weight;
  }
}

TEST_F(LaneGuideTest, HaltsAtRecordedRedLights) {
  show(1e9, 'r', 'r');
  add({1.6, -60}, {0, 8}, radians(90));
  const auto at_red = paths(looked(map()), 0), unknown = paths(looked(map(false)), 0);
  const double now = set_.tracks[0].position.back().y();
  EXPECT_LT(now + of(at_red, LaneMotion::Driven)[11].y(), -8);
  EXPECT_GT(now + of(at_red, LaneMotion::Driven)[11].y(), -25);
  EXPECT_GT(now + of(unknown, LaneMotion::Driven)[11].norm(), 0) << "a signal nobody knows";
  // the other motions know of no light
  EXPECT_EQ(of(at_red, LaneMotion::Steady), of(unknown, LaneMotion::Steady));
}

TEST_F(LaneGuideTest, FollowsWhoIsAhead) {
  add({1.6, -100}, {0, 10}, radians(90));
  const auto free = paths(looked(map()), 0);
  add({1.6, -45}, {0, 0}, radians(90));
  const LaneGuide guide = looked(map());
  for (const LaneWay& way : guide.ways(0)) {
    ASSERT_TRUE(way.leader.has_value());
    EXPECT_EQ(*way.leader, 1u);
    EXPECT_NEAR(way.gap, 100 - 45 - 7 * 0.4 * 10 - 3.8 - 1.0, 0.1);
  }
  EXPECT_LT(of(paths(guide, 0), LaneMotion::Driven)[11].y(),
            of(free, LaneMotion::Driven)[11].y() - 5);
}

TEST_F(LaneGuideTest, LeavesAloneWhoIsOnNoLane) {
  add({40, 40}, {0, 8}, radians(90));      // in the grass
  add({1.6, -60}, {0, -8}, radians(-90));  // against its lane
  Track walker = set_.tracks[0];
  walker.id = 9;
  walker.type = find_agent_type(types_, "pedestrian");
  for (Vec2& point : walker.position) point += Vec2(-38.4, -100);
  set_.tracks.push_back(walker);
  const LaneGuide guide = looked(map());
  for (std::size_t row = 0; row < 3; ++row) EXPECT_FALSE(guide.guides(row)) << row;
  // they are predicted as without a map, to the last bit
  MethodSettings settings{default_predictor_parameters(), 0, 1};
  const PredictionMap known = map();
  std::vector<std::vector<Vec2>> predicted;
  for (const PredictionMap* one : {static_cast<const PredictionMap*>(nullptr), &known}) {
    settings.map = one;
    const Method method = make_method("gamma", settings, set_);
    for (int frame = 0; frame <= 7; ++frame) method.observe(observe(set_, frame));
    predicted.push_back(method.predict(observe(set_, 7), 12).position);
  }
  EXPECT_EQ(predicted[0], predicted[1]);
}

TEST_F(LaneGuideTest, FindsTheMapByItsOffset) {
  offset_ = {1000, -500};
  add({1.6, -60}, {0, 8}, radians(90));
  PredictionMap right = map(), wrong = map();
  wrong.offset = Vec2::Zero();
  EXPECT_TRUE(looked(right).guides(0));
  const MapFit fit = check_fit(right, set_);
  EXPECT_EQ(fit.wheeled, 1u);
  EXPECT_EQ(fit.on_map, 1u);
  try {
    check_fit(wrong, set_);
    FAIL() << "it fits nobody";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind("made.net.xml: ", 0), 0u) << text;
    EXPECT_NE(text.find("--map-offset"), std::string::npos) << text;
  }
}

TEST_F(LaneGuideTest, IsOfNoUseToPeopleOnFoot) {
  add({1.6, -60}, {0, 1}, radians(90));
  set_.tracks[0].type = find_agent_type(types_, "pedestrian");
  EXPECT_THROW(check_fit(map(), set_), Error);
}

/// Strict: with a map, too, nothing from outside the window moves a bit: neither where anybody was
/// or will be nor what a signal will show.
TEST_F(LaneGuideTest, KnowsNothingFromOutsideAStrictWindow) {
  for (const double lane : {1.6, 4.8}) add({-190, -lane}, {9, 0}, 0, 40);
  add({1.6, -190}, {0, 8}, radians(90), 40);
  const auto predicted = [&](const TrackSet& set) {
    MethodSettings settings{default_predictor_parameters(), 4, 1};
    const PredictionMap known = map();
    settings.map = &known;
    std::vector<Vec2> all;
    evaluate(make_method("gamma", settings, set), set, set, protocol_from_letter("C"),
             Memory::Strict, [&](const ScoredForecast& told) {
               if (told.frame == 20)
                 all.insert(all.end(), told.predicted.begin(), told.predicted.end());
             });
    return all;
  };
  show(0.4 * 20 + 0.2, 'r', 'r');
  const std::vector<Vec2> red = predicted(set_);
  ASSERT_EQ(red.size(), 3u * 5u * 12u);
  TrackSet other = set_;
  for (Track& track : other.tracks)
    for (int k = 0; k < 40; ++k)
      if (k < 13 || k > 20) track.position[static_cast<std::size_t>(k)] += (k % 3) * Vec2(7, -4);
  EXPECT_EQ(predicted(other), red);
  show(0.4 * 20 + 0.2, 'r', 'G');
  EXPECT_EQ(predicted(set_), red) << "nobody knows when it will be green";
  show(0.4 * 20 - 0.2, 'r', 'G');
  EXPECT_NE(predicted(set_), red) << "it is green now";
}

TEST_F(LaneGuideTest, MakesPredictionsBetterOnABend) {
  // everybody turns left from the south, at 6 m/s
  for (const ConnectionId id : network_.lane(network_.lane_by_name.at("SC_0")).outgoing) {
    const Connection& link = network_.connection(id);
    if (link.direction != TurnDirection::Left) continue;
    CandidateWays ways(network_);
    const AgentTypeId car = find_agent_type(types_, "car");
    for (const auto& path :
         ways.ways(type_of(types_, car), car, network_.lane_by_name.at("SC_0"))) {
      const Polyline& line = path->line;
      if (line.point_at(line.length()).x() > -50) continue;
      Track track{1, car, 0, {}, {}};
      for (int k = 0; k < 50; ++k) {
        track.position.push_back(line.point_at(150 + 2.4 * k));
        track.heading.push_back(heading_of(line.direction_at(150 + 2.4 * k)));
      }
      set_.tracks.push_back(track);
    }
  }
  ASSERT_FALSE(set_.tracks.empty());
  set_.last_frame = 49;
  const PredictionMap known = map();
  MethodSettings settings{default_predictor_parameters(), 0, 1};
  settings.map = &known;
  const auto error = [&](const char* name) {
    return summarize(evaluate(make_method(name, settings, set_), set_, set_,
                              protocol_from_letter("C"), Memory::Strict))
        .average;
  };
  EXPECT_LT(error("gamma"), 0.8 * error("gamma-no-map"));
}

}  // namespace
}  // namespace sumogamma
