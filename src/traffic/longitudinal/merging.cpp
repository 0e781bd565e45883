#include "traffic/longitudinal/merging.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

double braking_asked(const TrafficParameters& parameters, Merging entrant, double in_the_way,
                     Merging oncomer) {
  constexpr double kFree = std::numeric_limits<double>::infinity();
  const double step = 0.5 * parameters.reaction_time;
  const auto steps = static_cast<int>(std::ceil(parameters.merging_outlook / step));
  double hardest = 0.0;
  auto wish_of = [](const Merging& who) {
    return std::min(who.path.profile_at(who.front - 0.5 * who.length), who.preferred_speed);
  };
  auto roll = [step](double acceleration, Merging& who) {
    const double before = who.speed;
    who.speed = std::max(0.0, before + acceleration * step);
    who.front += 0.5 * (before + who.speed) * step;
  };
  for (int k = 0; k < steps; ++k) {
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
