#include "traffic/junction/signals.h"

#include <algorithm>

#include "traffic/junction/encounter.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// Does somebody who stood near its line for a gap before amber began, at `since` [s], take the one
/// that amber makes, as it gets over the line from rest in the time `left` [s]?
bool takes_gap(const TrafficView& view, const Traveller& traveller, const PathLink& link,
               double since, double left) {
  const AgentType& type = type_of(view.model.types, view.scene.type[traveller.row]);
  const double to_line = link.stop_line - traveller.front;
  return to_line < view.parameters.near_line &&
         view.traffic.halted_for[traveller.row] == link.connection &&
         view.traffic.halted_at[traveller.row] < since &&
         time_to_cover(to_line, 0.0, type.max_speed, type.max_acceleration) < left;
}

/// `needed`: to halt [m/s^2].
SignalDuty duty_at_amber(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                         double needed, double drawn) {
  const Connection& connection = view.model.road.connection(link.connection);
  const AgentType& type = type_of(view.model.types, view.scene.type[traveller.row]);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  const double to_line = link.stop_line - traveller.front;
  const double time = view.scene.time, since = signal_since(view.road, connection, time);
  // who might not be over the line before red brakes harder than at ease, who surely won't as
  // hard as its body can, and stands before it from a crawl, however near it is
  const double really_left = amber_until(view.road, connection) - time;
  const double left = std::min(view.parameters.amber_time - (time - since), really_left);
  const bool late = to_line > std::max(left, 0.0) * traveller.speed;
  const bool too_late = to_line > std::max(really_left, 0.0) * traveller.speed;
  const double most = too_late ? 0.95 * type.max_deceleration
                      : late   ? 0.65 * type.max_deceleration
                               : type.comfortable_deceleration;
  if (!on_foot && takes_gap(view, traveller, link, since, left)) return SignalDuty::None;
  // who gets over in time doesn't halt where others need the room
  if (!late && !on_foot && !stops_at_ease(traveller.speed, drawn - traveller.front, type))
    return SignalDuty::None;
  const bool stands = late && traveller.speed < view.parameters.crawling_speed;
  return needed < most || stands ? SignalDuty::Stop : SignalDuty::None;
}

SignalDuty duty_at_red(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                       double needed) {
  const AgentType& type = type_of(view.model.types, view.scene.type[traveller.row]);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  const double to_line = link.stop_line - traveller.front;
  const bool steps_back = on_foot && to_line > -view.parameters.footstep;
  const bool can_stop = to_line > -1.0 && (steps_back || needed < type.max_deceleration ||
                                           traveller.speed < view.parameters.crawling_speed);
  const bool has_halted = view.traffic.halted_for[traveller.row] == link.connection;
  if ((can_stop || has_halted || on_foot) && goes_at_red(view, traveller.row, link.connection))
    return SignalDuty::GoAtRed;
  return can_stop ? SignalDuty::Stop : SignalDuty::None;
}

}  // namespace

SignalDuty signal_duty(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                       double halt, double drawn) {
  const Connection& connection = view.model.road.connection(link.connection);
  const Light signal = view.road.signal(connection);
  // on foot one halts within a step, though it be with a foot on the crossing
  const double reserve = is_on_foot(view, traveller.row) ? -0.45 : 0.2;  // [m]
  const double needed = deceleration_to_stop(traveller.speed, halt - traveller.front - reserve);
  // nobody halts for amber amid a junction
  if (is_amber(signal) && connection.storage > 0.0) return SignalDuty::None;
  if (is_amber(signal) && link.stop_line - traveller.front > -1.0)
    return duty_at_amber(view, traveller, link, needed, drawn);
  return is_red(signal) ? duty_at_red(view, traveller, link, needed) : SignalDuty::None;
}

}  // namespace sumogamma
