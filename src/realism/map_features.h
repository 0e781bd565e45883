#pragma once

#include <vector>

#include "realism/drivable_area.h"
#include "realism/motion_features.h"
#include "realism/road_loop.h"

namespace sumogamma {

/// What the map of a place tells of poses: the features that the Waymo Open Sim Agents Challenge
/// scores by a map (Montali et al. 2023, arXiv 2305.12032).
class MapFeatures {
 public:
  /// `road` outlives it.
  explicit MapFeatures(const RecordedRoad& road) : road_(road), area_(road.road.network) {}

  /// Fills road_edge and ran_red of the features of a window's poses: how far out of the drivable
  /// area the corner is that is farthest out, and who crosses a stop line of its route with its
  /// front while that shows red (programs whose time 0 is the recording's first step, `first`).
  void add(const ScoreWindow& window, int first, const Poses& poses,
           MotionFeatures& features) const;

 private:
  struct StopLine {
    Vec2 left = Vec2::Zero(), right = Vec2::Zero();
    ConnectionId link{};
  };
  std::vector<StopLine> stop_lines(const MatchedRoute& route) const;
  bool runs_red(const std::vector<StopLine>& lines, double time, const Vec2& before,
                const Vec2& now) const;

  const RecordedRoad& road_;
  DrivableArea area_;
};

}  // namespace sumogamma
