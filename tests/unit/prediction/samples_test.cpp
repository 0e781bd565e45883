#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "prediction/accuracy.h"
#include "prediction/gamma_predictor.h"
#include "prediction/spread_training.h"

namespace sumogamma {
namespace {

constexpr std::size_t kSteps = 12;

/// Nine who walk, sway and meet, and a car; `frames` frames. Deterministic.
TrackSet crowd(int frames) {
  const AgentTypeTable types = recorded_agent_types();
  TrackSet set;
  set.name = "made";
  set.last_frame = frames - 1;
  for (std::uint32_t id = 0; id < 10; ++id) {
    Track track;
    track.id = id;
    track.type = find_agent_type(types, id == 9 ? "car" : "pedestrian");
    track.first = id == 4 ? 2 : 0;
    const double way = id % 2 == 0 ? 1.0 : -1.0;
    for (int k = track.first; k < frames; ++k) {
      const double sway = random_normal(id, static_cast<std::uint64_t>(k), 0, Draw::ProcessNoise);
      track.position.push_back({way * (0.45 * k - 3.0) + 0.02 * sway,
                                0.7 * id + 0.03 * ((k + static_cast<int>(id)) % 3)});
    }
    point_track(types, {}, track);
    set.tracks.push_back(track);
  }
  return set;
}

GammaPredictor fresh() {
  return GammaPredictor(recorded_agent_types(), default_predictor_parameters(), {}, 0.4);
}

/// What nobody asks for in a window may be left out, and not a bit of what is asked for changes.
TEST(StrictWindow, HasTheBitsOfFrameByFrame) {
  const TrackSet set = crowd(8);
  GammaPredictor whole = fresh(), lean = fresh();
  // what a window left behind must not tell either
  for (int frame = 0; frame < 8; ++frame)
    lean.observe_in_window(observe(set, frame), static_cast<std::size_t>(7 - frame));
  lean.forget();
  for (int frame = 0; frame < 8; ++frame) {
    whole.observe(observe(set, frame));
    lean.observe_in_window(observe(set, frame), static_cast<std::size_t>(7 - frame));
  }
  EXPECT_EQ(whole.forecast(kSteps).position, lean.forecast(kSteps).position);
  for (const Draws draws : {Draws::Independent, Draws::Even})
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(whole.sample(k, 3, kSteps, {7, draws}).position,
                lean.sample(k, 3, kSteps, {7, draws}).position);
}

TEST(Samples, AreIndependentOfHowManyThereAre) {
  const TrackSet set = crowd(8);
  GammaPredictor predictor = fresh();
  for (int frame = 0; frame < 8; ++frame) predictor.observe(observe(set, frame));
  const auto at = [&](std::size_t index, std::size_t count, std::uint64_t seed, Draws draws) {
    return predictor.sample(index, count, kSteps, {seed, draws}).position;
  };
  EXPECT_EQ(at(2, 5, 1, Draws::Independent), at(2, 50, 1, Draws::Independent));
  EXPECT_NE(at(2, 5, 1, Draws::Independent), at(2, 5, 2, Draws::Independent));
  EXPECT_NE(at(2, 5, 1, Draws::Independent), at(3, 5, 1, Draws::Independent));
  EXPECT_NE(at(2, 5, 1, Draws::Even), at(2, 50, 1, Draws::Even));
  EXPECT_EQ(draws_from_name("even"), Draws::Even);
  EXPECT_EQ(draws_from_name(name_of(Draws::Independent)), Draws::Independent);
  EXPECT_THROW(draws_from_name("lucky"), Error);
}

/// Of one who walks alone, half lie within the ellipse that the spread gives for one half, and 90
/// of a hundred in that for 90, with either kind of draws.
TEST(Samples, SpreadAsTheTableSays) {
  TrackSet set = crowd(8);
  set.tracks.resize(1);
  GammaPredictor predictor = fresh();
  for (int frame = 0; frame < 8; ++frame) predictor.observe(observe(set, frame));
  const ObservedScene scene = observe(set, 7);
  const Forecast mean = predictor.forecast(kSteps);
  const SpreadClues clues = spread_clues(recorded_agent_types(), scene).front();
  const Spread spread = spread_for(clues, predictor.forward_of(0));
  constexpr std::size_t kCount = 1000;
  for (const Draws draws : {Draws::Independent, Draws::Even}) {
    double half = 0, most = 0;
    for (std::size_t k = 0; k < kCount; ++k) {
      const Vec2 off = predictor.sample(k, kCount, kSteps, {1, draws}).row(0)[11] - mean.row(0)[11];
      const double far = std::hypot(off.dot(spread.forward) / spread.along[11],
                                    cross(spread.forward, off) / spread.across[11]);
      half += far < spread.departure(11, 1.17741, {1, 0}).norm() / spread.along[11];
      most += far < 2.145966;
    }
    EXPECT_NEAR(half / kCount, 0.5, 0.06) << name_of(draws);
    EXPECT_NEAR(most / kCount, 0.9, 0.04) << name_of(draws);
  }
}

TEST(SharedDraws, MakeCompanionsDepartTogetherAndStayNormal) {
  // two abreast, one who comes towards them, one far away
  const std::vector<Vec2> position = {{0, 0}, {0, 0.7}, {2, 0}, {60, 0}};
  const std::vector<Vec2> velocity = {{1, 0}, {1, 0}, {-1, 0}, {1, 0}};
  const std::vector<SharedDraw> shared = shared_draws(position, velocity);
  constexpr std::uint64_t kTrials = 4000;
  std::array<double, 4> square{}, with_first{};
  std::vector<Vec2> mixed;
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<Vec2> own;
    for (std::uint64_t k = 0; k < 4; ++k)
      own.push_back({random_normal(trial, k, 0, Draw::ProcessNoise),
                     random_normal(trial, k, 1, Draw::ProcessNoise)});
    mix_deviates(shared, own, mixed);
    for (std::size_t k = 0; k < 4; ++k) {
      square[k] += mixed[k].squaredNorm() / (2.0 * kTrials);
      with_first[k] += mixed[k].dot(mixed[0]) / (2.0 * kTrials);
    }
  }
  for (const double s : square) EXPECT_NEAR(s, 1.0, 0.05);
  EXPECT_GT(with_first[1], 0.9);
  EXPECT_NEAR(with_first[2], 0.0, 0.05);
  EXPECT_NEAR(with_first[3], 0.0, 0.05);
}

/// A sample is one future of all: those who walk abreast and those who meet keep apart in it.
TEST(Samples, AreJointFutures) {
  const TrackSet set = crowd(8);
  GammaPredictor predictor = fresh();
  for (int frame = 0; frame < 8; ++frame) predictor.observe(observe(set, frame));
  const ObservedScene scene = observe(set, 7);
  std::vector<std::size_t> walkers = {0, 1, 2, 3, 4, 5, 6, 7, 8};
  CollisionCount joint;
  // the same places of everybody, each taken from another sample: futures that don't know of each
  // other
  CollisionCount apart;
  constexpr std::size_t kCount = 60;
  std::vector<Forecast> samples;
  for (std::size_t k = 0; k < kCount; ++k)
    samples.push_back(predictor.sample(k, kCount, kSteps, {1, Draws::Independent}));
  for (std::size_t k = 0; k < kCount; ++k) {
    joint.add(count_collisions(recorded_agent_types(), scene, samples[k], walkers, kSteps));
    Forecast mixed = samples[k];
    for (const std::size_t row : walkers)
      for (std::size_t step = 0; step < kSteps; ++step)
        mixed.position[row * kSteps + step] =
            samples[(k + 7 * row) % kCount].position[row * kSteps + step];
    apart.add(count_collisions(recorded_agent_types(), scene, mixed, walkers, kSteps));
  }
  EXPECT_LT(joint.rate(), 0.25 * apart.rate()) << joint.rate() << " " << apart.rate();
}

TEST(SpreadModel, IsWiderForWhoIsUnsteadyAndTurnsWithTheWorld) {
  const AgentTypeTable types = recorded_agent_types();
  const auto clues_of = [&](double sway, double angle) {
    Track track;
    track.type = find_agent_type(types, "pedestrian");
    for (int k = 0; k < 8; ++k) {
      const Vec2 straight(0.5 * k, sway * ((k * k) % 3));
      track.position.push_back(from_body(straight, direction_of(angle)));
    }
    point_track(types, {}, track);
    TrackSet set;
    set.last_frame = 7;
    set.tracks = {track};
    return spread_clues(types, observe(set, 7)).front();
  };
  const Spread steady = spread_for(clues_of(0.01, 0), {1, 0});
  const Spread unsteady = spread_for(clues_of(0.06, 0), {1, 0});
  const Spread turned = spread_for(clues_of(0.06, 1.1), direction_of(1.1));
  for (std::size_t k = 0; k < kSteps; ++k) {
    EXPECT_GT(unsteady.across[k], steady.across[k]) << k;
    EXPECT_NEAR(turned.along[k], unsteady.along[k], 1e-9);
    EXPECT_LT((turned.departure(k, 1.3, {0.6, 0.8}) -
               from_body(unsteady.departure(k, 1.3, {0.6, 0.8}), direction_of(1.1)))
                  .norm(),
              1e-9);
  }
  for (std::size_t k = 1; k < kSteps; ++k) EXPECT_GT(steady.along[k], steady.along[k - 1]);
}

TEST(SpreadTraining, WritesARowAWindow) {
  const TrackSet set = crowd(22);
  std::ostringstream rows;
  write_spread_rows(rows, set, set, default_predictor_parameters(), true);
  const std::string text = rows.str();
  const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  EXPECT_EQ(lines, 1 + windows_of(set, protocol_from_letter("C")).size());
  const std::string head = text.substr(0, text.find('\n'));
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  EXPECT_EQ(std::count(head.begin(), head.end(), ','), std::count(last.begin(), last.end(), ','));
  EXPECT_EQ(last.rfind("made,", 0), 0u);
}

}  // namespace
}  // namespace sumogamma
