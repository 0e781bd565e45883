#include "model/merging.h"

#include <algorithm>
#include <limits>

#include "model/following.h"

namespace sumogamma {

double braking_asked(Entrant entrant, Oncomer oncomer) {
  constexpr double kOutlook = 10.0, kStep = 0.2;  // [s]
  constexpr double kFree = std::numeric_limits<double>::infinity();
  oncomer.free_speed = std::max(oncomer.free_speed, oncomer.speed);
  double hardest = 0.0;
  auto roll = [&](double acceleration, double& speed) {
    const double before = speed;
    speed = std::max(0.0, speed + acceleration * kStep);
    return 0.5 * (before + speed) * kStep;
  };
  for (double time = 0.0; time < kOutlook; time += kStep) {
    const double wish = std::min(entrant.path.profile_at(entrant.front - 0.5 * entrant.length),
                                 entrant.preferred_speed);
    const double gap = entrant.front - entrant.merged - entrant.length + oncomer.to_merged;
    const bool in_the_way = entrant.front > entrant.in_the_way;
    if (in_the_way && gap <= 0.0) return kFree;
    if (in_the_way && entrant.speed >= oncomer.free_speed) break;  // it only gets away
    const double behind = following_acceleration(oncomer.type, oncomer.speed, oncomer.free_speed,
                                                 in_the_way ? gap : kFree, entrant.speed);
    hardest = std::max(hardest, -behind);
    entrant.front +=
        roll(following_acceleration(entrant.type, entrant.speed, wish, kFree, 0.0), entrant.speed);
    oncomer.to_merged -= roll(behind, oncomer.speed);
  }
  return hardest;
}

}  // namespace sumogamma
