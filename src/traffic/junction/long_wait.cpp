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

}  // namespace

bool is_owed_its_way(const Encounter& e, const Party& one, const Party& other) {
  // who waits for anything else than its way doesn't come
  const LimitReason why = one.waits.reason;
  if (other.on_foot || one.at_red || (why != LimitReason::Yield && why != LimitReason::None) ||
      deceleration_to_stop(other.at.speed, other.to_area()) >= e.parameters.courtesy_braking)
    return false;
  const auto holds = [&](const Party& party) { return holds_up(e, party.row(), party.at.front); };
  if (holds(one)) return !holds(other);
  // who has waited for some time itself waits for nobody's long wait
  if (waited(e, other.row()) >= Patience::Pressing) return false;
  const bool no_light = one.link.signal == kNoSignal && other.link.signal == kNoSignal;
  return has_had_enough(e, one) ||
         (no_light && has_stood_for_long(e, one) && !has_stood_for_long(e, other));
}

}  // namespace sumogamma
