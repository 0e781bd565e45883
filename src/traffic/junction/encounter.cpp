#include "traffic/junction/encounter.h"

#include "traffic/longitudinal/car_following.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// Who stands at red, or comes to it, and goes over it all the same (see signals).
bool goes_over_red(const TrafficView& view, const Party& one, Light light) {
  const bool may_wait =
      one.at.front < 1.0 || one.on_foot || one.waits.halted_for == one.at.connection;
  return is_red(light) && may_wait && goes_at_red(view, one.row(), one.at.connection);
}

Party party_of(const TrafficView& view, const Approach& at, const PathLink& link, const Piece& area,
               bool yields) {
  Party one{
      at,
      link,
      view.model.road.connection(at.connection),
      type_of(view.model.types, view.scene.type[at.row]),
      view.approaches.waiting(at.row),
      as_travelled(*view.road.path(view.scene.path[at.row]), link.stop_line, area.begin, area.end),
      is_on_foot(view, at.row)};
  const Light light = view.road.signal(one.link);
  one.at_red = goes_over_red(view, one, light);
  // at red everybody else comes first
  one.yields = one.at_red || (yields && light != Light::GreenFirst);
  one.inside = has_entered(view.parameters, at.front, one.area.begin);
  one.clears = clears_junction(view, at.row, at.connection, at.front);
  const double rest = view.approaches.rest_of(at);
  one.rests = rest > one.area.begin + 0.3 && rest - at.length < one.area.end;
  return one;
}

/// Is `driver` one who doesn't let people go first at an unsignalled crossing, and is seen to, by
/// somebody who hasn't stepped onto it?
bool disregards(const Encounter& e, const Party& driver, const Party& walker) {
  return walker.on_foot && !driver.on_foot && !walker.inside && walker.at.front < 0.0 &&
         !driver.at.stands && e.model.road.lane(walker.link.to).kind == LaneKind::Crossing &&
         e.road.signal(walker.link) == Light::None &&
         !lets_people_go(e.model, e.scene, driver.row(), walker.at.connection);
}

}  // namespace

Encounter meet(const TrafficView& view, const Traveller& traveller, const PathLink& link,
               const ConflictZone& zone, const Approach& foe) {
  const Path& path = *view.road.path(view.scene.path[foe.row]);
  Encounter e{
      view, party_of(view, approach_of(traveller, link), link, {zone.begin, zone.end}, zone.yields),
      party_of(view, foe, path.links[foe.link], {zone.foe_begin, zone.foe_end}, zone.foe_yields)};
  e.unruled = zone.unruled && !e.a.at_red && !e.b.at_red;
  if (disregards(e, e.a, e.b) || disregards(e, e.b, e.a)) {
    e.a.yields = e.a.on_foot;
    e.b.yields = e.b.on_foot;
  }
  return e;
}

void foresee(Encounter& e) {
  for (Party* one : {&e.a, &e.b})
    one->stay = occupation(e, one->at, one->area.begin, one->area.end);
}

bool is_on_foot(const TrafficView& view, std::size_t row) {
  return type_of(view.model.types, view.scene.type[row]).kinematics == Kinematics::Holonomic;
}

bool stops_at_ease(double speed, double way, const AgentType& type) {
  return deceleration_to_stop(speed, way) < type.comfortable_deceleration;
}

bool has_entered(const TrafficParameters& parameters, double past, double begin) {
  return past > begin + parameters.line_tolerance;
}

bool has_waited_longer(const TrafficView& view, std::size_t row, std::size_t other) {
  const double own = view.traffic.waiting_time[row], their = view.traffic.waiting_time[other];
  return own > their || (own == their && view.scene.id[row] < view.scene.id[other]);
}

bool is_past_line(const Encounter& e, const Party& one) {
  // who goes at red waits before the junction, not on it; who rolls out beyond its place there
  // has come to rest at it all the same, as long as it isn't in the area
  const WaitingPlace place = waiting_place(e.parameters, one.on_path, one.area.begin);
  if (one.at_red || !place.inside) return one.at.front > e.parameters.line_tolerance;
  return one.at.front > place.along - one.on_path.stop_line + 2.0 * e.parameters.line_tolerance;
}

bool may_halt(const Party& one) { return stops_at_ease(one.at.speed, one.to_area(), one.type); }

bool is_on_junction(const Encounter& e, const Party& one) {
  const Path& path = *e.road.path(e.scene.path[one.row()]);
  const double front = one.on_path.stop_line + one.at.front;
  const auto first = path.link_from(front - one.at.length);
  return first != path.links.end() && first->stop_line + 0.3 < front;
}

bool has_halted(const Encounter& e, const Party& one) {
  return one.waits.halted_for != kNoConnection &&
         one.waits.halted_for == halt_counts_for(e.model.road,
                                                 *e.road.path(e.scene.path[one.row()]), one.on_path,
                                                 one.at.length);
}

bool has_set_out_from(const Encounter& e, const Party& one, double place) {
  return (one.waits.reason == LimitReason::None || one.waits.reason == LimitReason::Leader) &&
         one.on_path.stop_line + one.at.front > place + e.parameters.line_tolerance;
}

bool waits_for(const Encounter& e, const Party& one, const Party& other) {
  return one.at.stands && one.waits.foe == static_cast<std::int64_t>(e.scene.id[other.row()].value);
}

bool gets_past(const Encounter& e, const Party& one, const Party& standing) {
  if (one.on_foot) return true;
  const Traveller traveller{one.row(), one.on_path.stop_line + one.at.front, one.at.length,
                            one.at.speed};
  return stands_beside(e, traveller, one.on_path, one.area.begin, one.area.end, standing.at);
}

bool holds_up(const TrafficView& view, std::size_t row, double past_line) {
  return past_line > 0.0 && !is_on_foot(view, row) && view.approaches.waiting(row).holds_up;
}

bool clears_junction(const TrafficView& view, std::size_t row, ConnectionId id, double past_line) {
  const Connection& connection = view.model.road.connection(id);
  const double since = view.scene.time - signal_since(view.road, connection, view.scene.time);
  const bool past_lines = past_line > view.parameters.line_tolerance ||
                          (past_line > view.parameters.line_tolerance - connection.storage &&
                           since < view.parameters.clearance_time);
  return past_lines && is_red(view.road.signal(connection)) && !is_on_foot(view, row);
}

}  // namespace sumogamma
