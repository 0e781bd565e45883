#include "traffic/longitudinal/merging.h"

#include <algorithm>
#include <limits>

#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

double braking_asked(Merging entrant, double in_the_way, Merging oncomer) {
  constexpr double kOutlook = 10.0, kStep = 0.2;  // [s]
  constexpr double kFree = std::numeric_limits<double>::infinity();
  double hardest = 0.0;
  auto wish_of = [](const Merging& who) {
    return std::min(who.path.profile_at(who.front - 0.5 * who.length), who.preferred_speed);
  };
  auto roll = [](double acceleration, Merging& who) {
    const double before = who.speed;
    who.speed = std::max(0.0, before + acceleration * kStep);
    who.front += 0.5 * (before + who.speed) * kStep;
  };
  for (double time = 0.0; time < kOutlook; time += kStep) {
    const double gap =
        entrant.front - entrant.merged - entrant.length + oncomer.merged - oncomer.front;
    const bool there = entrant.front > in_the_way;
    if (there && gap <= 0.0) return kFree;
    const double wish = wish_of(oncomer);
    oncomer.speed = std::min(oncomer.speed, wish);  // it brakes before bends anyhow
    const double behind = following_acceleration(oncomer.type, oncomer.speed, wish,
                                                 there ? gap : kFree, entrant.speed);
    hardest = std::max(hardest, -behind);
    roll(following_acceleration(entrant.type, entrant.speed, wish_of(entrant), kFree, 0.0),
         entrant);
    roll(behind, oncomer);
  }
  return hardest;
}

}  // namespace sumogamma
