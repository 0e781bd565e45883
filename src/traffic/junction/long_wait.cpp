#include "traffic/junction/long_wait.h"

#include "traffic/longitudinal/car_following.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

constexpr double kAsks = 2.0;  ///< of who halts for somebody with a long wait [m/s^2]

/// Is it longer ago than `least` [s] that a row came to a halt before its link?
bool has_waited_since_it_came(const TrafficView& view, std::size_t row, ConnectionId its,
                              double least) {
  const Waiting& waiting = view.approaches.waiting(row);
  return waiting.halted_for == its && view.scene.time - waiting.halted_at > least;
}

/// Has somebody on foot waited for so long at a crossing where vehicles go first that it steps out,
/// or begun to do so? Who sets out and steps back again waits from when it came, where there is no
/// light.
bool has_had_enough(const TrafficView& view, std::size_t row, ConnectionId its) {
  constexpr double kLong = 30.0, kSetOut = 10.0;  // of waiting, which walking counts down [s]
  constexpr double kSinceItCame = 45.0;           // [s]
  if (!is_on_foot(view, row)) return false;
  const double enough = view.scene.speed[row] > kCreeps ? kSetOut : kLong;
  return view.traffic.waiting_time[row] > enough ||
         (has_waited_since_it_came(view, row, its, kSinceItCame) &&
          view.road.signal(view.model.road.connection(its)) == Light::None);
}

/// Has somebody on wheels stood at its line, or on the junction behind it, for long?
bool has_stood_for_long(const TrafficView& view, std::size_t row, ConnectionId its) {
  constexpr double kLong = 45.0;  // [s]
  return !is_on_foot(view, row) && has_waited_since_it_came(view, row, its, kLong);
}

/// Has a cyclist stood at the line before its light since before the last green, and green has
/// begun again, or is it past the line by now? Who turns left out of a lane at the kerb crosses the
/// lanes beside, which have the same green.
bool has_missed_green(const TrafficView& view, std::size_t row, ConnectionId its, double front) {
  constexpr double kCycle = 75.0, kBegins = 3.0;  // [s]
  constexpr double kCyclist = 10.0;               // at the most [m/s]
  const Connection& link = view.model.road.connection(its);
  if (link.signal == kNoSignal || !has_waited_since_it_came(view, row, its, kCycle) ||
      is_on_foot(view, row) || type_of(view.model.types, view.scene.type[row]).max_speed > kCyclist)
    return false;
  const Light signal = view.road.signal(link);
  const double since = view.scene.time - signal_since(view.road, link, view.scene.time);
  return front > 0.0 || (!is_red(signal) && !is_amber(signal) && since < kBegins);
}

bool is_owed_its_way(const TrafficView& view, std::size_t row, ConnectionId its, double front) {
  return has_missed_green(view, row, its, front) || holds_up(view, row, front);
}
bool subject_is_owed(const Encounter& e) {
  return is_owed_its_way(e, e.subject.row, e.link.connection, -e.to_line());
}

/// Need the foe brake with no more than kAsks to halt before the area?
bool asks_little(const Encounter& e) {
  return deceleration_to_stop(e.foe.speed, e.zone.foe_begin - e.foe.front) < kAsks;
}

/// Can the subject, on wheels, halt without braking hard for a foe that waits for its way alone?
bool halts_at_ease(const Encounter& e) {
  const LimitReason why = e.foe_waits.reason;
  return !is_on_foot(e, e.subject.row) && (why == LimitReason::Yield || why == LimitReason::None) &&
         deceleration_to_stop(e.subject.speed, e.link.stop_line + e.zone.begin - e.subject.front) <
             kAsks;
}

/// Likewise, not if it has waited for some time itself.
bool halts_for_long_wait(const Encounter& e) {
  constexpr double kOwnWait = 10.0;  // [s]
  return e.traffic.waiting_time[e.subject.row] < kOwnWait && halts_at_ease(e);
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
  constexpr double kAtKerb = 2.0;  // [m]
  return has_had_enough(e, e.foe.row, e.zone.foe) && e.foe.front > -kAtKerb &&
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
  constexpr double kLong = 20.0;  // [s]
  return e.zone.yields && e.to_line() > -kZoneEdge && !is_on_foot(e, e.foe.row) &&
         e.foe_waits.reason == LimitReason::Yield && e.scene.held[e.foe.row].standing > kLong;
}

}  // namespace sumogamma
