#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/random.h"
#include "prediction/baselines.h"
#include "prediction/distribution.h"
#include "prediction/evaluation.h"
#include "prediction/flow_memory.h"
#include "prediction/gamma_predictor.h"
#include "prediction/live_predictor.h"
#include "prediction/methods.h"

namespace sumogamma {
namespace {

std::filesystem::path write(const std::string& name, const std::string& text) {
  const auto path = std::filesystem::temp_directory_path() / ("sumogamma_" + name);
  std::ofstream(path) << text;
  return path;
}

Track straight_track(std::uint32_t id, const Vec2& from, const Vec2& velocity, int frames) {
  Track track{id, {}, 0, {}, {}};
  for (int k = 0; k < frames; ++k) {
    track.position.push_back(from + 0.4 * k * velocity);
    track.heading.push_back(heading_of(velocity));
  }
  return track;
}

TrackSet set_of(std::vector<Track> tracks) {
  TrackSet set;
  set.name = "made";
  for (const Track& track : tracks) set.last_frame = std::max(set.last_frame, track.last());
  set.tracks = std::move(tracks);
  return set;
}

std::filesystem::path recording(const std::string& name) {
  return std::filesystem::path(SUMOGAMMA_SHARED_DIR) / "data" / "trajectories" / (name + ".csv");
}

TEST(TrackSet, ReadsTheCommonTextFormatAndSplitsAtGaps) {
  const TrackSet set =
      read_track_set(write("gaps.txt", "0 1 0 0\n10 1 1 0\n50 1 5 0\n0\t2\t5\t5\n10\t2\t5\t6\n"));
  ASSERT_EQ(set.tracks.size(), 3u);
  EXPECT_EQ(set.tracks[0].position.size(), 2u);
  EXPECT_EQ(set.tracks[2].first, 5);  // the later part of agent 1, under an id of its own
  EXPECT_NEAR(set.tracks[1].heading[1], std::acos(0.0), 1e-12);
}

TEST(TrackSet, KnowsNoHeadingOfSomebodyWhoHasNotMoved) {
  const TrackSet set = read_track_set(
      write("standing.csv",
            "frame,agent_id,agent_type,x_m,y_m,heading_x,heading_y\n0,1,pedestrian,0,0,0,1\n"
            "1,1,pedestrian,0,0,0,1\n2,1,pedestrian,0,1,0,1\n0,2,car,9,0,0,1\n1,2,car,9,0,0,1\n"));
  EXPECT_EQ(set.tracks[0].heading[1], 0.0);
  EXPECT_NEAR(set.tracks[0].heading[2], std::acos(0.0), 1e-12);
  EXPECT_NEAR(set.tracks[1].heading[0], std::acos(0.0), 1e-12);  // a standing box points somewhere
}

TEST(TrackSet, NamesFileAndLineOfWhatIsWrong) {
  for (const char* text :
       {"0 1 0 x\n", "0 1 0\n", "0.5 1 0 0\n", "frame,agent_id,x_m\n0,1,0\n",
        "frame,agent_id,agent_type,x_m,y_m\n0,1,dragon,0,0\n", "0 1 nan 0\n", ""}) {
    const auto path = write("wrong.txt", text);
    try {
      read_track_set(path);
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
  }
  EXPECT_THROW(read_track_set("nowhere.csv"), Error);
}

TEST(Protocol, CutsTheWindowsOfTheFacts) {
  const TrackSet set = set_of({straight_track(1, {0, 0}, {1, 0}, 25)});
  EXPECT_EQ(windows_of(set, protocol_from_letter("C")).size(), 6u);  // 7..12
  EXPECT_EQ(windows_of(set, protocol_from_letter("A")).size(), 9u);  // 4..12
  EXPECT_THROW(protocol_from_letter("D"), Error);
}

TEST(Accuracy, CountsThePresentUnderProtocolAOnly) {
  const Track truth = straight_track(1, {0, 0}, {1, 0}, 25);
  std::vector<Vec2> predicted;
  for (int k = 1; k <= 12; ++k)
    predicted.push_back(truth.position[static_cast<std::size_t>(8 + k)] + Vec2(0, 0.1 * k));
  const WindowError c = window_error(truth, 8, predicted, protocol_from_letter("C"));
  EXPECT_NEAR(c.final, 1.2, 1e-12);
  EXPECT_NEAR(c.average, 0.65, 1e-12);
  const WindowError a = window_error(truth, 8, predicted, protocol_from_letter("A"));
  EXPECT_NEAR(a.final, 1.1, 1e-12);
  EXPECT_NEAR(a.average, 0.55, 1e-12);
}

/// Constant velocity on the recordings, as the facts have it to four digits: the harness is right.
TEST(Evaluation, ReproducesConstantVelocityOnTheRecordings) {
  struct Row {
    const char *set, *protocol;
    std::size_t windows;
    double average, final;
  };
  const Row rows[] = {{"eth", "A", 3473, 0.5729, 1.2095},   {"eth", "C", 2613, 0.6781, 1.3441},
                      {"hotel", "B", 1690, 0.3647, 0.7113}, {"hotel", "C", 1197, 0.3194, 0.6142},
                      {"zara1", "A", 2755, 0.3580, 0.8584}, {"zara1", "C", 2328, 0.4299, 0.9580},
                      {"cross", "A", 972, 0.6975, 1.8876},  {"cross", "C", 735, 0.7003, 1.8138}};
  for (const Row& row : rows) {
    if (!std::filesystem::exists(recording(row.set)))
      GTEST_SKIP() << "no recordings beside the project";
    SCOPED_TRACE(std::string(row.set) + " " + row.protocol);
    const TrackSet set = read_track_set(recording(row.set));
    const Method method{"cv", "", {}, constant_velocity, {}, {}};
    const Evaluation evaluation =
        evaluate(method, set, set, protocol_from_letter(row.protocol), Memory::Online);
    const Summary summary = summarize(evaluation);
    EXPECT_EQ(summary.windows, row.windows);
    EXPECT_NEAR(summary.average, row.average, 5.1e-5);
    EXPECT_NEAR(summary.final, row.final, 5.1e-5);
  }
}

TEST(GammaPredictor, BeatsConstantVelocityOnARecording) {
  if (!std::filesystem::exists(recording("hotel")))
    GTEST_SKIP() << "no recordings beside the project";
  const TrackSet set = read_track_set(recording("hotel"));
  const MethodSettings settings{default_predictor_parameters(), 0, 1};
  const Summary gamma = summarize(evaluate(make_method("gamma", settings, set), set, set,
                                           protocol_from_letter("C"), Memory::Online));
  EXPECT_LT(gamma.average, 0.275);
  EXPECT_LT(gamma.final, 0.52);
}

/// Each window by itself, no baseline that needs no model is better.
TEST(GammaPredictor, IsNeverWorseThanSimpleInStrictWindows) {
  for (const char* name : {"hotel", "zara1", "cross"}) {
    if (!std::filesystem::exists(recording(name)))
      GTEST_SKIP() << "no recordings beside the project";
    SCOPED_TRACE(name);
    const TrackSet set = read_track_set(recording(name));
    const MethodSettings settings{default_predictor_parameters(), 0, 1};
    const auto score = [&](const char* method) {
      return summarize(evaluate(make_method(method, settings, set), set, set,
                                protocol_from_letter("C"), Memory::Strict));
    };
    const Summary gamma = score("gamma");
    for (const char* simple : {"cv", "mean", "kalman", "ca", "ctra"}) {
      const Summary other = score(simple);
      EXPECT_LT(gamma.average, 0.96 * other.average) << simple;
      EXPECT_LT(gamma.final, 0.96 * other.final) << simple;
    }
  }
}

TEST(TrainingRecordings, AreKnownByContentWhateverTheyAreCalled) {
  if (!std::filesystem::exists(recording("zara1")))
    GTEST_SKIP() << "no recordings beside the project";
  TrackSet set = read_track_set(recording("zara1"));
  set.name = "other";
  EXPECT_TRUE(trained_on(content_of(set)));
  set.tracks[3].position[2].x() += 0.05;
  EXPECT_FALSE(trained_on(content_of(set)));
}

/// What comes later must not change what was predicted before.
TEST(GammaPredictor, NeverLooksAhead) {
  std::vector<Track> tracks;
  for (std::uint32_t id = 0; id < 6; ++id)
    tracks.push_back(straight_track(id, {0.3 * id, 2.0 * id}, {1.0 + 0.1 * id, 0.05 * id}, 40));
  const TrackSet one = set_of(tracks);
  for (Track& track : tracks)
    for (std::size_t k = 21; k < track.position.size(); ++k) track.position[k] += Vec2(7, -9);
  const TrackSet other = set_of(tracks);
  GammaPredictor a(recorded_agent_types(), default_predictor_parameters(), {}, 0.4);
  GammaPredictor b(recorded_agent_types(), default_predictor_parameters(), {}, 0.4);
  for (int frame = 0; frame <= 20; ++frame) {
    a.observe(observe(one, frame));
    b.observe(observe(other, frame));
  }
  const Forecast x = a.forecast(12), y = b.forecast(12);
  for (std::size_t k = 0; k < x.position.size(); ++k) EXPECT_EQ(x.position[k], y.position[k]);
}

TEST(GammaPredictor, KeepsTwoWhoMeetApart) {
  // head-on, 6 m apart, 0.1 m off each other's line
  const TrackSet set = set_of(
      {straight_track(1, {-6.5, 0}, {1.2, 0}, 8), straight_track(2, {6.5, 0.1}, {-1.2, 0}, 8)});
  GammaPredictor predictor(recorded_agent_types(), default_predictor_parameters(), {}, 0.4);
  for (int frame = 0; frame < 8; ++frame) predictor.observe(observe(set, frame));
  const Forecast forecast = predictor.forecast(12);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_GT((forecast.row(0)[k] - forecast.row(1)[k]).norm(), 0.3) << "step " << k;
}

TEST(FlowMemory, LearnsWherePredecessorsTurned) {
  FlowMemory memory;
  std::vector<Vec2> straight;
  for (int k = 1; k <= 12; ++k) straight.push_back({0.4 * k, 0});
  for (std::uint32_t agent = 0; agent < 20; ++agent) {
    for (int k = 0; k <= 6; ++k) {
      const Vec2 position(0.4 * k, 0.2 * k);  // drifts left
      memory.resolve(agent, position);
      memory.remember(agent, position, {1, 0}, straight);
      memory.end_frame();
    }
  }
  const auto correction = memory.correction(99, {0.1, 0}, {1, 0}, {1.0, 0.3, 1});
  EXPECT_NEAR(correction[5].y(), 1.2 * 20.0 / 21.0, 0.01);
  EXPECT_EQ(correction[6], Vec2(0, 0));  // nobody was seen that far
  EXPECT_EQ(memory.correction(99, {0, 0}, {-1, 0}, {1.0, 0.3, 1})[5], Vec2(0, 0));  // other way
  EXPECT_EQ(memory.correction(99, {50, 0}, {1, 0}, {1.0, 0.3, 1})[5], Vec2(0, 0));  // elsewhere
}

/// Truth and samples from one normal cloud: 50 and 90 % regions hold their share, however few
/// samples there are.
TEST(Distribution, CoversAsOftenAsItSays) {
  constexpr int kTrials = 2000;
  for (const std::size_t count : {5u, 20u}) {
    std::vector<Vec2> samples(count);
    double inside_50 = 0, inside_90 = 0;
    for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
      auto draw = [&](std::uint64_t k) {
        return Vec2(random_normal(trial, k, 0, Draw::ProcessNoise),
                    2 * random_normal(trial, k, 1, Draw::ProcessNoise));
      };
      for (std::uint64_t k = 0; k < samples.size(); ++k) samples[k] = draw(k);
      const PointScore score = score_point(samples, draw(1000));
      inside_50 += score.inside_50 / kTrials;
      inside_90 += score.inside_90 / kTrials;
    }
    EXPECT_NEAR(inside_50, 0.5, 0.03) << count;
    EXPECT_NEAR(inside_90, 0.9, 0.02) << count;
  }
}

TEST(Distribution, PrefersTheSharperCloudAtTheTruth) {
  std::vector<Vec2> sharp, wide;
  for (std::uint64_t k = 0; k < 30; ++k) {
    const Vec2 draw(random_normal(7, k, 0, Draw::ProcessNoise),
                    random_normal(7, k, 1, Draw::ProcessNoise));
    sharp.push_back(0.2 * draw);
    wide.push_back(2.0 * draw);
  }
  EXPECT_LT(score_point(sharp, {0, 0}).log_loss, score_point(wide, {0, 0}).log_loss);
  EXPECT_LT(score_point(sharp, {0, 0}).energy, score_point(wide, {0, 0}).energy);
  EXPECT_GT(score_point(sharp, {4, 0}).log_loss, score_point(wide, {4, 0}).log_loss);
}

TEST(Bootstrap, HoldsTheMeanAndIsRepeatable) {
  std::vector<double> value;
  std::vector<std::size_t> agent;
  for (std::size_t k = 0; k < 300; ++k) {
    agent.push_back(k / 10);
    value.push_back(static_cast<double>((k / 10) % 3));
  }
  const Interval one = bootstrap_mean(value, agent, 1), again = bootstrap_mean(value, agent, 1);
  EXPECT_NEAR(one.mean, 1.0, 1e-12);
  EXPECT_LT(one.low, 1.0);
  EXPECT_GT(one.high, 1.0);
  EXPECT_EQ(one.low, again.low);
  EXPECT_EQ(bootstrap_mean({}, {}, 1).mean, 0.0);
}

TEST(Baselines, AgreeOnSomebodyWhoWalksStraightAlone) {
  const TrackSet set = set_of({straight_track(1, {0, 0}, {1.3, 0.2}, 8)});
  for (const Baseline& baseline : baselines()) {
    SCOPED_TRACE(std::string(baseline.name));
    const Forecast forecast = baseline.predict(observe(set, 7), 12);
    const Vec2 expected = set.tracks[0].position[7] + 4.8 * Vec2(1.3, 0.2);
    EXPECT_LT((forecast.row(0)[11] - expected).norm(), 0.1);
  }
  EXPECT_THROW(find_baseline("crystal-ball"), Error);
}

TEST(LivePredictor, ScoresWhatThenHappened) {
  const AgentTypeTable types = default_agent_types();
  LivePredictor live(types, default_predictor_parameters());
  Scene scene;
  const AgentTypeId car = find_agent_type(types, "car");
  AgentState state;
  state.id = {4};
  state.type = car;
  state.footprint = box_footprint(5, 1.8);
  state.speed = 8;
  state.preferred_speed = 8;
  append_agent(scene, state);
  for (int tick = 0; tick < 400; ++tick) {
    scene.time = 0.05 * tick;
    scene.position[0] = {8 * scene.time, 0};
    live.observe(scene);
  }
  const LiveScore score = live.score();
  // frames every 0.4 s over 20 s: 50, the first predicted is the eighth, the last scored ends in
  // time
  EXPECT_EQ(score.predictions, 50 - 7 - 12);
  EXPECT_LT(score.average, 0.2);
  EXPECT_LT(score.constant_velocity_average, 1e-9);
  EXPECT_EQ(live.score_of(car).predictions, score.predictions);
  // it vanishes: predictions under way are counted, not scored
  remove_agents(scene, {true});
  scene.time += 0.4;
  live.observe(scene);
  EXPECT_EQ(live.score().left, 12);
}

TEST(Parameters, AreSetByName) {
  PredictorParameters parameters = default_predictor_parameters();
  set_parameter(parameters, "walker.flow_prior=7.5");
  EXPECT_EQ(parameters.walker.flow.prior, 7.5);
  EXPECT_THROW(set_parameter(parameters, "walker.flow_prior"), Error);
  EXPECT_THROW(set_parameter(parameters, "walker.luck=1"), Error);
  EXPECT_THROW(set_parameter(parameters, "rejoin=nan"), Error);
}

}  // namespace
}  // namespace sumogamma
