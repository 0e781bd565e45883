#include "prediction/experts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "geometry/rotation.h"
#include "prediction/expert_weights.h"
#include "prediction/walking_model.h"

namespace sumogamma {
namespace {

std::vector<Vec2> track(std::initializer_list<double> along) {
  std::vector<Vec2> position;
  for (const double x : along) position.push_back({x, 0});
  return position;
}

TEST(Experts, GoOnAsTheyAreNamed) {
  ExpertPath path;
  const std::vector<Vec2> faster = track({0, 1, 2.2, 3.6});  // steps 1, 1.2, 1.4
  accelerating_path(faster, path);
  EXPECT_NEAR(path[0].x(), 1.6, 1e-12);
  EXPECT_NEAR(path[1].x(), 3.4, 1e-12);
  turning_path(faster, 2, 0, path);
  EXPECT_NEAR(path[1].x(), 3.4, 1e-12);
  EXPECT_NEAR(mean_displacement(faster, 3).x(), 1.2, 1e-12);
  EXPECT_EQ(mean_displacement(track({4}), 3), Vec2(0, 0));
  // on a circle it stays on the circle
  std::vector<Vec2> circle;
  for (int k = 0; k < 4; ++k) circle.push_back(10 * direction_of(0.1 * k));
  turning_path(circle, 2, 0, path);
  EXPECT_NEAR((circle.back() + path[11]).norm(), 10, 1e-9);
  // who brakes stops and doesn't turn back
  const std::vector<Vec2> slower = track({0, 1, 1.6, 1.8});
  for (const auto& go :
       {+[](std::span<const Vec2> p, std::span<Vec2> d) { accelerating_path(p, d); },
        +[](std::span<const Vec2> p, std::span<Vec2> d) { turning_path(p, 2, 0, d); }}) {
    go(slower, path);
    for (std::size_t k = 1; k < path.size(); ++k) EXPECT_GE(path[k].x(), path[k - 1].x());
  }
}

/// The law of the header: whatever the experts do, their mixture loses little more than the best.
TEST(ExponentialWeights, KeepTheBoundOnTheRegret) {
  constexpr int kRounds = 300;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    const double rate = 0.05 + 0.02 * static_cast<double>(seed);
    std::array<double, kExperts> prior{}, loss{};
    double total_prior = 0;
    for (std::size_t e = 0; e < kExperts; ++e) {
      prior[e] = random_uniform(seed, e, 7, Draw::ProcessNoise);
      total_prior += prior[e];
    }
    double mixture = 0;
    for (std::uint64_t round = 0; round < kRounds; ++round) {
      const auto weight = exponential_weights(prior, loss, rate);
      // experts err in the plane, each with a bias that changes in the middle
      std::array<Vec2, kExperts> place;
      std::array<double, kExperts + 1> error;
      Vec2 mixed = Vec2::Zero();
      for (std::size_t e = 0; e < kExperts; ++e) {
        const double bias = (round < kRounds / 2) == (e % 2 == 0) ? 2.0 : 0.1;
        place[e] = bias * Vec2(random_normal(seed, e, 2 * round, Draw::ProcessNoise),
                               random_normal(seed, e, 2 * round + 1, Draw::ProcessNoise));
        error[e] = place[e].norm();
        mixed += weight[e] * place[e];
      }
      error[kExperts] = mixed.norm();
      normalize_losses(error, 0.05);
      for (std::size_t e = 0; e < kExperts; ++e) {
        EXPECT_LE(error[e], 1.0);
        loss[e] += error[e];
      }
      mixture += error[kExperts];
    }
    for (std::size_t e = 0; e < kExperts; ++e)
      EXPECT_LE(mixture,
                loss[e] + std::log(total_prior / prior[e]) / rate + rate * kRounds / 8.0 + 1e-9);
  }
}

TEST(ExponentialWeights, LeaveOutWhoHasNoPrior) {
  std::array<double, kExperts> prior{}, loss{};
  prior[2] = prior[3] = 1;
  loss[2] = 1e6;
  loss[3] = 1e6 + 3;
  loss[0] = -1e9;
  const auto weight = exponential_weights(prior, loss, 1);
  EXPECT_EQ(weight[0], 0.0);
  EXPECT_NEAR(weight[2] + weight[3], 1.0, 1e-12);
  EXPECT_NEAR(weight[3] / weight[2], std::exp(-3.0), 1e-9);
}

TEST(ExpertWeights, FollowWhoWasRight) {
  ExpertWeights experts;
  const ExpertRate rate;
  for (int frame = 0; frame < 8; ++frame) {
    const Vec2 now(0.5 * frame, 0);
    experts.resolve(1, now, rate);
    std::array<ExpertPath, kExperts> paths;
    for (std::size_t e = 0; e < kExperts; ++e)
      straight_path(e == 4 ? Vec2(0.5, 0) : Vec2(0.3, 0.3), paths[e]);
    experts.remember(1, 1, now, static_cast<std::size_t>(frame + 1), paths);
    experts.end_frame(rate, rate);
  }
  EXPECT_GT(experts.weights(1, 1, rate)[4], 0.9);
  EXPECT_GT(experts.weights(2, 1, rate)[4], 0.5);         // others of its kind believe it, too
  EXPECT_NEAR(experts.weights(1, 0, rate)[4], 0.9, 0.2);  // as the other kind: its own rounds
  EXPECT_NEAR(experts.weights(3, 0, rate)[4], 1.0 / 9, 0.2);
}

ObservedScene seen(const std::vector<std::vector<Vec2>>& tracks,
                   const std::vector<std::vector<double>>& headings) {
  ObservedScene scene;
  for (std::size_t k = 0; k < tracks.size(); ++k)
    scene.agents.push_back({static_cast<std::uint32_t>(k), {}, tracks[k], headings[k]});
  return scene;
}

TEST(WalkingModel, TurnsAndMirrorsWithTheWorld) {
  std::vector<std::vector<Vec2>> tracks(6), turned(6), mirrored(6);
  const std::vector<std::vector<double>> headings(6, std::vector<double>(8, 0.0));
  const Vec2 turn = rotation(1.1);
  for (std::size_t a = 0; a < tracks.size(); ++a)
    for (int k = 0; k < 8; ++k) {
      const Vec2 noise(
          random_normal(5, a, static_cast<std::uint64_t>(2 * k), Draw::ProcessNoise),
          random_normal(5, a, static_cast<std::uint64_t>(2 * k + 1), Draw::ProcessNoise));
      tracks[a].push_back(Vec2(0.5 * k, 1.0 * static_cast<double>(a)) + 0.05 * noise);
      turned[a].push_back(from_body(tracks[a].back(), turn));
      mirrored[a].push_back({tracks[a].back().x(), -tracks[a].back().y()});
    }
  const AgentTypeTable types = recorded_agent_types();
  std::vector<WalkingFeatures> f, g, h;
  walking_features(types, seen(tracks, headings), f);
  walking_features(types, seen(turned, headings), g);
  walking_features(types, seen(mirrored, headings), h);
  ExpertPath a, b, c;
  for (std::size_t row = 0; row < f.size(); ++row) {
    walking_path(f[row], a);
    walking_path(g[row], b);
    walking_path(h[row], c);
    EXPECT_LT((from_body(a[11], turn) - b[11]).norm(), 1e-9);
    EXPECT_LT((Vec2(a[11].x(), -a[11].y()) - c[11]).norm(), 1e-9);
  }
}

TEST(WalkingModel, LetsSomebodyAloneGoStraightOn) {
  std::vector<Vec2> position;
  for (int k = 0; k < 8; ++k) position.push_back({0.5 * k, 0.1 * k});
  std::vector<WalkingFeatures> features;
  walking_features(recorded_agent_types(), seen({position}, {std::vector<double>(8, 0.0)}),
                   features);
  ExpertPath path;
  walking_path(features[0], path);
  EXPECT_NEAR(path[11].x(), 6.0, 0.6);
  EXPECT_NEAR(path[11].y() / path[11].x(), 0.2, 1e-9);
}

}  // namespace
}  // namespace sumogamma
