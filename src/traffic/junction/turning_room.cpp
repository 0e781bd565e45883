#include "traffic/junction/turning_room.h"

#include <algorithm>

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

/// See leave_turning_room; of somebody whose trip `ends` at the line, who is gone from there on.
LinkDecision leave_room(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                        bool ends) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const ApproachTable& approaches = view.approaches;
  LinkDecision decision;
  const AgentType& type = type_of(model.types, scene.type[traveller.row]);
  const double front = traveller.front - link.stop_line;
  for (const SweptWay& way : model.swept_ways[index_of(link.connection)]) {
    if (ends && (!way.foe_sweeps || way.begin >= 0.0)) continue;
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
    const Occupation ours = occupation(view, approach_of(traveller, link), way.begin,
                                       ends ? -traveller.length : way.end);
    for (const Approach& foe : approaches.of(way.foe)) {
      if (foe.row == traveller.row || (way.foe_sweeps && turning_body(foe.length) != way.body))
        continue;
      if (foe.front - foe.length >= way.foe_end) continue;
      if (!is_for(way, scene, way.foe_sweeps ? traveller.row : foe.row)) continue;
      // it waits before its line, or before the place that is swept; whom bodies hold isn't coming;
      // who waits there with its body off the way can be passed
      const bool there = foe.front > way.foe_begin;
      const bool is_owed = way.foe_sweeps && foe.stands && has_long_wanted(view, foe, there);
      if (foe.stands && !is_owed &&
          (!there || approaches.waiting(foe.row).blocked ||
           (traveller.length <= kLongBody &&
            stands_beside(view, traveller, link, way.begin, way.end, foe))))
        continue;
      Occupation theirs = occupation(view, foe, way.foe_begin, way.foe_end);
      // who waits there for something doesn't leave by itself
      if (there && approaches.rest_of(foe) - foe.length < way.foe_end)
        theirs.end = Occupation::kNever;
      // a long body on its way doesn't reckon with who stands. Not the other way round: where one
      // comes after the other, it would stand for ever
      const bool goes_on =
          way.foe_sweeps && traveller.speed < view.parameters.halting_speed && !foe.stands;
      // nor does who is near the place and drives halt before it
      const bool drives_in = !way.foe_sweeps && !foe.stands && !halts_before(view, foe, way);
      const bool smaller_id = scene.id[foe.row] < scene.id[traveller.row];
      if (!is_owed &&
          !comes_first(view.parameters, theirs, ours, there || goes_on || drives_in, smaller_id))
        continue;
      decision = {true, line, LimitReason::TurningRoom,
                  static_cast<std::int64_t>(scene.id[foe.row].value)};
      break;
    }
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
  return leave_room(view, traveller, link, false);
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
    const LinkDecision room = leave_room(view, traveller, end, true);
    if (room.must_stop && (!decision.must_stop || room.stop_at < decision.stop_at)) decision = room;
  }
  return decision;
}

}  // namespace sumogamma
