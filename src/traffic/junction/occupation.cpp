#include "traffic/junction/occupation.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

double time_to_drive(const Path& path, double from, double to, double speed, double most,
                     double acceleration) {
  constexpr double kStep = 2.0, kLeast = 0.1;  // [m], [m/s]
  double time = 0.0;
  for (double at = from; at < to; at += kStep) {
    const double way = std::min(kStep, to - at);
    const double reached = std::sqrt(speed * speed + 2.0 * acceleration * way);
    const double next = std::max(std::min({path.profile_at(at + way), most, reached}), kLeast);
    time += 2.0 * way / (speed + next);
    speed = next;
  }
  return time;
}

Occupation occupation(const TrafficView& view, const Approach& who, double begin, double end) {
  if (who.front - who.length > end) return {Occupation::kNever, Occupation::kNever};
  // somebody who stands in it stays there as far as anyone can tell
  if (who.front > begin && who.speed < 0.3) return {0.0, Occupation::kNever};
  const Scene& scene = view.scene;
  const AgentType& type = type_of(view.model.types, scene.type[who.row]);
  const Path& path = *view.road.path(scene.path[who.row]);
  const double along = scene.path_along[who.row];
  const double most = std::max(std::min(type.max_speed, scene.preferred_speed[who.row]), who.speed);
  auto time_to = [&](double place, double top) {
    return time_to_drive(path, along, along + place - who.front, who.speed, top,
                         type.max_acceleration);
  };
  // it may be slow to clear it
  const double cautious = std::max(0.6 * std::min(path.profile_at(along), most), who.speed);
  return {time_to(begin, most), time_to(end + who.length, cautious)};
}

Approach approach_of(const Traveller& traveller, const PathLink& link) {
  return {link.connection,
          static_cast<std::uint32_t>(traveller.row),
          traveller.front - link.stop_line,
          traveller.length,
          traveller.speed,
          false};
}

}  // namespace sumogamma
