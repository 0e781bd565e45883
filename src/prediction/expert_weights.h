#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>

#include "prediction/experts.h"

namespace sumogamma {

/// How experts are weighed by what they lost.
struct ExpertRate {
  double rate = 0.3;    ///< eta of the exponential weights
  double own = 3;       ///< weight of an agent's own rounds, against one of others of its kind
  double model = 1;     ///< prior weight of the mean of the intentions; simple experts have 1
  double walking = 1;   ///< likewise of the regression
  double lane = 1;      ///< likewise of each that follows lanes
  double others = 100;  ///< rounds of others that count at the most, each less where there are more
  double keep = 1;      ///< share of the past losses that counts after a frame
};

/// Losses of one round as a share of the largest, or of `floor` [m] where all are small: all in
/// [0, 1], as the bound on the regret asks for, and convex in what is predicted.
void normalize_losses(std::span<double> error, double floor);

/// Exponential weights prior * exp(-rate * loss), normalised. Sum of what their mixtures lose over
/// T rounds of losses in [0, 1]: at most the least sum of one expert + log(1 / its prior) / rate +
/// rate
/// * T / 8 (Cesa-Bianchi and Lugosi 2006, Theorem 2.2).
std::array<double, kExperts> exponential_weights(const std::array<double, kExperts>& prior,
                                                 const std::array<double, kExperts>& loss,
                                                 double rate);

/// Who learns from whom: agents of a kind.
inline constexpr std::size_t kWalkerKind = 0, kWheelsKind = 1;
/// On wheels, on a lane of a known map: who drives, and who stands and tells nothing of those.
inline constexpr std::size_t kLanesKind = 2, kStandingKind = 3;
inline constexpr std::size_t kExpertKinds = 4;

/// Keeps what the experts predicted of everybody, scores it when the frames come, and weighs them:
/// by the agent's own rounds and by those of all agents of its kind. Who isn't of the kind that an
/// expert is for gives it no weight: the regression is for people on foot, the experts of lanes for
/// who is on them. A round is a prediction of 1 to 4 steps from 3 frames or more.
class ExpertWeights {
 public:
  /// Weights for an agent now. Experts with a prior of 0 have none.
  std::array<double, kExperts> weights(std::uint32_t agent, std::size_t kind,
                                       const ExpertRate& rate) const;
  /// An agent is at `position`: what was predicted of it is scored. Once a frame, before
  /// `remember`.
  void resolve(std::uint32_t agent, const Vec2& position, const ExpertRate& rate);
  /// What is predicted of an agent at `position`. `seen`: frames seen of it.
  void remember(std::uint32_t agent, std::size_t kind, const Vec2& position, std::size_t seen,
                std::span<const ExpertPath, kExperts> paths);
  /// Closes a frame: agents that weren't remembered are forgotten.
  void end_frame(const ExpertRate& walker, const ExpertRate& wheels);
  /// As new.
  void clear() {
    history_.clear();
    rounds_ = {};
    loss_ = {};
  }

 private:
  static constexpr std::size_t kAhead = 4, kSeen = 3;
  static constexpr double kFloor = 0.05;  // [m]
  using Losses = std::array<double, kExperts>;

  struct Pending {
    std::array<std::array<Vec2, kAhead>, kExperts> place;
    bool counts = false;
  };
  struct History {
    std::array<Pending, kAhead> recent;  ///< a ring
    std::size_t count = 0, next = 0, kind = 0;
    Losses loss{};
    bool seen = false;
  };

  std::unordered_map<std::uint32_t, History>
      history_;  ///< looked up; iterated only to drop entries
  std::array<double, kExpertKinds> rounds_{};
  std::array<Losses, kExpertKinds> loss_{};  ///< by kind
};

}  // namespace sumogamma
