#include "traffic/patience.h"

#include <algorithm>
#include <limits>

#include "base/random.h"

namespace sumogamma {

Patience patience_after(const TrafficParameters& parameters, double seconds) {
  if (seconds <= parameters.waiting) return Patience::Calm;
  if (seconds <= parameters.impatient) return Patience::Waiting;
  if (seconds <= parameters.pressing) return Patience::Impatient;
  if (seconds <= parameters.stuck) return Patience::Pressing;
  if (seconds <= parameters.desperate) return Patience::Stuck;
  return seconds <= parameters.hopeless ? Patience::Desperate : Patience::Hopeless;
}

Patience waited(const TrafficView& view, std::size_t row) {
  return patience_after(view.parameters, view.traffic.waiting_time[row]);
}

Patience stood(const TrafficView& view, std::size_t row) {
  return patience_after(view.parameters, view.scene.held[row].standing);
}

Patience blocked(const TrafficView& view, std::size_t row) {
  return patience_after(view.parameters, view.scene.held[row].blocked);
}

Patience kept_clear(const TrafficView& view, std::size_t row) {
  return patience_after(view.parameters, view.traffic.keeps_clear[row]);
}

Patience halted(const TrafficView& view, std::size_t row) {
  return patience_after(view.parameters, view.scene.time - view.approaches.waiting(row).halted_at);
}

bool has_come_to_a_halt(const TrafficView& view, std::size_t row) {
  return view.scene.held[row].standing >= view.parameters.reaction_time;
}

bool has_moved_within(const TrafficView& view, std::size_t row, double duration) {
  return view.scene.held[row].standing < duration;
}

bool is_out_of_patience(const TrafficView& view, std::size_t row) {
  const double least = view.parameters.pressing, most = view.parameters.stuck;
  const auto stretch = static_cast<std::uint64_t>(view.scene.time / most);
  return view.scene.held[row].blocked >
         random_uniform(0, view.scene.id[row].value, stretch, Draw::Intention, least, most);
}

double impatience_after(const TrafficParameters& parameters, double seconds) {
  return std::min(seconds / parameters.desperate, 1.0);
}

void count_waiting(const TrafficParameters& parameters, double dt, Kinematics kinematics,
                   const Scene& scene, TrafficState& traffic, std::size_t row) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  const double speed = scene.velocity[row].norm();
  const double creeping =
      std::min(parameters.crawling_speed, parameters.walker_creeping * scene.preferred_speed[row]);
  // who is pressed back along its way doesn't get on
  const RoadContext& context = scene.context[row];
  const double gets_on = context.active ? scene.velocity[row].dot(context.tangent) : speed;
  if (speed < parameters.standing_speed) traffic.stood_at[row] = scene.time;
  const double forgotten =
      kinematics == Kinematics::Holonomic ? parameters.walker_forgets * dt : kAll;
  double& waiting = traffic.waiting_time[row];
  waiting = gets_on < creeping ? waiting + dt : std::max(waiting - forgotten, 0.0);
}

}  // namespace sumogamma
