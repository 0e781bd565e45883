#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "prediction/recent_forecasts.h"
#include "prediction/spread_model.h"

namespace sumogamma {

/// Learns from past predictions of the same recording by how much spreads have to be scaled: the 90
/// % quantile of the errors met so far, in deviations, over that of the normal distribution that
/// was assumed. The assumption counts like `kPrior` predictions, so that the first few tell little.
/// What is still under way is not known here.
class SpreadCalibration {
 public:
  /// Scale of the spread for kind 0 or 1; 1 at the beginning.
  double scale(std::size_t kind) const { return scale_[kind]; }

  /// What was predicted for the steps 3, 6, 9 and 12 to come (points, [m]) of an agent, each period
  /// once.
  void remember(std::uint32_t agent, std::size_t kind, std::span<const Vec2> predicted,
                const Spread& spread);
  /// The agent was seen at `position`, one period later. Call before `remember` of that frame.
  void resolve(std::uint32_t agent, const Vec2& position);
  /// Takes the new errors into account; agents not remembered since the last call are forgotten.
  void end_frame();

 private:
  static constexpr std::size_t kBins = 64, kChecks = RecentForecasts<Vec2>::kChecks;
  static constexpr double kPrior = 300, kMost = 20000;

  struct Forecast {
    std::array<Vec2, kChecks> predicted;
    std::array<double, kChecks> along, across;  ///< [m]
    Vec2 forward;
  };
  using Bins = std::array<double, kBins>;

  static std::size_t bin_of(double deviations);
  static double quantile_scale(const Bins& errors, double total);

  RecentForecasts<Forecast> recent_;
  std::array<Bins, 2> errors_{};  ///< by kind: errors in deviations
  std::array<double, 2> total_{};
  std::array<double, 2> scale_{1, 1};
};

}  // namespace sumogamma
