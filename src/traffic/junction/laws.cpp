#include "traffic/junction/laws.h"

#include <algorithm>

#include "model/stopping_guard.h"
#include "scene/extent.h"
#include "traffic/junction/long_wait.h"
#include "traffic/junction/signals.h"
#include "traffic/junction/waiting_place.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/merging.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

using Answer = std::optional<Verdict>;

Answer blocks_if(bool blocks) { return blocks ? Verdict::Blocks : Verdict::Free; }
Answer free_if(bool is_free) { return is_free ? Answer(Verdict::Free) : std::nullopt; }
Answer held_if(bool is_held) { return is_held ? Answer(Verdict::Held) : std::nullopt; }

// laws that need no look into the future

/// Who waits at red doesn't come, but somebody who goes at red, too, is waited for by another, and
/// who clears the junction by all.
Answer red_light(const Encounter& e) {
  const bool at_red = !e.foe_inside && e.foe.front < 0.0 && is_red(e.road.signal(e.foe_link));
  return free_if(at_red && !e.foe_clears && !(e.at_red && goes_at_red(e, e.foe.row, e.zone.foe)));
}

/// A driver who doesn't let people go first at an unsignalled crossing minds nobody who hasn't
/// stepped onto it.
Answer disregard(const Encounter& e) {
  return free_if(!e.foe_inside && e.zone.foe_is_crossing && e.foe.front < 0.0 &&
                 is_on_foot(e, e.foe.row) && e.road.signal(e.foe_link) == Light::None &&
                 !lets_people_go(e.model, e.scene, e.subject.row, e.zone.foe));
}

/// A foe that is about to halt at its line, as there is no room behind the junction or it lets
/// somebody else go, or for its amber. Who has halted like that lets the subject go first, too.
Answer halts_anyway(const Encounter& e) {
  if (e.foe_inside) return std::nullopt;
  const LimitReason why = e.foe_waits.reason;
  const bool for_others = why == LimitReason::BlockedJunction || why == LimitReason::LetsIn ||
                          why == LimitReason::TurningRoom;
  const bool at_line =
      for_others && !e.foe.stands && e.foe.front < 0.0 &&
      e.approaches.rest_of(e.foe) < e.parameters.line_tolerance &&
      stops_at_ease(e.foe.speed, std::max(e.parameters.line_tolerance - e.foe.front, 0.1),
                    e.foe_type);
  const bool at_amber =
      is_amber(e.road.signal(e.foe_link)) && e.foe.front < -e.parameters.near_line &&
      stops_at_ease(e.foe.speed, -e.foe.front - e.parameters.near_line, e.foe_type);
  return held_if(at_line || at_amber);
}

/// Cooperative yielding: the subject has the right of way and lets one go first who has waited for
/// long for it.
Answer courtesy(const Encounter& e) {
  if (!e.foe_inside && !e.zone.yields && (lets_step_out(e) || lets_nose_out(e)))
    return Verdict::Blocks;
  return std::nullopt;
}

// laws that know when either is in the area

Answer has_passed(const Encounter& e) { return free_if(e.theirs.begin == Occupation::kNever); }

/// Does the subject still wait to join a lane on which the foe comes without having to halt?
bool turns_in(const Encounter& e) {
  return e.foe_link.to == e.own_link.to && !halts_first(e.foe_link.priority) && !is_past_line(e);
}

/// Imposed braking of who comes along the lane that the link leads into, if the subject goes first
/// [m/s^2].
double imposed_braking(const Encounter& e) {
  const auto merging = [&](std::size_t row, double front, double length, double speed, double at) {
    return Merging{type_of(e.model.types, e.scene.type[row]),
                   *e.road.path(e.scene.path[row]),
                   front,
                   length,
                   speed,
                   e.scene.preferred_speed[row],
                   at};
  };
  const double foe_front = e.scene.path_along[e.foe.row] + 0.5 * e.foe.length;
  return braking_asked(e.parameters,
                       merging(e.subject.row, e.subject.front, e.subject.length, e.subject.speed,
                               e.link.stop_line + e.zone.end),
                       e.link.stop_line + e.zone.begin,
                       merging(e.foe.row, foe_front, e.foe.length, e.foe.speed,
                               foe_front + e.zone.foe_end - e.foe.front));
}

/// The two are there one after the other, with the critical gap between them, or the time gap
/// where the subject need not yield. Who yields goes right behind a vehicle that has passed; who
/// joins its lane before another that then follows it.
Answer apart_in_time(const Encounter& e) {
  const double share = 1.0 - impatience(e) * (1.0 - e.parameters.impatient_gap_share);
  const double margin = e.zone.yields ? e.own_type.critical_gap * share : e.parameters.time_gap;
  const bool merges = e.zone.yields && turns_in(e);
  const bool right_behind = e.zone.yields && !e.zone.foe_is_crossing;
  const double behind = right_behind ? std::min(e.parameters.reaction_time, margin) : margin;
  if (e.ours.begin < e.theirs.end + behind &&
      e.theirs.begin < (merges ? e.ours.begin : e.ours.end) + margin)
    return std::nullopt;
  return blocks_if(merges && !e.foe.stands && e.ours.begin < e.theirs.begin &&
                   imposed_braking(e) >
                       e.parameters.easy_braking + impatience(e) * (e.parameters.pressed_braking -
                                                                    e.parameters.easy_braking));
}

/// Who has backed out of a deadlock lets everybody past, wherever it stands, and so does who leaves
/// room for a long body or lets one in. Whom bodies hold isn't coming, and past the line it is no
/// use to wait for it; nor who creeps out of where it was stuck.
Answer lets_past(const Encounter& e) {
  const LimitReason why = e.foe_waits.reason;
  if (e.foe.stands && (why == LimitReason::GivesWay || why == LimitReason::TurningRoom ||
                       why == LimitReason::LetsIn))
    return Verdict::Held;
  if (e.foe.stands && e.foe_waits.blocked && (!e.foe_inside || is_on_junction(e)))
    return Verdict::Held;
  return held_if(!e.foe_inside && e.foe_link.signal == kNoSignal && is_wedged(e.scene, e.foe.row) &&
                 e.foe.speed < e.parameters.crawling_speed &&
                 waited(e, e.foe.row) >= Patience::Pressing);
}

/// All-way stop: who has halted goes in the order in which they came.
Answer all_way_stop(const Encounter& e) {
  if (e.foe_inside || e.own_link.priority != LinkPriority::AllWayStop) return std::nullopt;
  if (is_past_line(e) || !e.foe.has_halted) return Verdict::Free;
  const double own = e.approaches.waiting(e.subject.row).halted_at, their = e.foe_waits.halted_at;
  return blocks_if(their < own ||
                   (their == own && e.scene.id[e.foe.row] < e.scene.id[e.subject.row]));
}

/// Both have to give way to others here, with no signal between them: who has begun to cross
/// finishes, whoever of the two would go first at the line. Nobody is caught on the junction.
Answer begun_crossing(const Encounter& e) {
  const auto minor = [&](const Connection& c) {
    return (c.priority == LinkPriority::Minor || c.priority == LinkPriority::Stop ||
            c.priority == LinkPriority::Equal) &&
           e.road.signal(c) == Light::None && e.model.road.lane(c.to).kind != LaneKind::Crossing;
  };
  if (!minor(e.own_link) || !minor(e.foe_link)) return std::nullopt;
  const auto has_begun = [](double past, double speed) { return past > 0.3 && speed > 0.5; };
  const auto may_wait = [](double past, double speed, const AgentType& type) {
    return past < 0.0 && stops_at_ease(speed, -past, type);
  };
  const double own = -e.to_line();
  if (has_begun(e.foe.front, e.foe.speed) && may_wait(own, e.subject.speed, e.own_type))
    return Verdict::Blocks;
  return free_if(has_begun(own, e.subject.speed) && may_wait(e.foe.front, e.foe.speed, e.foe_type));
}

/// Who is left on the junction from an earlier phase leaves it before others come.
Answer clearance(const Encounter& e) {
  const bool clears = clears_junction(e, e.subject.row, e.link.connection, -e.to_line());
  if (clears && !e.foe_clears && !e.foe_inside && foe_may_halt(e)) return Verdict::Free;
  const double since = signal_since(e.road, e.own_link, e.scene.time);
  if (e.foe_clears && !clears && !e.foe_inside &&
      stops_at_ease(e.subject.speed, e.zone.begin - (e.subject.front - e.link.stop_line),
                    e.own_type) &&
      (!e.foe.stands || e.foe_waits.reason == LimitReason::Yield) &&
      e.scene.time - since < e.parameters.clearance_time)
    return Verdict::Blocks;
  return std::nullopt;
}

/// Who is owed its way after a long wait, by a foe that waits for it or by the subject.
Answer owed_way(const Encounter& e) {
  if (waits_for_subject(e) && !e.foe_inside && (noses_out(e) || goes_first(e)))
    return Verdict::Free;
  if (!e.foe_inside && !e.zone.yields && lets_go_first(e)) return Verdict::Blocks;
  return std::nullopt;
}

/// Of two who wait for each other one goes.
Answer mutual_wait(const Encounter& e) {
  if (!waits_for_subject(e)) return std::nullopt;
  if ((!e.zone.yields && !e.foe_inside) || lets_subject_go(e)) return Verdict::Held;
  return Verdict::Blocks;
}

/// Is the subject, on wheels, driving by somebody who has waited for long for a third one?
bool drives_by(const Encounter& e) {
  return !is_on_foot(e, e.subject.row) && has_set_out_from(e, e.link.stop_line) &&
         e.foe_waits.reason == LimitReason::Yield &&
         e.foe_waits.foe != e.scene.id[e.subject.row].value &&
         waited(e, e.foe.row) >= Patience::Impatient;
}

/// Have both stood on the junction for long, or for some seconds in a ring of those who wait for
/// one another? Conflict zones are wider than bodies: whoever isn't waited for by rule alone tries.
bool is_deadlock(const Encounter& e) {
  const Patience both = std::min(waited(e, e.subject.row), waited(e, e.foe.row));
  if (!is_on_junction(e) || both < Patience::Waiting) return false;
  if (both < Patience::Pressing && !e.waits.in_ring(e.subject.row)) return false;
  const LimitReason reason = e.foe_waits.reason;
  const bool yields = reason == LimitReason::Yield || reason == LimitReason::Crossing;
  // who isn't held by a rule and moves has begun to try
  return yields ? has_waited_longer(e, e.subject.row, e.foe.row)
                : e.foe.speed < e.parameters.moving_speed;
}

/// A foe in the area is waited for, unless it stands and there is a way past it: on foot one walks
/// round what stands on the crossing, on wheels past what stands beside the way.
Answer occupied(const Encounter& e) {
  if (!e.foe_inside) return std::nullopt;
  if (e.foe.stands && (lets_subject_go(e) || drives_by(e)) &&
      (e.own_type.kinematics == Kinematics::Holonomic ||
       stands_beside(e, e.subject, e.link, e.zone.begin, e.zone.end, e.foe)))
    return Verdict::Held;
  if (is_deadlock(e)) return Verdict::Held;
  return blocks_if(e.theirs.end + 0.3 > e.ours.begin);
}

/// Does a foe creep up to somebody who stands before the area? Who has waited for some time crosses
/// such a queue before it, too, not only where it happens to stand.
bool ends_in_queue(const Encounter& e) {
  if (e.foe_link.to == e.own_link.to || e.foe_link.signal != kNoSignal ||
      waited(e, e.subject.row) < Patience::Stuck || e.foe_waits.reason != LimitReason::Leader)
    return false;
  const std::size_t leader = e.waits.foe(e.foe.row);
  if (leader == e.scene.size() || e.scene.speed[leader] > e.parameters.standing_speed) return false;
  const Vec2 forward = direction_of(e.scene.heading[e.foe.row]);
  const double gap = (e.scene.position[leader] - e.scene.position[e.foe.row]).norm() -
                     0.5 * e.foe.length - half_extent(e.scene, leader, forward);
  return e.foe.front + gap - e.foe_type.min_gap < e.zone.foe_begin;
}

/// A foe that stands in a queue, or waits for others, lets the subject go.
Answer waiting_foe(const Encounter& e) {
  return held_if((lets_subject_go(e) && !is_starved_by(e)) || ends_in_queue(e));
}

/// Who stands on the junction in the way of one with the right of way goes first.
Answer clears_way(const Encounter& e) {
  return free_if(e.zone.yields && holds_up(e, e.subject.row, -e.to_line()) && goes_first(e));
}

/// Is the foe past the place where it would wait for the subject, and before the area no more?
bool is_committed(const Encounter& e) {
  const auto& links = e.road.path(e.scene.path[e.foe.row])->links;
  const auto its = std::find_if(links.begin(), links.end(), [&](const PathLink& candidate) {
    return candidate.connection == e.zone.foe;
  });
  if (its == links.end()) return true;
  return e.foe.front >
             waiting_place(e.parameters, *its, e.zone.foe_begin).along - its->stop_line + 0.3 &&
         !foe_may_halt(e);
}

/// No rule for this pair, or whoever has to wait is past the line already: who gets there first
/// goes first, the other waits for it. Nobody who has to wait makes a foe brake hard.
Answer first_come(const Encounter& e) {
  if (!e.zone.unruled && !(is_past_line(e) && (e.zone.yields || is_committed(e))))
    return std::nullopt;
  const bool cuts_off = e.zone.yields && !foe_may_halt(e);
  return blocks_if(
      cuts_off || e.theirs.begin < e.ours.begin ||
      (e.theirs.begin == e.ours.begin && e.scene.id[e.foe.row] < e.scene.id[e.subject.row]));
}

/// Is a foe that has to yield past its line already and, as things are, on its way into the area?
/// Whoever sees that brakes at ease now, not hard once it is there.
bool comes_out(const Encounter& e) {
  return e.foe.front > e.parameters.line_tolerance && !e.foe.stands &&
         e.approaches.rest_of(e.foe) > e.zone.foe_begin && e.theirs.begin < e.parameters.outlook &&
         !is_on_foot(e, e.subject.row) && !is_on_foot(e, e.foe.row);
}

/// Right of way, but nobody steps in front of a vehicle that can no longer stop.
Answer priority(const Encounter& e) {
  if (e.zone.yields) return std::nullopt;
  if (comes_out(e) && e.theirs.begin < e.ours.begin) return Verdict::Blocks;
  const bool unstoppable = deceleration_to_stop(e.foe.speed, e.zone.foe_begin - e.foe.front) >
                           0.7 * e.foe_type.max_deceleration;
  return blocks_if(is_on_foot(e, e.subject.row) && unstoppable && !is_on_foot(e, e.foe.row));
}

/// Forced entry: who has waited for long goes before one that need not brake hard for it.
Answer forced_entry(const Encounter& e) {
  return free_if(steps_out(e) || noses_out(e) || goes_first(e));
}

constexpr Law kAtSight[] = {red_light, disregard, halts_anyway, courtesy};
constexpr Law kInTime[] = {has_passed, apart_in_time, lets_past,   all_way_stop, begun_crossing,
                           clearance,  owed_way,      mutual_wait, occupied,     waiting_foe,
                           clears_way, first_come,    priority,    forced_entry};

}  // namespace

Verdict judge(Encounter encounter) {
  for (const Law law : kAtSight)
    if (const Answer answer = law(encounter)) return *answer;
  foresee(encounter);
  for (const Law law : kInTime)
    if (const Answer answer = law(encounter)) return *answer;
  return Verdict::Blocks;
}

}  // namespace sumogamma
