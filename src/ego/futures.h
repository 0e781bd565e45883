#pragma once

#include <cstdint>
#include <vector>

#include "ego/way_beliefs.h"

namespace sumogamma {

/// What is asked about the future.
struct FuturesRequest {
  std::vector<double> plan;  ///< accelerations of the ego, one a period; the last one holds
                             ///< [m/s^2]. Empty: it keeps its speed
  int samples = 10;
  std::uint64_t key = 0;  ///< of the draws
  bool knows = false;     ///< everybody's own way instead of what is believed
};

/// Where everybody might be: joint samples, so that within one sample all reacted to each other.
struct Futures {
  double step = ForwardModel::kStep;  ///< between two states [s]
  std::size_t steps = 0;              ///< states a sample, the first after one step
  std::vector<std::uint32_t> agents;  ///< the ego first, then the others, by distance now
  struct Pose {
    Vec2 position = Vec2::Zero();
    double heading = 0, speed = 0;
  };
  std::vector<Pose> poses;  ///< [samples * steps * agents]
  std::vector<double> gap;  ///< of the ego to the nearest of them [samples * steps, m]
};

/// `samples` futures over 4 s of the ego and those seen (rows_seen), given the ego's plan along
/// its way. Everybody takes one of the ways of its belief in each sample, by turns as often as it
/// is believed; what is hidden in people (responsibility, attention, headway, whether they keep a
/// rule) is drawn anew, from `key` alone. Changes nothing in the world.
Futures sample_futures(const EgoView& view, const FuturesRequest& request,
                       const WayBeliefs& beliefs, ForwardModel& forward);

}  // namespace sumogamma
