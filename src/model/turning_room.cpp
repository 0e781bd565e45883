#include "model/turning_room.h"

#include <algorithm>

#include "model/following.h"

namespace sumogamma {

namespace {

constexpr double kNear = 25.0;  ///< before its line from which a long body is reckoned with [m]

/// Somebody on a link, and its part of a swept way.
struct Passage {
  const AgentType& type;
  double front = 0, length = 0;  ///< front past the link's begin, length [m]
  double speed = 0, top_speed = 0;
  double begin = 0, end = 0;  ///< of the part [m]

  bool inside() const { return front > begin && front - length < end; }
  /// When the front gets there, and when the rear has left it [s from now].
  double enters() const {
    return time_to_cover(begin - front, speed, top_speed, type.max_acceleration);
  }
  double leaves() const {
    // who stands in it stays, as far as anyone can tell
    if (inside() && speed < 0.3) return std::numeric_limits<double>::infinity();
    return time_to_cover(end + length - front, speed, std::max(speed, 0.6 * top_speed),
                         type.max_acceleration);
  }
};

/// Would the two be in each other's way, and does the other one get there first?
bool comes_first(const Passage& other, const Passage& own, bool smaller_id) {
  constexpr double kMargin = 0.5;  // [s]
  // it waits before its line, or before the place that is swept
  const bool there = other.front > other.begin;
  if (!there && other.speed < 0.5) return false;
  const double theirs = other.enters(), ours = own.enters();
  if (ours > other.leaves() + kMargin || theirs > own.leaves() + kMargin) return false;
  return there || theirs < ours || (theirs == ours && smaller_id);
}

}  // namespace

double halt_for_long_bodies(const Model& model, const Scene& scene, const ApproachTable& approaches,
                            const Traveller& traveller, const PathLink& link) {
  double halt = link.halt;
  for (const SweptWay& way : model.swept_ways[index_of(link.connection)]) {
    const double place = link.stop_line + way.begin;
    if (!way.foe_is_long || way.begin >= 0.0 || traveller.front > place || place >= halt) continue;
    for (const Approach& foe : approaches.of(way.foe))
      if (foe.length > kLongBody && foe.front > -kNear && foe.front - foe.length < way.foe_end &&
          foe.row != traveller.row && !on_other_storey(scene, traveller.row, foe.row))
        halt = std::min(halt, place);
  }
  return halt;
}

LinkDecision leave_turning_room(const Model& model, const RoadState& road, const Scene& scene,
                                const ApproachTable& approaches, const Traveller& traveller,
                                const PathLink& link) {
  LinkDecision decision;
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const double front = traveller.front - link.stop_line;
  for (const SweptWay& way : model.swept_ways[index_of(link.connection)]) {
    // who is on its way goes on
    const bool concerned =
        way.foe_is_long ? front <= way.begin : traveller.length > kLongBody && front <= 0.2;
    if (!concerned) continue;
    const double line =
        (way.foe_is_long ? link.stop_line + way.begin : std::min(link.halt, link.stop_line)) -
        kStopMargin;
    const bool too_late =
        traveller.speed > 1.0 &&
        deceleration_to_stop(traveller.speed, line - traveller.front) > 0.8 * type.max_deceleration;
    if (too_late || (decision.must_stop && line >= decision.stop_at)) continue;
    const Passage own{type,      front,  traveller.length, traveller.speed, traveller.top_speed,
                      way.begin, way.end};
    for (const Approach& foe : approaches.of(way.foe)) {
      if (foe.row == traveller.row || (way.foe_is_long && foe.length <= kLongBody)) continue;
      if (foe.front - foe.length >= way.foe_end) continue;
      const AgentType& foe_type = type_of(model.types, scene.type[foe.row]);
      const Path& foe_path = *road.path(scene.path[foe.row]);
      const double foe_top =
          std::min(foe_path.profile_at(scene.path_along[foe.row]), foe_type.max_speed);
      const Passage other{foe_type, foe.front,     foe.length, foe.speed,
                          foe_top,  way.foe_begin, way.foe_end};
      if (!comes_first(other, own, scene.id[foe.row] < scene.id[traveller.row])) continue;
      decision = {true, line, LimitReason::TurningRoom,
                  static_cast<std::int64_t>(scene.id[foe.row].value)};
      break;
    }
  }
  return decision;
}

}  // namespace sumogamma
