#include "traffic/junction/occupation.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

double time_to_drive(const TrafficParameters& parameters, const Path& path, double from, double to,
                     Pace pace) {
  double time = 0.0;
  for (double at = from; at < to; at += parameters.path_step) {
    const double way = std::min(parameters.path_step, to - at);
    const double reached = std::sqrt(pace.speed * pace.speed + 2.0 * pace.acceleration * way);
    const double next = std::max(std::min({path.profile_at(at + way), pace.most, reached}),
                                 parameters.moving_speed);
    time += 2.0 * way / (pace.speed + next);
    pace.speed = next;
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
    return time_to_drive(view.parameters, path, along, along + place - who.front,
                         {who.speed, top, type.max_acceleration});
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
