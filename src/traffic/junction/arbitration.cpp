#include "traffic/junction/arbitration.h"

#include <algorithm>

#include "geometry/oriented_box.h"
#include "model/stopping_guard.h"
#include "traffic/junction/occupation.h"
#include "traffic/junction/turning_room.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/merging.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

constexpr double kFillsLane = 1.2;  ///< nobody overtakes what is wider than this on a link [m]
constexpr double kPatience = 4.0;  ///< who has waited for a third one so long isn't about to go [s]
constexpr double kLooks = 1.5;     ///< and is looked at for so long [s]
constexpr double kCreeps = 0.1;    ///< who is on the junction and faster doesn't stand [m/s]
constexpr double kAmber = 2.5;     ///< reckoned with from an amber on [s]
constexpr double kCrawl = 1.0;     ///< whoever is slower stands within centimetres [m/s]
constexpr double kTimeMargin = 1.0;  ///< left by who needn't yield to the other in a zone [s]
constexpr double kBehind = 0.3;      ///< left by who yields behind a vehicle that has passed [s]
// who has waited for long to give way leaves this share of its critical gap
constexpr double kLeastShare = 0.4;
// and asks this braking of who has the right of way in the lane that it joins, or at first [m/s^2]
constexpr double kAskedMost = 3.5, kAsked = 1.5;
constexpr double kLongWait = 60.0;   // [s]
constexpr double kLetsClear = 20.0;  // who is left on a junction, after lights changed [s]
// zones are kept free for so long at the most [s]
constexpr double kKeepsZonesFree = 20.0;

/// A piece of a link as it lies for somebody on `path`, whose link begins at `link_begin`: who
/// walks over a crossing against its lane meets the same places in the opposite order, counted from
/// the other end.
struct Piece {
  double begin = 0, end = 0;
};
Piece as_travelled(const Path& path, double link_begin, double begin, double end) {
  if (!path.walking) return {begin, end};
  const PathStretch& stretch = path.stretch_at(link_begin + 0.01);
  if (!stretch.reversed) return {begin, end};
  const double length = stretch.to - stretch.from;
  return {length - end, length - begin};
}

/// Does somebody at `speed` [m/s] stop within `way` [m] at ease?
bool stops_at_ease(double speed, double way, const AgentType& type) {
  return deceleration_to_stop(speed, way) < type.comfortable_deceleration;
}

constexpr double kEdge = 0.3;    // who halts before a zone comes to rest so near its begin [m]
constexpr double kMargin = 0.3;  // between a place to wait on a junction and what it is for [m]

// who stands so near its line when amber begins may go on [m]
constexpr double kNearLine = 2.5;

/// Is a front `past` the begin of its link [m] in a zone that begins there at `begin`? Not who has
/// come to rest at its edge.
bool has_entered(double past, double begin) { return past > begin + kEdge; }

/// Has a row waited for longer than another? The smaller id where they began together.
bool has_waited_longer(const TrafficView& view, std::size_t row, std::size_t other) {
  const double own = view.traffic.waiting_time[row], their = view.traffic.waiting_time[other];
  return own > their || (own == their && view.scene.id[row] < view.scene.id[other]);
}

/// True where a foe that stands and waits lets `row` go first: it waits for a signal or in a queue,
/// for this very agent, or it came later. Of two that wait for each other exactly one goes: who is
/// on foot, else who has stood longer.
bool lets_go_first(const TrafficView& view, const Approach& foe, std::size_t row,
                   bool both_on_junction, bool has_set_out) {
  if (!foe.stands || (both_on_junction && foe.speed > kCreeps)) return false;
  const Waiting& waiting = view.approaches.waiting(foe.row);
  switch (waiting.reason) {
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
  auto on_foot = [&](std::size_t r) {
    return type_of(view.model.types, view.scene.type[r]).kinematics == Kinematics::Holonomic;
  };
  if (waiting.foe == view.scene.id[row].value && on_foot(row) != on_foot(foe.row))
    return on_foot(row);
  const double own = view.traffic.waiting_time[row], other = view.traffic.waiting_time[foe.row];
  // it has waited long for a third one and isn't about to go
  if (waiting.foe != view.scene.id[row].value && other > kPatience && (own > kLooks || has_set_out))
    return true;
  return has_waited_longer(view, row, foe.row);
}

/// Where a front waits for a zone of a link [m along its path]: before the stop line, or on the
/// junction where SUMO's network has room for that before the zone. The flag says which.
struct WaitingPlace {
  double along = 0;
  bool inside = false;
};
WaitingPlace waiting_place(const PathLink& link, double zone_begin) {
  constexpr double kSlack = 2.0, kLeast = 1.5;  // [m]
  const double begin = link.stop_line + zone_begin;
  const double place = std::min(link.inside, begin) - kMargin;
  if (begin < link.inside - kSlack || place < link.stop_line + kLeast)
    return {link.stop_line, false};
  return {place, true};
}

/// Does somebody ride so far beside the middle of its lane that on the junction it might wait where
/// a foe's long body sweeps? Whether that one turns isn't asked.
bool is_aside_for(const Approach& foe, const TrafficState& traffic, std::size_t row) {
  constexpr double kAside = 0.7, kLong = 7.0;  // [m]
  return foe.length > kLong && std::abs(traffic.passing_offset[row]) >= kAside;
}

/// What a foe means for a traveller.
enum class Verdict {
  Free,    ///< nothing: it has passed, is far away, or has to wait
  Held,    ///< it stands and lets the traveller go first; nobody gets past it either
  Blocks,  ///< it has to be waited for
};

struct Judge : TrafficView {
  const Traveller& traveller;
  const PathLink& link;
  bool at_red = false;  ///< the traveller goes over this link at red, where the way is free

  Verdict of(ConflictZone zone, const Approach& foe) const {
    if (foe.row == traveller.row) return Verdict::Free;
    const Path* foe_path = road.path(scene.path[foe.row]);
    const double foe_link_begin = scene.path_along[foe.row] + 0.5 * foe.length - foe.front;
    const Piece theirs_to_cover =
        as_travelled(*foe_path, foe_link_begin, zone.foe_begin, zone.foe_end);
    zone.foe_begin = theirs_to_cover.begin;
    zone.foe_end = theirs_to_cover.end;
    const AgentType& foe_type = type_of(model.types, scene.type[foe.row]);
    const AgentType& own_type = type_of(model.types, scene.type[traveller.row]);
    const bool foe_inside = has_entered(foe.front, zone.foe_begin);
    const Connection& foe_link = model.road.connection(zone.foe);
    // who waits at red doesn't come, but somebody who goes at red, too, is waited for by another,
    // and who clears the junction by all
    const bool foe_at_red = !foe_inside && foe.front < 0.0 && is_red(road.signal(foe_link));
    const bool foe_clears = clears_junction(foe.row, zone.foe, foe.front);
    if (foe_at_red && !foe_clears && !(at_red && goes_at_red(model, scene, foe.row, zone.foe)))
      return Verdict::Free;
    if (!foe_inside && ignores(zone, foe)) return Verdict::Free;
    if (is_ignored_by(foe)) zone.yields = true;
    if (!foe_inside && (halts_at_line(foe) || halts_at_amber(foe, foe_link))) return Verdict::Held;
    if (!foe_inside && !zone.yields && (lets_step_out(zone, foe) || lets_nose_out(zone, foe)))
      return Verdict::Blocks;

    Occupation theirs = occupation(*this, foe, zone.foe_begin, zone.foe_end);
    if (theirs.begin == Occupation::kNever) return Verdict::Free;
    // nobody on foot counts on a vehicle that stands to have passed by the time that it gets there
    if (rests_in(zone, foe) || (foe.stands && on_foot(traveller.row)))
      theirs.end = Occupation::kNever;
    const Approach own = approach_of(traveller, link);
    const Occupation ours = occupation(*this, own, zone.begin, zone.end);
    const double margin = zone.yields
                              ? own_type.critical_gap * (1.0 - impatience() * (1.0 - kLeastShare))
                              : kTimeMargin;
    // who yields goes right behind a vehicle that has passed; who joins its lane before another
    // that then follows it
    const bool merges = zone.yields && turns_in(zone, foe_link);
    const bool right_behind = zone.yields && !zone.foe_is_crossing;
    const double behind = right_behind ? std::min(kBehind, margin) : margin;
    const bool overlap = ours.begin < theirs.end + behind &&
                         theirs.begin < (merges ? ours.begin : ours.end) + margin;
    if (!overlap)
      return blocks_if(merges && !foe.stands && ours.begin < theirs.begin &&
                       braking_asked_of(zone, foe) > kAsked + impatience() * (kAskedMost - kAsked));
    // who has backed out of a deadlock lets everybody past, wherever it stands, and so does who
    // leaves room for a long body or lets one in; whom bodies hold isn't coming, and past the line
    // it is no use to wait for it
    const Waiting& waiting = approaches.waiting(foe.row);
    const bool lets_past = waiting.reason == LimitReason::GivesWay ||
                           waiting.reason == LimitReason::TurningRoom ||
                           waiting.reason == LimitReason::LetsIn;
    if (foe.stands && lets_past) return Verdict::Held;
    if (foe.stands && waiting.blocked && (!foe_inside || on_junction())) return Verdict::Held;
    if (!foe_inside && foe_link.signal == kNoSignal && creeps_out(foe)) return Verdict::Held;
    const bool waits_for_us = foe.stands && waiting.foe == scene.id[traveller.row].value;
    // all-way stop: who has halted goes in the order in which they came
    if (!foe_inside && model.road.connection(link.connection).state == 'w') {
      if (past_line(zone)) return Verdict::Free;
      const Waiting& theirs_then = approaches.waiting(foe.row);
      if (!foe.has_halted) return Verdict::Free;  // it has to halt first
      const double own_time = approaches.waiting(traveller.row).halted_at;
      return blocks_if(
          theirs_then.halted_at < own_time ||
          (theirs_then.halted_at == own_time && scene.id[foe.row] < scene.id[traveller.row]));
    }
    if (on_equal_footing(foe_link)) {
      if (has_begun(foe.front, foe.speed) && may_wait(-to_line(), traveller.speed, own_type))
        return Verdict::Blocks;
      if (has_begun(-to_line(), traveller.speed) && may_wait(foe.front, foe.speed, foe_type))
        return Verdict::Free;
    }
    // who is left on the junction from an earlier phase leaves it before others come
    const bool clears = clears_junction(traveller.row, link.connection, -to_line());
    if (clears && !foe_clears && !foe_inside && foe_may_halt(zone, foe)) return Verdict::Free;
    if (foe_clears && !clears && !foe_inside &&
        stops_at_ease(own.speed, zone.begin - own.front, own_type) &&
        (!foe.stands || waiting.reason == LimitReason::Yield) &&
        scene.time - lights_since() < kLetsClear)
      return Verdict::Blocks;
    if (waits_for_us && !foe_inside && (noses_out(zone, foe) || goes_first(zone, foe)))
      return Verdict::Free;
    if (!foe_inside && !zone.yields && lets_go_first_of_all(zone, foe)) return Verdict::Blocks;
    if (waits_for_us) return !zone.yields && !foe_inside ? Verdict::Held : waiting_verdict(foe);
    // on foot one walks round what stands on the crossing, on wheels past what stands beside the
    // way
    if (foe_inside && foe.stands && (waits_behind(foe) || drives_by(foe)) &&
        (own_type.kinematics == Kinematics::Holonomic ||
         stands_beside(*this, traveller, link, zone.begin, zone.end, foe)))
      return Verdict::Held;
    if (foe_inside && in_deadlock(foe)) return Verdict::Held;
    if (foe_inside) return blocks_if(theirs.end + 0.3 > ours.begin);
    if ((waits_behind(foe) && !is_starved_by(zone, foe)) || ends_in_queue(zone, foe))
      return Verdict::Held;
    if (zone.yields && holds_up(traveller.row, -to_line()) && goes_first(zone, foe))
      return Verdict::Free;
    // no rule for this pair, or whoever has to wait is past the line already: who gets there first
    // goes first, the other waits for it. Nobody who has to wait makes a foe brake hard
    const bool cuts_off = zone.yields && !foe_may_halt(zone, foe);
    if (zone.unruled || (past_line(zone) && (zone.yields || is_committed(zone, foe))))
      return blocks_if(cuts_off || theirs.begin < ours.begin ||
                       (theirs.begin == ours.begin && scene.id[foe.row] < scene.id[traveller.row]));
    if (!zone.yields) {
      if (comes_out(zone, foe, theirs) && theirs.begin < ours.begin) return Verdict::Blocks;
      // right of way, but nobody steps in front of a vehicle that can no longer stop
      const bool vulnerable = own_type.kinematics == Kinematics::Holonomic;
      const bool unstoppable = deceleration_to_stop(foe.speed, zone.foe_begin - foe.front) >
                               0.7 * foe_type.max_deceleration;
      return blocks_if(vulnerable && unstoppable && foe_type.kinematics != Kinematics::Holonomic);
    }
    if (steps_out(zone, foe) || noses_out(zone, foe) || goes_first(zone, foe)) return Verdict::Free;
    return Verdict::Blocks;
  }

 private:
  bool on_foot(std::size_t row) const {
    return type_of(model.types, scene.type[row]).kinematics == Kinematics::Holonomic;
  }
  /// Was the traveller free to go a tick ago, and is it past `place` [m], where it would wait? Who
  /// has looked and set out needn't look again.
  bool has_set_out_from(double place) const {
    constexpr double kPast = 0.1;  // [m]
    const RoadContext& before = scene.context[traveller.row];
    return before.active &&
           (before.reason == LimitReason::None || before.reason == LimitReason::Leader) &&
           traveller.front > place + kPast;
  }
  /// Is the traveller, on wheels, driving by somebody who has waited for long for a third one?
  bool drives_by(const Approach& foe) const {
    const Waiting& waiting = approaches.waiting(foe.row);
    return !on_foot(traveller.row) && has_set_out_from(link.stop_line) &&
           waiting.reason == LimitReason::Yield && waiting.foe != scene.id[traveller.row].value &&
           traffic.waiting_time[foe.row] > kPatience;
  }
  bool waits_behind(const Approach& foe) const {
    return lets_go_first(*this, foe, traveller.row, foe.front > 0.0 && on_junction(),
                         on_foot(traveller.row) && has_set_out_from(link.halt));
  }
  /// Has a foe on wheels with the right of way stood for so long for others in the zone that the
  /// traveller lets it come next, from its line? One after the other went in there before it.
  bool is_starved_by(const ConflictZone& zone, const Approach& foe) const {
    constexpr double kLong = 20.0;  // [s]
    return zone.yields && to_line() > -kEdge && !on_foot(foe.row) &&
           approaches.waiting(foe.row).reason == LimitReason::Yield &&
           scene.held[foe.row].standing > kLong;
  }
  /// Somebody who hasn't stepped on an unsignalled crossing, where the traveller doesn't let people
  /// go first.
  bool ignores(const ConflictZone& zone, const Approach& foe) const {
    return zone.foe_is_crossing && foe.front < 0.0 && on_foot(foe.row) &&
           road.signal(model.road.connection(zone.foe)) == 'O' &&
           !lets_people_go(model, scene, traveller.row, zone.foe);
  }
  /// A driver who will not stop for the traveller, who still waits at an unsignalled crossing and
  /// sees it.
  bool is_ignored_by(const Approach& foe) const {
    return on_foot(traveller.row) && traveller.front < link.stop_line && !foe.stands &&
           road.signal(model.road.connection(link.connection)) == 'O' &&
           !lets_people_go(model, scene, foe.row, link.connection);
  }
  /// Is a foe on the way to its line to halt there, as there is no room behind the junction or it
  /// lets somebody else go? Who has halted like that lets the traveller go first, too.
  bool halts_at_line(const Approach& foe) const {
    constexpr double kAtLine = 0.3;  // [m]
    const LimitReason why = approaches.waiting(foe.row).reason;
    const bool for_others = why == LimitReason::BlockedJunction || why == LimitReason::LetsIn ||
                            why == LimitReason::TurningRoom;
    return for_others && !foe.stands && foe.front < 0.0 && approaches.rest_of(foe) < kAtLine &&
           stops_at_ease(foe.speed, std::max(kAtLine - foe.front, 0.1),
                         type_of(model.types, scene.type[foe.row]));
  }
  /// Will a foe halt before its light, which is amber?
  bool halts_at_amber(const Approach& foe, const Connection& foe_link) const {
    return is_amber(road.signal(foe_link)) && foe.front < -kNearLine &&
           stops_at_ease(foe.speed, -foe.front - kNearLine,
                         type_of(model.types, scene.type[foe.row]));
  }
  static constexpr double kAsks = 2.0;  ///< of who halts for somebody with a long wait [m/s^2]
  /// Is it longer ago than `least` [s] that a row came to a halt before its link?
  bool has_waited_since_it_came(std::size_t row, ConnectionId its, double least) const {
    const Waiting& waiting = approaches.waiting(row);
    return waiting.halted_for == its && scene.time - waiting.halted_at > least;
  }
  /// Has somebody on foot waited for so long at a crossing where vehicles go first that it steps
  /// out, or begun to do so? Who sets out and steps back again waits from when it came, where there
  /// is no light.
  bool has_had_enough(std::size_t row, ConnectionId its) const {
    constexpr double kLong = 30.0, kSetOut = 10.0;  // of waiting, which walking counts down [s]
    constexpr double kSinceItCame = 45.0;           // [s]
    if (!on_foot(row)) return false;
    return traffic.waiting_time[row] > (scene.speed[row] > kCreeps ? kSetOut : kLong) ||
           (has_waited_since_it_came(row, its, kSinceItCame) &&
            road.signal(model.road.connection(its)) == 'O');
  }
  /// Does the traveller, on foot, step out before one that need not brake hard for it? Where they
  /// come without end nobody else lets it.
  bool steps_out(const ConflictZone& zone, const Approach& foe) const {
    return has_had_enough(traveller.row, link.connection) && !on_foot(foe.row) && !at_red &&
           asks_little_of(zone, foe);
  }
  /// Does a driver halt for such a one? In a queue that creeps over the crossing nobody's foot
  /// finds a place before one does.
  bool lets_step_out(const ConflictZone& zone, const Approach& foe) const {
    constexpr double kAtKerb = 2.0;  // [m]
    return has_had_enough(foe.row, zone.foe) && foe.front > -kAtKerb &&
           road.signal(model.road.connection(zone.foe)) == 'O' &&
           lets_people_go(model, scene, traveller.row, zone.foe) && halts_for_long_wait(zone, foe);
  }
  /// Has somebody on wheels stood at its line, or on the junction behind it, for so long that it
  /// noses out before who need not brake hard for it?
  bool has_stood_for_long(std::size_t row, ConnectionId its) const {
    constexpr double kLong = 45.0;  // [s]
    return !on_foot(row) && has_waited_since_it_came(row, its, kLong);
  }
  /// Has a cyclist stood at the line before its light since before the last green, and green has
  /// begun again, or is it past the line by now? Who turns left out of a lane at the kerb crosses
  /// the lanes beside, which have the same green.
  bool has_missed_green(std::size_t row, ConnectionId its, double front) const {
    constexpr double kCycle = 75.0, kBegins = 3.0;  // [s]
    constexpr double kCyclist = 10.0;               // at the most [m/s]
    const Connection& link_of = model.road.connection(its);
    if (link_of.signal == kNoSignal || !has_waited_since_it_came(row, its, kCycle) ||
        on_foot(row) || type_of(model.types, scene.type[row]).max_speed > kCyclist)
      return false;
    const char signal = road.signal(link_of);
    return front > 0.0 || (!is_red(signal) && !is_amber(signal) &&
                           scene.time - signal_since(road, link_of, scene.time) < kBegins);
  }
  /// Is somebody on wheels on the junction, in the way of one with the right of way? The sooner it
  /// is gone the less of the green is lost.
  bool holds_up(std::size_t row, double front) const {
    return front > 0.0 && !on_foot(row) && approaches.waiting(row).holds_up;
  }
  bool is_owed_its_way(std::size_t row, ConnectionId its, double front) const {
    return has_missed_green(row, its, front) || holds_up(row, front);
  }
  /// Does the traveller go first now, before one that need not brake hard for it?
  bool goes_first(const ConflictZone& zone, const Approach& foe) const {
    return is_owed_its_way(traveller.row, link.connection, -to_line()) && !on_foot(foe.row) &&
           !at_red && asks_little_of(zone, foe);
  }
  /// Does a driver let such a one go first?
  bool lets_go_first_of_all(const ConflictZone& zone, const Approach& foe) const {
    return is_owed_its_way(foe.row, zone.foe, foe.front) &&
           !is_owed_its_way(traveller.row, link.connection, -to_line()) &&
           halts_at_ease_for(zone, foe);
  }
  /// Has neither of the two a light?
  bool by_themselves(const ConflictZone& zone) const {
    return model.road.connection(link.connection).signal == kNoSignal &&
           model.road.connection(zone.foe).signal == kNoSignal;
  }
  bool noses_out(const ConflictZone& zone, const Approach& foe) const {
    return has_stood_for_long(traveller.row, link.connection) && !on_foot(foe.row) &&
           by_themselves(zone) && asks_little_of(zone, foe);
  }
  /// Does a driver halt for such a one?
  bool lets_nose_out(const ConflictZone& zone, const Approach& foe) const {
    return has_stood_for_long(foe.row, zone.foe) &&
           !has_stood_for_long(traveller.row, link.connection) && by_themselves(zone) &&
           halts_for_long_wait(zone, foe);
  }
  /// Need a foe brake with no more than kAsks to halt before the zone?
  bool asks_little_of(const ConflictZone& zone, const Approach& foe) const {
    return deceleration_to_stop(foe.speed, zone.foe_begin - foe.front) < kAsks;
  }
  /// Can the traveller, on wheels, halt without braking hard for a foe that waits for its way
  /// alone?
  bool halts_at_ease_for(const ConflictZone& zone, const Approach& foe) const {
    const LimitReason why = approaches.waiting(foe.row).reason;
    return !on_foot(traveller.row) && (why == LimitReason::Yield || why == LimitReason::None) &&
           deceleration_to_stop(traveller.speed, link.stop_line + zone.begin - traveller.front) <
               kAsks;
  }
  /// Does it halt so for one that has waited for long? Not if it has waited for some time itself.
  bool halts_for_long_wait(const ConflictZone& zone, const Approach& foe) const {
    constexpr double kOwnWait = 10.0;  // [s]
    return traffic.waiting_time[traveller.row] < kOwnWait && halts_at_ease_for(zone, foe);
  }
  bool past_line(const ConflictZone& zone) const {
    // who goes at red waits before the junction, not on it; who rolls out beyond its place there
    // has come to rest at it all the same, as long as it isn't in the zone
    const WaitingPlace place = waiting_place(link, zone.begin);
    if (at_red || !place.inside) return traveller.front > link.stop_line + kEdge;
    return traveller.front > place.along + kMargin + kEdge;
  }
  /// Can a foe still halt at ease before the zone?
  bool foe_may_halt(const ConflictZone& zone, const Approach& foe) const {
    return stops_at_ease(foe.speed, zone.foe_begin - foe.front,
                         type_of(model.types, scene.type[foe.row]));
  }
  /// Is a foe past the place where it would wait for the traveller, and before the zone no more?
  bool is_committed(const ConflictZone& zone, const Approach& foe) const {
    const auto& links = road.path(scene.path[foe.row])->links;
    const auto its = std::find_if(links.begin(), links.end(), [&](const PathLink& candidate) {
      return candidate.connection == zone.foe;
    });
    if (its == links.end()) return true;
    return foe.front > waiting_place(*its, zone.foe_begin).along - its->stop_line + 0.3 &&
           !foe_may_halt(zone, foe);
  }
  /// Is some of the traveller's body on a junction, this one or one before?
  bool on_junction() const {
    const Path& path = *road.path(scene.path[traveller.row]);
    const auto first = path.link_from(traveller.front - traveller.length);
    return first != path.links.end() && first->stop_line + 0.3 < traveller.front;
  }
  /// Have both stood on the junction for long, or for some seconds in a ring of those who wait for
  /// one another? Conflict zones are wider than bodies: whoever isn't waited for by rule alone
  /// tries.
  bool in_deadlock(const Approach& foe) const {
    constexpr double kLong = 8.0, kInRing = 3.0;  // [s]
    const double both =
        std::min(traffic.waiting_time[traveller.row], traffic.waiting_time[foe.row]);
    if (!on_junction() || both < kInRing) return false;
    if (both < kLong && !waits_for_itself(scene, approaches, traveller.row)) return false;
    const LimitReason reason = approaches.waiting(foe.row).reason;
    const bool yields = reason == LimitReason::Yield || reason == LimitReason::Crossing;
    // who isn't held by a rule and moves has begun to try
    return yields ? has_waited_longer(*this, traveller.row, foe.row) : foe.speed < kCreeps;
  }
  /// Is a foe on its way out of where it was stuck between bodies, step by step?
  bool creeps_out(const Approach& foe) const {
    constexpr double kLong = 8.0;  // [s]
    return is_wedged(scene, foe.row) && foe.speed < kCrawl && traffic.waiting_time[foe.row] > kLong;
  }
  /// Does a foe creep up to somebody who stands before the zone? Who has waited for some time
  /// crosses such a queue before it, too, not only where it happens to stand.
  bool ends_in_queue(const ConflictZone& zone, const Approach& foe) const {
    constexpr double kSomeTime = 15.0;  // [s]
    constexpr double kStands = 0.3;     // [m/s]
    const Connection& foe_link = model.road.connection(zone.foe);
    if (joins_our_lane(foe_link) || foe_link.signal != kNoSignal ||
        traffic.waiting_time[traveller.row] <= kSomeTime)
      return false;
    const Waiting& waiting = approaches.waiting(foe.row);
    if (waiting.reason != LimitReason::Leader) return false;
    const std::size_t leader = find_foe(scene, waiting.foe);
    if (leader == scene.size() || scene.speed[leader] > kStands) return false;
    const Vec2 forward = direction_of(scene.heading[foe.row]);
    const double gap = (scene.position[leader] - scene.position[foe.row]).norm() -
                       0.5 * foe.length - half_extent(scene, leader, forward);
    return foe.front + gap - type_of(model.types, scene.type[foe.row]).min_gap < zone.foe_begin;
  }
  /// Will a foe, as things are, come to rest in the zone?
  bool rests_in(const ConflictZone& zone, const Approach& foe) const {
    const double rest = approaches.rest_of(foe);
    return rest > zone.foe_begin + 0.3 && rest - foe.length < zone.foe_end;
  }
  /// Is a foe that has to yield past its line already and, as things are, on its way into the zone?
  /// Whoever sees that brakes at ease now, not hard once it is there.
  bool comes_out(const ConflictZone& zone, const Approach& foe, const Occupation& theirs) const {
    constexpr double kPast = 0.5;  // [m]
    constexpr double kSoon = 4.0;  // [s]
    return foe.front > kPast && !foe.stands && approaches.rest_of(foe) > zone.foe_begin &&
           theirs.begin < kSoon && !on_foot(traveller.row) && !on_foot(foe.row);
  }
  bool joins_our_lane(const Connection& foe_link) const {
    return foe_link.to == model.road.connection(link.connection).to;
  }
  double to_line() const { return link.stop_line - traveller.front; }
  /// From 0 to 1 while the traveller waits.
  double impatience() const {
    return std::min(traffic.waiting_time[traveller.row] / kLongWait, 1.0);
  }
  /// Does the traveller still wait to join a lane on which the foe comes without having to halt?
  bool turns_in(const ConflictZone& zone, const Connection& foe_link) const {
    const bool halts_first = foe_link.state == 's' || foe_link.state == 'w';
    return joins_our_lane(foe_link) && !halts_first && !past_line(zone);
  }
  /// Of who comes along the lane that the link leads into, if the traveller goes first [m/s^2].
  double braking_asked_of(const ConflictZone& zone, const Approach& foe) const {
    const double merged = link.stop_line + zone.end;
    const double foe_front = scene.path_along[foe.row] + 0.5 * foe.length;
    const Merging entrant{type_of(model.types, scene.type[traveller.row]),
                          *road.path(scene.path[traveller.row]),
                          traveller.front,
                          traveller.length,
                          traveller.speed,
                          scene.preferred_speed[traveller.row],
                          merged};
    const Merging oncomer{type_of(model.types, scene.type[foe.row]),
                          *road.path(scene.path[foe.row]),
                          foe_front,
                          foe.length,
                          foe.speed,
                          scene.preferred_speed[foe.row],
                          foe_front + zone.foe_end - foe.front};
    return braking_asked(entrant, link.stop_line + zone.begin, oncomer);
  }
  /// Have both to give way to others here, with no signal between them? Then who has begun to cross
  /// finishes, whoever of the two would go first at the line: nobody is caught on the junction.
  bool on_equal_footing(const Connection& foe_link) const {
    const Connection& own = model.road.connection(link.connection);
    auto minor = [&](const Connection& c) {
      return (c.state == 'm' || c.state == 's' || c.state == '=') && road.signal(c) == 'O' &&
             model.road.lane(c.to).kind != LaneKind::Crossing;
    };
    return minor(own) && minor(foe_link);
  }
  /// Is a vehicle past the line of a link that is red by now, or, for some time after the lights
  /// changed, between the lines of an outer and an inner signal?
  bool clears_junction(std::size_t row, ConnectionId id, double past) const {
    const Connection& connection = model.road.connection(id);
    const bool past_lines =
        past > kEdge || (past > kEdge - connection.storage &&
                         scene.time - signal_since(road, connection, scene.time) < kLetsClear);
    return past_lines && is_red(road.signal(connection)) && !on_foot(row);
  }
  /// Since when the traveller's signal shows what it shows [s].
  double lights_since() const {
    return signal_since(road, model.road.connection(link.connection), scene.time);
  }
  static bool has_begun(double past, double speed) { return past > 0.3 && speed > 0.5; }
  static bool may_wait(double past, double speed, const AgentType& type) {
    return past < 0.0 && stops_at_ease(speed, -past, type);
  }
  static Verdict blocks_if(bool blocks) { return blocks ? Verdict::Blocks : Verdict::Free; }
  Verdict waiting_verdict(const Approach& foe) const {
    return waits_behind(foe) ? Verdict::Held : Verdict::Blocks;
  }
};

enum class SignalDuty {
  None,
  Stop,
  GoAtRed,  ///< a red light is a stop sign to this traveller, and everybody else comes first
};

/// What a link's signal shows, since when and, where that is amber, until when [s].
struct Aspect {
  char letter = 'O';
  double since = 0, until = 0;
};

/// Does somebody who stood near its line for a gap before amber began, `since` [s], take the one
/// that amber makes, as it gets over the line from rest in the time `left` [s]?
bool takes_gap(const TrafficView& view, const Traveller& traveller, const PathLink& link,
               const AgentType& type, double since, double left) {
  const double to_line = link.stop_line - traveller.front;
  return to_line < kNearLine && view.traffic.halted_for[traveller.row] == link.connection &&
         view.traffic.halted_at[traveller.row] < since &&
         time_to_cover(to_line, 0.0, type.max_speed, type.max_acceleration) < left;
}

/// Red stops always, amber where braking at ease still does it, for a front that would come to rest
/// at `halt`, where the line is drawn at `drawn` [m]. Once past the line, clear the junction.
SignalDuty signal_duty(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                       const Aspect& aspect, double halt, double drawn) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const char signal = aspect.letter;
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  const double to_line = link.stop_line - traveller.front;
  // on foot one halts within a step, though it be with a foot on the crossing
  const double reserve = on_foot ? -0.45 : 0.2;  // [m]
  const double needed = deceleration_to_stop(traveller.speed, halt - traveller.front - reserve);
  // nobody halts for amber amid a junction
  if (is_amber(signal) && model.road.connection(link.connection).storage > 0.0)
    return SignalDuty::None;
  if (is_amber(signal) && to_line > -1.0) {
    // who might not be over the line before red brakes harder than at ease, who surely won't as
    // hard as its body can, and stands before it from a crawl, however near it is
    constexpr double kHardest = 0.95;
    const double really_left = aspect.until - scene.time;
    const double left = std::min(kAmber - (scene.time - aspect.since), really_left);
    const bool late = to_line > std::max(left, 0.0) * traveller.speed;
    const bool too_late = to_line > std::max(really_left, 0.0) * traveller.speed;
    const double most = too_late ? kHardest * type.max_deceleration
                        : late   ? 0.65 * type.max_deceleration
                                 : type.comfortable_deceleration;
    if (!on_foot && takes_gap(view, traveller, link, type, aspect.since, left))
      return SignalDuty::None;
    const bool stands = late && traveller.speed < kCrawl;
    // who gets over in time doesn't halt where others need the room
    if (!late && !on_foot && !stops_at_ease(traveller.speed, drawn - traveller.front, type))
      return SignalDuty::None;
    return needed < most || stands ? SignalDuty::Stop : SignalDuty::None;
  }
  if (!is_red(signal)) return SignalDuty::None;
  constexpr double kStep = 0.5;  // on foot, which is taken back [m]
  const bool steps_back = on_foot && to_line > -kStep;
  const bool can_stop =
      to_line > -1.0 && (steps_back || needed < type.max_deceleration || traveller.speed < kCrawl);
  const bool has_halted = traffic.halted_for[traveller.row] == link.connection;
  if ((can_stop || has_halted || on_foot) &&
      goes_at_red(model, scene, traveller.row, link.connection))
    return SignalDuty::GoAtRed;
  return can_stop ? SignalDuty::Stop : SignalDuty::None;
}

/// Is somebody in a zone of a foe's link, or will be soon?
bool comes_soon(const ConflictZone& zone, const Approach& foe) {
  constexpr double kSoon = 6.0;    // [s]
  constexpr double kDrives = 8.0;  // who has set out gets as fast as this [m/s]
  if (foe.front - foe.length > zone.foe_end) return false;
  return foe.front > 0.0 ||
         (!foe.stands && zone.foe_begin - foe.front < kSoon * std::max(foe.speed, kDrives));
}

/// Who has to wait on a junction waits where it stands in nobody's way: not with its body in a zone
/// that somebody else is about to need, but before it, unless it is in there already.
void keep_zones_free(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                     LinkDecision& decision) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const ApproachTable& approaches = view.approaches;
  const Path& path = *road.path(scene.path[traveller.row]);
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const bool wide = is_wide(scene, traveller.row);
  for (bool again = true; again;) {
    again = false;
    for (const ConflictZone& zone : model.conflicts[index_of(link.connection)]) {
      if (runs_together(model, link.connection, zone.foe)) continue;
      for (const Approach& foe : approaches.of(zone.foe)) {
        if (foe.row == traveller.row) continue;
        const auto theirs = zone_for(zone, wide || foe.wide);
        if (!theirs || !comes_soon(*theirs, foe)) continue;
        const Piece piece = as_travelled(path, link.stop_line, theirs->begin, theirs->end);
        const double begin = link.stop_line + piece.begin, end = link.stop_line + piece.end;
        const double line = std::max(begin, link.stop_line) - kStopMargin;
        if (decision.stop_at <= begin || decision.stop_at - traveller.length >= end) continue;
        if (line >= decision.stop_at || line < traveller.front) continue;
        if (deceleration_to_stop(traveller.speed, line - traveller.front) >
            type.comfortable_deceleration)
          continue;
        decision.stop_at = line;
        again = true;
      }
    }
  }
}

}  // namespace

LinkDecision decide_link(const TrafficView& view, const Traveller& traveller,
                         const PathLink& link) {
  const auto& [model, road, scene, traffic, grid, approaches] = view;
  const Connection& connection = model.road.connection(link.connection);
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const char signal = road.signal(connection);
  const Path& own_path = *road.path(scene.path[traveller.row]);
  const double to_line = link.stop_line - traveller.front;
  // where a front that waits comes to rest: short of the line where others turn by close, at the
  // line where it has come too far or is too fast for that
  const bool stops_short = traveller.front < link.halt &&
                           stops_at_ease(traveller.speed, link.halt - traveller.front, type);
  const double halt = stops_short ? link.halt : link.stop_line;
  const double stop_at = halt - kStopMargin;
  LinkDecision decision;
  const SignalDuty duty = signal_duty(
      view, traveller, link,
      {signal, signal_since(road, connection, scene.time), amber_until(road, connection)}, halt,
      is_amber(signal) ? drawn_line(view, traveller, link) : halt);
  if (duty == SignalDuty::Stop) return {true, stop_at, LimitReason::Signal, -1};
  const bool at_red = duty == SignalDuty::GoAtRed;
  const bool stop_sign = (connection.state == 's' || connection.state == 'w') && signal == 'O';
  const bool halts_first = stop_sign || (at_red && !own_path.walking && connection.storage == 0.0);
  if (halts_first && to_line > -0.2 &&
      traffic.halted_for[traveller.row] !=
          halt_counts_for(model.road, own_path, link, traveller.length))
    decision = {true, stop_at, at_red ? LimitReason::Signal : LimitReason::Yield, -1};

  const bool free_green = signal == 'G';
  const bool wide = is_wide(scene, traveller.row);
  const Judge judge{view, traveller, link, at_red};
  for (ConflictZone zone_of_table : model.conflicts[index_of(link.connection)]) {
    if (runs_together(model, link.connection, zone_of_table.foe)) continue;
    if (free_green) zone_of_table.yields = false;
    // at red everybody else comes first
    if (at_red) {
      zone_of_table.yields = true;
      zone_of_table.unruled = false;
    }
    for (const Approach& foe : approaches.of(zone_of_table.foe)) {
      const auto for_both = zone_for(zone_of_table, wide || foe.wide);
      if (!for_both) continue;
      ConflictZone zone = *for_both;
      const Piece ours_to_cover = as_travelled(own_path, link.stop_line, zone.begin, zone.end);
      zone.begin = ours_to_cover.begin;
      zone.end = ours_to_cover.end;
      // already in it: go on, avoidance does the rest
      if (has_entered(-to_line, zone.begin)) continue;
      // at its edge one goes past who stands, on wheels where there is room for that
      const bool at_edge = to_line + zone.begin < kEdge;
      if (at_edge && foe.stands &&
          (own_path.walking || stands_beside(view, traveller, link, zone.begin, zone.end, foe)))
        continue;
      const Verdict verdict = judge.of(zone, foe);
      // who comes behind a vehicle that lets us go can't get past it
      if (verdict == Verdict::Held && type_of(model.types, scene.type[foe.row]).width > kFillsLane)
        break;
      if (verdict != Verdict::Blocks) continue;
      // wait at the line; inside the junction where there is a place for that, or where the own
      // body is past the line already
      const WaitingPlace place = waiting_place(link, zone.begin);
      const bool has_place =
          place.inside && !at_red &&
          (connection.signal != kNoSignal || !is_aside_for(foe, traffic, traveller.row));
      double line = has_place && traveller.front < place.along + 0.3 ? place.along
                    : to_line > -0.2                                 ? stop_at
                                     : link.stop_line + zone.begin - kStopMargin;
      // on foot one halts at the kerb still
      const double last = own_path.walking ? std::max(line, link.stop_line) : line;
      const double hardest = 0.8 * type.max_deceleration;
      if (deceleration_to_stop(traveller.speed, last - traveller.front) > hardest &&
          traveller.speed > 1.0) {
        // too late to halt there, but not for driving on towards who is in the way already
        if (own_path.walking || !has_entered(foe.front, zone.foe_begin)) continue;
        line = traveller.front + traveller.speed * traveller.speed / (2.0 * hardest);
      }
      if (!decision.must_stop || line < decision.stop_at)
        decision = {true, line, zone.foe_is_crossing ? LimitReason::Crossing : LimitReason::Yield,
                    static_cast<std::int64_t>(scene.id[foe.row].value)};
    }
  }
  if (decision.must_stop && decision.stop_at > link.stop_line &&
      traffic.waiting_time[traveller.row] < kKeepsZonesFree)
    keep_zones_free(view, traveller, link, decision);
  return decision;
}

bool stands_beside(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                   double begin, double end, const Approach& foe) {
  constexpr double kSide = 0.25, kStep = 0.5;  // [m]
  const Scene& scene = view.scene;
  const std::size_t row = traveller.row;
  const Polyline& way = view.road.path(scene.path[row])->line;
  const OrientedBox body = box_of(scene, foe.row);
  Vec2 half = box_of(scene, row).half;
  // on foot one steps back from a body that swings
  if (type_of(view.model.types, scene.type[foe.row]).kinematics == Kinematics::Holonomic)
    half.x() = 0.0;
  // the middle follows the way, the rear axle the middle: in a bend the nose swings out
  const double axle = type_of(view.model.types, scene.type[row]).rear_axle_to_center;
  double along = scene.path_along[row];
  double heading = scene.heading[row];
  const double settles = link.stop_line + begin - 2.0 * traveller.length;
  if (along < settles) {
    along = settles;
    heading = heading_of(way.direction_at(settles));
  }
  for (; along <= link.stop_line + end; along += kStep) {
    const Vec2 forward = direction_of(heading);
    if (along >= link.stop_line + begin &&
        separation({way.point_at(along), forward, half}, body) < kSide)
      return false;
    heading += kStep * cross(forward, way.direction_at(along)) / std::max(axle, kStep);
  }
  return true;
}

bool runs_together(const Model& model, ConnectionId a, ConnectionId b) {
  const Connection &own = model.road.connection(a), &other = model.road.connection(b);
  return own.to == other.to && own.from != other.from &&
         model.road.lane(own.from).edge == model.road.lane(other.from).edge;
}

bool has_crossing_traffic(const Model& model, ConnectionId link) {
  const auto& zones = model.conflicts[index_of(link)];
  return std::any_of(zones.begin(), zones.end(), [&](const ConflictZone& zone) {
    return !runs_together(model, link, zone.foe);
  });
}

ZipperLeader find_zipper_leader(const TrafficView& view, const Traveller& traveller,
                                const PathLink& link) {
  const auto& [model, road, scene, traffic, grid, approaches] = view;
  ZipperLeader leader;
  for (const ConflictZone& zone : model.conflicts[index_of(link.connection)]) {
    if (!runs_together(model, link.connection, zone.foe)) continue;
    const double own_way = link.stop_line + zone.end - traveller.front;
    if (own_way < 0.0) continue;
    for (const Approach& foe : approaches.of(zone.foe)) {
      const double their_way = zone.foe_end - foe.front;
      if (foe.row == traveller.row || their_way < -foe.length) continue;
      const bool first = their_way < own_way ||
                         (their_way == own_way && scene.id[foe.row] < scene.id[traveller.row]);
      if (!first) continue;
      const double gap = own_way - their_way - foe.length;
      if (leader.id < 0 || gap < leader.gap)
        leader = {gap, foe.speed, static_cast<std::int64_t>(scene.id[foe.row].value)};
    }
  }
  return leader;
}

}  // namespace sumogamma
