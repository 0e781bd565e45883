#include "traffic/junction/laws.h"

#include <algorithm>
#include <span>

#include "model/stopping_guard.h"
#include "traffic/junction/long_wait.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/merging.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

// laws that need no look into the future

/// Who is in the area goes on, avoidance does the rest; so does who is at its edge with a way past
/// a foe that stands.
bool goes_on(const Encounter& e, const Party& x, const Party& y) {
  return x.inside ||
         (x.to_area() < e.parameters.line_tolerance && y.at.stands && gets_past(e, x, y));
}

/// Who waits at red doesn't come, but somebody who goes at red, too, is waited for by another, and
/// who clears the junction by all.
bool waits_at_red(const Encounter& e, const Party& x, const Party& y) {
  return !y.inside && y.at.front < 0.0 && is_red(e.road.signal(y.link)) && !y.clears &&
         !(x.at_red && y.at_red);
}

/// Somebody who is about to halt at its line, as there is no room behind the junction or it lets
/// somebody else go, or for its amber.
bool halts_anyway(const Encounter& e, const Party&, const Party& y) {
  if (y.inside) return false;
  const LimitReason why = y.waits.reason;
  const bool for_others = why == LimitReason::BlockedJunction || why == LimitReason::LetsIn ||
                          why == LimitReason::TurningRoom;
  const double tolerance = e.parameters.line_tolerance, to_line = -y.at.front;
  const bool at_line = for_others && !y.at.stands && to_line > 0.0 &&
                       e.approaches.rest_of(y.at) < tolerance &&
                       stops_at_ease(y.at.speed, std::max(tolerance + to_line, 0.1), y.type);
  const double to_amber = to_line - e.parameters.near_line;
  return at_line || (is_amber(e.road.signal(y.link)) && to_amber > 0.0 &&
                     stops_at_ease(y.at.speed, to_amber, y.type));
}

// laws that know when either is in the area

/// When y leaves the area, as x reckons. It reckons with nobody who will come to rest there, and on
/// foot with nobody who stands, to have passed by the time that it gets there itself.
double seen_to_leave(const Party& x, const Party& y) {
  return y.rests || (y.at.stands && x.on_foot) ? Occupation::kNever : y.stay.end;
}

bool has_passed(const Encounter&, const Party&, const Party& y) {
  return y.stay.begin == Occupation::kNever;
}

/// Does x still wait to join a lane on which y comes without having to halt?
bool turns_in(const Encounter& e, const Party& x, const Party& y) {
  return y.link.to == x.link.to && !halts_first(y.link.priority) && !is_past_line(e, x);
}

/// Imposed braking of who comes along the lane that x turns into, if x goes first [m/s^2].
double imposed_braking(const Encounter& e, const Party& x, const Party& y) {
  const auto merging = [&](const Party& one) {
    const double line = one.on_path.stop_line;
    return Merging{
        one.type,     *e.road.path(e.scene.path[one.row()]), line + one.at.front, one.at.length,
        one.at.speed, e.scene.preferred_speed[one.row()],    line + one.area.end};
  };
  return braking_asked(e.parameters, merging(x), x.on_path.stop_line + x.area.begin, merging(y));
}

/// The two are there one after the other, with the critical gap between them, or the time gap
/// where x need not yield. Who yields goes right behind a vehicle that has passed; who joins its
/// lane before another that then follows it, unless that one would have to brake hard.
bool apart_in_time(const Encounter& e, const Party& x, const Party& y) {
  const double impatience = impatience_after(e.parameters, e.traffic.waiting_time[x.row()]);
  const double share = 1.0 - impatience * (1.0 - e.parameters.impatient_gap_share);
  const double margin = x.yields ? x.type.critical_gap * share : e.parameters.time_gap;
  const bool crossing = e.model.road.lane(y.link.to).kind == LaneKind::Crossing;
  const double behind =
      x.yields && !crossing ? std::min(e.parameters.reaction_time, margin) : margin;
  if (x.stay.begin >= seen_to_leave(x, y) + behind) return true;
  const bool merges = x.yields && turns_in(e, x, y);
  if (y.stay.begin < (merges ? x.stay.begin : x.stay.end) + margin) return false;
  return !merges || y.at.stands || x.stay.begin >= y.stay.begin ||
         imposed_braking(e, x, y) <=
             e.parameters.easy_braking +
                 impatience * (e.parameters.pressed_braking - e.parameters.easy_braking);
}

/// Who has backed out of a deadlock lets everybody past, wherever it stands, and so does who leaves
/// room for a long body or lets one in. Whom bodies hold isn't coming, and past the line it is no
/// use to wait for it.
bool lets_past(const Encounter& e, const Party& x, const Party& y) {
  const LimitReason why = y.waits.reason;
  const bool for_others =
      why == LimitReason::GivesWay || why == LimitReason::TurningRoom || why == LimitReason::LetsIn;
  return y.at.stands && (for_others || (y.waits.blocked && (!y.inside || is_on_junction(e, x))));
}

/// All-way stop: who has halted goes in the order in which they came.
bool all_way_stop(const Encounter& e, const Party& x, const Party& y) {
  if (x.link.priority != LinkPriority::AllWayStop || x.inside || y.inside) return false;
  if (is_past_line(e, y)) return false;
  if (is_past_line(e, x)) return true;
  if (!has_halted(e, x)) return false;
  const double own = x.waits.halted_at, their = y.waits.halted_at;
  return !has_halted(e, y) || own < their ||
         (own == their && e.scene.id[x.row()] < e.scene.id[y.row()]);
}

/// Who is left on the junction from an earlier phase leaves it before others come.
bool clears_first(const Encounter& e, const Party& x, const Party& y) {
  if (!x.clears || y.clears || y.inside || !may_halt(y)) return false;
  const double since = e.scene.time - signal_since(e.road, y.link, e.scene.time);
  return !x.at.stands ||
         (x.waits.reason == LimitReason::Yield && since < e.parameters.clearance_time);
}

/// Does y, who stands, let x go first? It waits for a signal or in a queue, for x itself, or it
/// came later. Of two that wait for each other exactly one goes: who is on foot, else who has
/// waited longer.
bool lets_go(const Encounter& e, const Party& x, const Party& y) {
  const bool both_on_junction = y.at.front > 0.0 && is_on_junction(e, x);
  if (!y.at.stands || (both_on_junction && y.at.speed > e.parameters.moving_speed)) return false;
  switch (y.waits.reason) {
    case LimitReason::Signal:
    case LimitReason::Stop:
    case LimitReason::BlockedJunction:
    case LimitReason::GivesWay:
    case LimitReason::TurningRoom:
    case LimitReason::LetsIn:
    case LimitReason::Merge:
    case LimitReason::Leader:  // it stands in a queue, be it behind x
      return true;
    case LimitReason::Yield:
    case LimitReason::Crossing:
      break;
    default:
      return false;
  }
  const bool for_x = waits_for(e, y, x);
  if (for_x && x.on_foot != y.on_foot) return x.on_foot;
  // it has waited long for a third one and isn't about to go
  const bool has_set_out = x.on_foot && has_set_out_from(e, x, x.on_path.halt);
  if (!for_x && waited(e, y.row()) >= Patience::Impatient &&
      (waited(e, x.row()) >= Patience::Waiting || has_set_out))
    return true;
  return has_waited_longer(e, x.row(), y.row());
}

/// Who stands and waits for x lets it go.
bool waits_for_x(const Encounter& e, const Party& x, const Party& y) {
  return waits_for(e, y, x) && ((!x.yields && !y.inside) || lets_go(e, x, y));
}

/// A foe stands in the area, and there is a way past it: on foot one walks round what stands on the
/// crossing, on wheels past what stands beside the way.
bool passes_by(const Encounter& e, const Party& x, const Party& y) {
  return y.inside && y.at.stands && lets_go(e, x, y) && gets_past(e, x, y);
}

bool leaves_in_time(const Encounter&, const Party& x, const Party& y) {
  return y.inside && seen_to_leave(x, y) + 0.3 <= x.stay.begin;
}

bool is_inside(const Encounter&, const Party& x, const Party&) { return x.inside; }

bool comes_earlier(const Encounter& e, const Party& x, const Party& y) {
  return x.stay.begin < y.stay.begin ||
         (x.stay.begin == y.stay.begin && e.scene.id[x.row()] < e.scene.id[y.row()]);
}

/// Nobody steps in front of a vehicle that can no longer stop.
bool cannot_stop(const Encounter&, const Party& x, const Party& y) {
  return y.on_foot && !x.on_foot &&
         deceleration_to_stop(x.at.speed, x.to_area()) > 0.7 * x.type.max_deceleration;
}

/// Who has to wait, but stands past its line already, goes where it is the first to get there and
/// makes nobody brake hard. The other isn't told to wait until it sees x come out: rings fill up
/// where those in them halt for who might come in.
bool slips_in(const Encounter& e, const Party& x, const Party& y) {
  return x.yields && is_past_line(e, x) && comes_earlier(e, x, y) && may_halt(y);
}

/// No rule for this pair, or whoever has to wait is past its line already and comes out: who gets
/// there first goes first, the other sees that and brakes at ease now. Nobody who has to wait makes
/// a foe brake hard.
bool comes_first(const Encounter& e, const Party& x, const Party& y) {
  const auto too_late = [&](const Party& one) { return one.yields && is_past_line(e, one); };
  if (!e.unruled && !too_late(x) && !too_late(y)) return false;
  const bool comes_out = x.at.speed > e.parameters.moving_speed &&
                         e.approaches.rest_of(x.at) > x.area.begin &&
                         x.stay.begin < e.parameters.outlook;
  return (e.unruled || comes_out) && comes_earlier(e, x, y) && !(x.yields && !may_halt(y));
}

bool has_priority(const Encounter&, const Party& x, const Party& y) {
  return !x.yields && y.yields;
}

constexpr Law kAtSight[] = {
    {goes_on, Effect::YPasses}, {waits_at_red, Effect::YPasses}, {halts_anyway, Effect::YStands}};
constexpr Law kInTime[] = {
    {has_passed, Effect::YPasses},      {apart_in_time, Effect::YPasses},
    {lets_past, Effect::YStands},       {all_way_stop, Effect::XGoesFirst},
    {clears_first, Effect::XGoesFirst}, {is_owed_its_way, Effect::XGoesFirst},
    {waits_for_x, Effect::YStands},     {passes_by, Effect::YStands},
    {leaves_in_time, Effect::YPasses},  {is_inside, Effect::XGoesFirst},
    {lets_go, Effect::YStands},         {cannot_stop, Effect::XGoesFirst},
    {slips_in, Effect::YPasses},        {comes_first, Effect::XGoesFirst},
    {has_priority, Effect::XGoesFirst}, {comes_earlier, Effect::XGoesFirst}};

/// What the first of some laws that decides says to the first party.
std::optional<Verdict> ask(std::span<const Law> laws, const Encounter& e) {
  for (const Law& law : laws) {
    const bool own = law.claim(e, e.a, e.b);
    if (law.effect == Effect::XGoesFirst) {
      if (own != law.claim(e, e.b, e.a)) return own ? Verdict::Free : Verdict::Blocks;
    } else if (own) {
      return law.effect == Effect::YStands ? Verdict::Held : Verdict::Free;
    }
  }
  return {};
}

}  // namespace

Verdict judge(Encounter encounter) {
  if (const auto verdict = ask(kAtSight, encounter)) return *verdict;
  foresee(encounter);
  return ask(kInTime, encounter).value_or(Verdict::Free);
}

}  // namespace sumogamma
