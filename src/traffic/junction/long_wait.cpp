#include "traffic/junction/long_wait.h"

#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// Has one lost so much of its patience since it came to a halt before its link?
bool has_waited_since_it_came(const Encounter& e, const Party& one, Patience least) {
  return one.waits.halted_for == one.at.connection && halted(e, one.row()) >= least;
}

/// Has somebody on foot waited for so long at a crossing where vehicles go first that it steps out,
/// or begun to do so? Who sets out and steps back again waits from when it came.
bool has_had_enough(const Encounter& e, const Party& one) {
  if (!one.on_foot || one.at.front < -e.parameters.near_line ||
      e.road.signal(one.link) != Light::None)
    return false;
  const bool has_set_out = e.scene.speed[one.row()] > e.parameters.moving_speed;
  return waited(e, one.row()) >= (has_set_out ? Patience::Pressing : Patience::Stuck) ||
         has_waited_since_it_came(e, one, Patience::Desperate);
}

/// Has somebody on wheels stood at its line, or on the junction behind it, for long?
bool has_stood_for_long(const Encounter& e, const Party& one) {
  return !one.on_foot && has_waited_since_it_came(e, one, Patience::Desperate);
}

/// Has a cyclist stood at the line before its light since before the last green, and green has
/// begun again, or is it past the line by now? Who turns left out of a lane at the kerb crosses the
/// lanes beside, which have the same green.
bool has_missed_green(const Encounter& e, const Party& one) {
  if (one.link.signal == kNoSignal || !one.type.cyclist ||
      !has_waited_since_it_came(e, one, Patience::Hopeless))
    return false;
  const Light signal = e.road.signal(one.link);
  const double since = e.scene.time - signal_since(e.road, one.link, e.scene.time);
  return one.at.front > 0.0 || (!is_red(signal) && !is_amber(signal) && since < e.parameters.soon);
}

/// Is it in the interest of all that one goes, however long the other has waited?
bool goes_for_all(const Encounter& e, const Party& one) {
  return has_missed_green(e, one) || holds_up(e, one.row(), one.at.front);
}

}  // namespace

bool is_owed_its_way(const Encounter& e, const Party& one, const Party& other) {
  // who waits for anything else than its way doesn't come
  const LimitReason why = one.waits.reason;
  if (other.on_foot || one.at_red || (why != LimitReason::Yield && why != LimitReason::None) ||
      deceleration_to_stop(other.at.speed, other.to_area()) >= e.parameters.courtesy_braking)
    return false;
  if (goes_for_all(e, one)) return !goes_for_all(e, other);
  // who has waited for some time itself waits for nobody's long wait
  if (waited(e, other.row()) >= Patience::Pressing) return false;
  const bool no_light = one.link.signal == kNoSignal && other.link.signal == kNoSignal;
  return has_had_enough(e, one) ||
         (no_light && has_stood_for_long(e, one) && !has_stood_for_long(e, other));
}

bool starves(const Encounter& e, const Party& one, const Party& other) {
  return one.yields && one.at.front < e.parameters.line_tolerance && !other.on_foot &&
         other.waits.reason == LimitReason::Yield && stood(e, other.row()) >= Patience::Stuck;
}

}  // namespace sumogamma
