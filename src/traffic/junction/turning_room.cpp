#include "traffic/junction/turning_room.h"

#include <algorithm>
#include <optional>

#include "scene/storey.h"
#include "traffic/junction/keep_clear.h"
#include "traffic/junction/occupation.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// Is it about who has the width of a row that a way tells?
bool is_for(const SweptWay& way, const Scene& scene, std::size_t row) {
  return way.for_wide == is_wide(scene, row);
}

/// Is the line of a link drawn before what is swept there?
bool moves_line(const TrafficView& view, const PathLink& link, const SweptWay& way) {
  return way.begin > -view.parameters.soon_way &&
         view.model.road.connection(link.connection).signal != kNoSignal;
}

/// Does a foe get there first where the two would be in each other's way?
bool comes_first(const TrafficParameters& parameters, const Occupation& theirs,
                 const Occupation& ours, bool surely, bool smaller_id) {
  if (ours.begin > theirs.end + parameters.reaction_time ||
      theirs.begin > ours.end + parameters.reaction_time)
    return false;
  return surely || theirs.begin < ours.begin || (theirs.begin == ours.begin && smaller_id);
}

/// Does somebody halt at ease before its piece of a way?
bool halts_before(const TrafficView& view, const Approach& foe, const SweptWay& way) {
  const AgentType& type = type_of(view.model.types, view.scene.type[foe.row]);
  return deceleration_to_stop(foe.speed, way.foe_begin - foe.front) < type.comfortable_deceleration;
}

/// Has a long body waited for long for those who come through the room that it needs, before that
/// place or amid it, held by bodies? On the junction, where others wait for it, it soon has, and
/// the time counts in which it backed out before somebody. A queue that creeps on is never over.
bool has_long_wanted(const TrafficView& view, const Approach& foe, bool there) {
  const Waiting& waiting = view.approaches.waiting(foe.row);
  if (there && waiting.blocked) return waited(view, foe.row) >= Patience::Pressing;
  if (foe.front <= 0.0)
    return waiting.reason == LimitReason::TurningRoom && stood(view, foe.row) >= Patience::Pressing;
  return waited(view, foe.row) >= Patience::Waiting &&
         (waiting.reason == LimitReason::TurningRoom || waiting.reason == LimitReason::GivesWay);
}

/// Who may have to leave room before a link, and whether its trip `ends` at the line: it is gone
/// from there on.
struct Leaver {
  const TrafficView& view;
  const Traveller& traveller;
  const PathLink& link;
  bool ends;
};

/// Is the room of a way a foe's? `ours` is worked out where it is asked for: to most ways nobody
/// comes.
bool is_taken(const Leaver& own, const SweptWay& way, const Approach& foe,
              std::optional<Occupation>& ours) {
  const TrafficView& view = own.view;
  const Traveller& traveller = own.traveller;
  if (foe.row == traveller.row || (way.foe_sweeps && turning_body(foe.length) != way.body))
    return false;
  if (foe.front - foe.length >= way.foe_end) return false;
  if (!is_for(way, view.scene, way.foe_sweeps ? traveller.row : foe.row)) return false;
  // it waits before its line, or before the place that is swept; whom bodies hold isn't coming; who
  // waits there with its body off the way can be passed
  const bool there = foe.front > way.foe_begin;
  if (way.foe_sweeps && foe.stands && has_long_wanted(view, foe, there)) return true;
  if (foe.stands && (!there || view.approaches.waiting(foe.row).blocked ||
                     (traveller.length <= kLongBody &&
                      stands_beside(view, traveller, own.link, way.begin, way.end, foe))))
    return false;
  Occupation theirs = occupation(view, foe, way.foe_begin, way.foe_end);
  // who waits there for something doesn't leave by itself
  if (there && view.approaches.rest_of(foe) - foe.length < way.foe_end)
    theirs.end = Occupation::kNever;
  if (!ours)
    ours = occupation(view, approach_of(traveller, own.link), way.begin,
                      own.ends ? -traveller.length : way.end);
  // a long body on its way doesn't reckon with who stands. Not the other way round: where one comes
  // after the other, it would stand for ever
  const bool goes_on =
      way.foe_sweeps && traveller.speed < view.parameters.halting_speed && !foe.stands;
  // nor does who is near the place and drives halt before it
  const bool drives_in = !way.foe_sweeps && !foe.stands && !halts_before(view, foe, way);
  const bool smaller_id = view.scene.id[foe.row] < view.scene.id[traveller.row];
  return comes_first(view.parameters, theirs, *ours, there || goes_on || drives_in, smaller_id);
}

/// See leave_turning_room.
LinkDecision leave_room(const Leaver& own) {
  const TrafficView& view = own.view;
  const Traveller& traveller = own.traveller;
  const PathLink& link = own.link;
  LinkDecision decision;
  const AgentType& type = type_of(view.model.types, view.scene.type[traveller.row]);
  const double front = traveller.front - link.stop_line;
  for (const SweptWay& way : view.model.swept_ways[index_of(link.connection)]) {
    if (own.ends && (!way.foe_sweeps || way.begin >= 0.0)) continue;
    // who is on its way goes on, a long body where it is in nobody's way yet may still halt
    const bool before_line = !way.foe_sweeps && front <= 0.2;
    const bool may_halt = before_line || front <= way.begin;
    if (!may_halt || (!way.foe_sweeps && turning_body(traveller.length) != way.body)) continue;
    const double line =
        (before_line ? std::min(link.halt, link.stop_line) : link.stop_line + way.begin) -
        view.parameters.stop_margin;
    // who rolls out a little beyond its place has halted there all the same
    const bool too_late =
        traveller.speed > 1.0 &&
        deceleration_to_stop(traveller.speed, line + view.parameters.stop_margin -
                                                  traveller.front) > 0.8 * type.max_deceleration;
    if (too_late || (decision.must_stop && line >= decision.stop_at)) continue;
    std::optional<Occupation> ours;
    const auto foes = view.approaches.of(way.foe);
    const auto foe = std::find_if(foes.begin(), foes.end(), [&](const Approach& one) {
      return is_taken(own, way, one, ours);
    });
    if (foe == foes.end()) continue;
    decision = {true, line, LimitReason::TurningRoom,
                static_cast<std::int64_t>(view.scene.id[foe->row].value)};
  }
  return decision;
}

}  // namespace

double drawn_line(const TrafficView& view, const Traveller& traveller, const PathLink& link) {
  double line = link.halt;
  for (const SweptWay& way : view.model.swept_ways[index_of(link.connection)])
    if (way.foe_sweeps && moves_line(view, link, way) && is_for(way, view.scene, traveller.row))
      line = std::min(line, link.stop_line + way.begin);
  return line;
}

double halt_for_long_bodies(const TrafficView& view, const Traveller& traveller,
                            const PathLink& link) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const ApproachTable& approaches = view.approaches;
  double halt = link.halt;
  for (const SweptWay& way : model.swept_ways[index_of(link.connection)]) {
    const double place = link.stop_line + way.begin;
    if (!way.foe_sweeps || way.begin >= 0.0 || traveller.front > place || place >= halt ||
        !is_for(way, scene, traveller.row))
      continue;
    const auto comes = [&](const Approach& foe) {
      return turning_body(foe.length) == way.body && foe.front > -view.parameters.nearby &&
             foe.front - foe.length < way.foe_end && foe.row != traveller.row &&
             !on_other_storey(view.model.road, view.scene, traveller.row, foe.row);
    };
    // who means to go at red goes up to the end of its lane
    const bool drawn =
        moves_line(view, link, way) && !goes_at_red(view, traveller.row, link.connection);
    const auto foes = approaches.of(way.foe);
    if (drawn || std::any_of(foes.begin(), foes.end(), comes)) halt = place;
  }
  return halt;
}

LinkDecision leave_turning_room(const TrafficView& view, const Traveller& traveller,
                                const PathLink& link) {
  return leave_room({view, traveller, link, false});
}

LinkDecision leave_room_at_end(const TrafficView& view, const Course& course,
                               const Traveller& traveller) {
  LinkDecision decision;
  const Path& path = course.path;
  const Lane& lane = view.model.road.lane(path.stretches.back().lane);
  const Vec2 before_end = lane.centerline.points().back() - path.line.point_at(path.arrival);
  if (before_end.norm() > view.parameters.near_line) return decision;
  for (const ConnectionId id : lane.outgoing) {
    const PathLink end{id, path.arrival, path.arrival, path.arrival};
    if (takes_turning_room(view, course, end)) continue;
    const LinkDecision room = leave_room({view, traveller, end, true});
    if (room.must_stop && (!decision.must_stop || room.stop_at < decision.stop_at)) decision = room;
  }
  return decision;
}

}  // namespace sumogamma
