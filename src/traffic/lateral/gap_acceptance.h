#pragma once

#include <limits>

#include "traffic/perception.h"

namespace sumogamma {

/// The lane beside, in the coordinates of a path that may move over to it.
struct LaneBeside {
  double shift = 0;  ///< of its middle beside the lane that the path leaves [m, positive left]
  /// From where to where the path moves over [m along it]; infinite where it stays.
  double from = std::numeric_limits<double>::infinity();
  double to = std::numeric_limits<double>::infinity();

  const Polyline* middle = nullptr;  ///< where known: behind, the path may come from further aside

  /// Its middle beside the path there [m].
  double offset_at(double along) const;
};

/// Would moving over to `lane` now force nobody to brake harder than `braking` [m/s^2], oneself
/// included (the criterion of MOBIL, Kesting et al. 2007), and leave everybody the reaction time,
/// also who comes from behind between the lanes, faster?
/// Whoever lets the agent in keeps less, and need only leave room for its nose.
bool is_gap(const TrafficView& view, const Surroundings& around, std::size_t row,
            const LaneBeside& lane, double braking);

/// Is somebody about to change into the lane `target` beside an agent, from its other side, before
/// the agent? Not who lets it go first, or has halted amid that.
bool is_contested(const TrafficView& view, const Surroundings& around, std::size_t row,
                  LaneId target, const LaneBeside& lane);

/// Does somebody in the lane beside hold for an agent, its nose behind?
bool is_let_in(const TrafficView& view, const Surroundings& around, std::size_t row,
               const LaneBeside& lane);

/// Is somebody who goes the same way in the way beside an agent that changes lanes, its nose
/// ahead? Then that one goes first; who is behind lets the agent in. Who stands there and waits for
/// a gap, or for the agent, doesn't go.
bool is_beside(const TrafficView& view, const Surroundings& around, std::size_t row);

}  // namespace sumogamma
