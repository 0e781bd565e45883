#include "traffic/junction/encounter.h"

#include <algorithm>

#include "traffic/junction/waiting_place.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// A driver who will not stop for the subject, who still waits at an unsignalled crossing and sees
/// it.
bool is_ignored_by(const Encounter& e) {
  return is_on_foot(e, e.subject.row) && e.subject.front < e.link.stop_line && !e.foe.stands &&
         e.road.signal(e.own_link) == Light::None &&
         !lets_people_go(e.model, e.scene, e.foe.row, e.link.connection);
}

/// Will the foe, as things are, come to rest in the area?
bool rests_in_area(const Encounter& e) {
  const double rest = e.approaches.rest_of(e.foe);
  return rest > e.zone.foe_begin + 0.3 && rest - e.foe.length < e.zone.foe_end;
}

}  // namespace

Encounter meet(const TrafficView& view, const Traveller& subject, const PathLink& link, bool at_red,
               const ConflictZone& zone, const Approach& foe) {
  Encounter e{view,
              subject,
              link,
              at_red,
              zone,
              foe,
              view.model.road.connection(link.connection),
              view.model.road.connection(zone.foe),
              type_of(view.model.types, view.scene.type[subject.row]),
              type_of(view.model.types, view.scene.type[foe.row]),
              view.approaches.waiting(foe.row)};
  const Path& path = *view.road.path(view.scene.path[subject.row]);
  const Piece ours = as_travelled(path, link.stop_line, zone.begin, zone.end);
  const Path& foe_path = *view.road.path(view.scene.path[foe.row]);
  const double foe_link_begin = view.scene.path_along[foe.row] + 0.5 * foe.length - foe.front;
  const Piece theirs = as_travelled(foe_path, foe_link_begin, zone.foe_begin, zone.foe_end);
  e.zone.begin = ours.begin;
  e.zone.end = ours.end;
  e.zone.foe_begin = theirs.begin;
  e.zone.foe_end = theirs.end;
  e.foe_inside = has_entered(view.parameters, foe.front, theirs.begin);
  e.foe_clears = clears_junction(view, foe.row, zone.foe, foe.front);
  if (is_ignored_by(e)) e.zone.yields = true;
  return e;
}

void foresee(Encounter& e) {
  e.theirs = occupation(e, e.foe, e.zone.foe_begin, e.zone.foe_end);
  // nobody on foot counts on a vehicle that stands to have passed by the time that it gets there
  if (rests_in_area(e) || (e.foe.stands && is_on_foot(e, e.subject.row)))
    e.theirs.end = Occupation::kNever;
  e.ours = occupation(e, approach_of(e.subject, e.link), e.zone.begin, e.zone.end);
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

bool waits_for_subject(const Encounter& e) {
  return e.foe.stands && e.foe_waits.foe == e.scene.id[e.subject.row].value;
}

bool has_set_out_from(const Encounter& e, double place) {
  const RoadContext& before = e.scene.context[e.subject.row];
  return before.active &&
         (before.reason == LimitReason::None || before.reason == LimitReason::Leader) &&
         e.subject.front > place + e.parameters.line_tolerance;
}

bool lets_subject_go(const Encounter& e) {
  const bool both_on_junction = e.foe.front > 0.0 && is_on_junction(e);
  if (!e.foe.stands || (both_on_junction && e.foe.speed > e.parameters.moving_speed)) return false;
  switch (e.foe_waits.reason) {
    case LimitReason::Signal:
    case LimitReason::Stop:
    case LimitReason::BlockedJunction:
    case LimitReason::GivesWay:
    case LimitReason::TurningRoom:
    case LimitReason::LetsIn:
    case LimitReason::Merge:
    case LimitReason::Leader:  // it stands in a queue, be it behind us
      return true;
    case LimitReason::Yield:
    case LimitReason::Crossing:
      break;
    default:
      return false;
  }
  const std::size_t row = e.subject.row;
  const bool for_subject = e.foe_waits.foe == e.scene.id[row].value;
  const bool on_foot = is_on_foot(e, row);
  if (for_subject && on_foot != is_on_foot(e, e.foe.row)) return on_foot;
  // it has waited long for a third one and isn't about to go
  const bool has_set_out = on_foot && has_set_out_from(e, e.link.halt);
  if (!for_subject && waited(e, e.foe.row) >= Patience::Impatient &&
      (waited(e, row) >= Patience::Waiting || has_set_out))
    return true;
  return has_waited_longer(e, row, e.foe.row);
}

bool is_past_line(const Encounter& e) {
  // who goes at red waits before the junction, not on it; who rolls out beyond its place there
  // has come to rest at it all the same, as long as it isn't in the zone
  const WaitingPlace place = waiting_place(e.parameters, e.link, e.zone.begin);
  if (e.at_red || !place.inside)
    return e.subject.front > e.link.stop_line + e.parameters.line_tolerance;
  return e.subject.front > place.along + 2.0 * e.parameters.line_tolerance;
}

bool foe_may_halt(const Encounter& e) {
  return stops_at_ease(e.foe.speed, e.zone.foe_begin - e.foe.front, e.foe_type);
}

bool is_on_junction(const Encounter& e) {
  const Path& path = *e.road.path(e.scene.path[e.subject.row]);
  const auto first = path.link_from(e.subject.front - e.subject.length);
  return first != path.links.end() && first->stop_line + 0.3 < e.subject.front;
}

double impatience(const Encounter& e) {
  return impatience_after(e.parameters, e.traffic.waiting_time[e.subject.row]);
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
