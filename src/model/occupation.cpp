#include "model/occupation.h"

#include <algorithm>

#include "model/following.h"

namespace sumogamma {

Occupation occupation(const AgentType& type, const Approach& who, double begin, double end,
                      double top_speed) {
  if (who.front - who.length > end) return {Occupation::kNever, Occupation::kNever};
  const double a = type.max_acceleration;
  // somebody who stands in it stays there as far as anyone can tell
  if (who.front > begin && who.speed < 0.3) return {0.0, Occupation::kNever};
  return {time_to_cover(begin - who.front, who.speed, top_speed, a),
          time_to_cover(end + who.length - who.front, who.speed,
                        std::max(who.speed, 0.6 * top_speed), a)};
}

double top_speed(const Model& model, const RoadState& road, const Scene& scene, std::size_t row) {
  return std::min(road.path(scene.path[row])->profile_at(scene.path_along[row]),
                  type_of(model.types, scene.type[row]).max_speed);
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
