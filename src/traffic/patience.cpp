#include "traffic/patience.h"

#include <algorithm>
#include <limits>

namespace sumogamma {

void count_waiting(double dt, Kinematics kinematics, const Scene& scene, TrafficState& traffic,
                   std::size_t row) {
  constexpr double kStands = 0.3, kCreeps = 1.0;  // [m/s]
  constexpr double kCreepsShare = 0.3;            // of the preferred speed: people on foot
  constexpr double kForgets = 10.0;               // of the wait, in a second of getting on [s]
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const double speed = scene.velocity[row].norm();
  const double creeping = std::min(kCreeps, kCreepsShare * scene.preferred_speed[row]);
  // who is pressed back along its way doesn't get on
  const RoadContext& context = scene.context[row];
  const double gets_on = context.active ? scene.velocity[row].dot(context.tangent) : speed;
  if (speed < kStands) traffic.stood_at[row] = scene.time;
  const double forgotten = kinematics == Kinematics::Holonomic ? kForgets * dt : kAll;
  double& waiting = traffic.waiting_time[row];
  waiting = gets_on < creeping ? waiting + dt : std::max(waiting - forgotten, 0.0);
}

}  // namespace sumogamma
