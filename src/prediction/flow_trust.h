#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "geometry/vec2.h"
#include "prediction/recent_forecasts.h"

namespace sumogamma {

/// How far predecessors are to be believed here: the share of the flow's corrections that would
/// have been best so far, in squared distance, for each kind (0 on foot, 1 on wheels). Where
/// signals or a crowd send later ones another way it comes to nothing. Between 0 and 1; 1 counts
/// like `kPrior` corrections of a metre.
class FlowTrust {
 public:
  double share(std::size_t kind) const { return share_[kind]; }

  /// What was predicted without the flow for the steps 3, 6, 9 and 12 to come (points, [m]) of an
  /// agent and what the flow adds in full [m]. Once a frame.
  void remember(std::uint32_t agent, std::size_t kind, std::span<const Vec2> predicted,
                std::span<const Vec2> flow);
  /// The agent was seen at `position`, one period later. Call before `remember` of that frame.
  void resolve(std::uint32_t agent, const Vec2& position);
  /// Takes the new frame into account; agents not remembered since the last call are forgotten.
  void end_frame();
  /// As new.
  void clear();

 private:
  static constexpr double kPrior = 5;     // [m^2]
  static constexpr double kKeep = 0.998;  // of the past, a frame

  struct Forecast {
    std::array<Vec2, RecentForecasts<Vec2>::kChecks> predicted, flow;
  };

  RecentForecasts<Forecast> recent_;
  std::array<double, 2> explained_{}, square_{};  ///< by kind [m^2]
  std::array<double, 2> share_{1, 1};
};

}  // namespace sumogamma
