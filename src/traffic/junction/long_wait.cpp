#include "traffic/junction/long_wait.h"

#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// Has a row lost so much of its patience since it came to a halt before its link?
bool has_waited_since_it_came(const TrafficView& view, std::size_t row, ConnectionId its,
                              Patience least) {
  return view.approaches.waiting(row).halted_for == its && halted(view, row) >= least;
}

/// Has somebody on foot waited for so long at a crossing where vehicles go first that it steps out,
/// or begun to do so? Who sets out and steps back again waits from when it came, where there is no
/// light.
bool has_had_enough(const TrafficView& view, std::size_t row, ConnectionId its) {
  if (!is_on_foot(view, row)) return false;
  const bool has_set_out = view.scene.speed[row] > view.parameters.moving_speed;
  return waited(view, row) >= (has_set_out ? Patience::Pressing : Patience::Stuck) ||
         (has_waited_since_it_came(view, row, its, Patience::Desperate) &&
          view.road.signal(view.model.road.connection(its)) == Light::None);
}

/// Has somebody on wheels stood at its line, or on the junction behind it, for long?
bool has_stood_for_long(const TrafficView& view, std::size_t row, ConnectionId its) {
  return !is_on_foot(view, row) && has_waited_since_it_came(view, row, its, Patience::Desperate);
}

/// Has a cyclist stood at the line before its light since before the last green, and green has
/// begun again, or is it past the line by now? Who turns left out of a lane at the kerb crosses the
/// lanes beside, which have the same green.
bool has_missed_green(const TrafficView& view, std::size_t row, ConnectionId its, double front) {
  const Connection& link = view.model.road.connection(its);
  if (link.signal == kNoSignal || !has_waited_since_it_came(view, row, its, Patience::Hopeless) ||
      is_on_foot(view, row) || !type_of(view.model.types, view.scene.type[row]).cyclist)
    return false;
  const Light signal = view.road.signal(link);
  const double since = view.scene.time - signal_since(view.road, link, view.scene.time);
  return front > 0.0 || (!is_red(signal) && !is_amber(signal) && since < view.parameters.soon);
}

bool is_owed_its_way(const TrafficView& view, std::size_t row, ConnectionId its, double front) {
  return has_missed_green(view, row, its, front) || holds_up(view, row, front);
}
bool subject_is_owed(const Encounter& e) {
  return is_owed_its_way(e, e.subject.row, e.link.connection, -e.to_line());
}

/// Need the foe brake no harder than out of courtesy to halt before the area?
bool asks_little(const Encounter& e) {
  return deceleration_to_stop(e.foe.speed, e.zone.foe_begin - e.foe.front) <
         e.parameters.courtesy_braking;
}

/// Can the subject, on wheels, halt without braking hard for a foe that waits for its way alone?
bool halts_at_ease(const Encounter& e) {
  const LimitReason why = e.foe_waits.reason;
  return !is_on_foot(e, e.subject.row) && (why == LimitReason::Yield || why == LimitReason::None) &&
         deceleration_to_stop(e.subject.speed, e.link.stop_line + e.zone.begin - e.subject.front) <
             e.parameters.courtesy_braking;
}

/// Likewise, not if it has waited for some time itself.
bool halts_for_long_wait(const Encounter& e) {
  return waited(e, e.subject.row) < Patience::Pressing && halts_at_ease(e);
}

bool have_no_light(const Encounter& e) {
  return e.own_link.signal == kNoSignal && e.foe_link.signal == kNoSignal;
}

}  // namespace

bool steps_out(const Encounter& e) {
  return has_had_enough(e, e.subject.row, e.link.connection) && !is_on_foot(e, e.foe.row) &&
         !e.at_red && asks_little(e);
}

bool lets_step_out(const Encounter& e) {
  return has_had_enough(e, e.foe.row, e.zone.foe) && e.foe.front > -e.parameters.near_line &&
         e.road.signal(e.foe_link) == Light::None &&
         lets_people_go(e.model, e.scene, e.subject.row, e.zone.foe) && halts_for_long_wait(e);
}

bool noses_out(const Encounter& e) {
  return has_stood_for_long(e, e.subject.row, e.link.connection) && !is_on_foot(e, e.foe.row) &&
         have_no_light(e) && asks_little(e);
}

bool lets_nose_out(const Encounter& e) {
  return has_stood_for_long(e, e.foe.row, e.zone.foe) &&
         !has_stood_for_long(e, e.subject.row, e.link.connection) && have_no_light(e) &&
         halts_for_long_wait(e);
}

bool goes_first(const Encounter& e) {
  return subject_is_owed(e) && !is_on_foot(e, e.foe.row) && !e.at_red && asks_little(e);
}

bool lets_go_first(const Encounter& e) {
  return is_owed_its_way(e, e.foe.row, e.zone.foe, e.foe.front) && !subject_is_owed(e) &&
         halts_at_ease(e);
}

bool is_starved_by(const Encounter& e) {
  return e.zone.yields && e.to_line() > -e.parameters.line_tolerance && !is_on_foot(e, e.foe.row) &&
         e.foe_waits.reason == LimitReason::Yield && stood(e, e.foe.row) >= Patience::Stuck;
}

}  // namespace sumogamma
