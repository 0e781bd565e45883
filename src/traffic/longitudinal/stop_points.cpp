#include "traffic/longitudinal/stop_points.h"

#include <algorithm>
#include <cmath>

#include "scene/locate.h"
#include "traffic/junction/keep_clear.h"
#include "traffic/junction/turning_room.h"
#include "traffic/lateral/passing.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

double looked_at(const Driver& driver) {
  return driver.view.scene.held[driver.course.row].standing > 0.0
             ? driver.view.parameters.queue_outlook
             : driver.reach;
}

/// A halt `way` [m] ahead: the front comes to rest there.
StopPoint halt_in(double way, const AgentType& type, LimitReason reason, std::int64_t foe = -1) {
  StopPoint point;
  point.gap = way + type.min_gap;
  point.reason = reason;
  point.foe = foe;
  return point;
}

void follow_leader(const Driver& driver, StopPoints& found) {
  const Course& course = driver.course;
  const Leader leader = find_leader(driver.view, course.row, driver.reach, found.ahead);
  if (leader.id < 0) return;
  found.points.push_back({leader.gap, leader.speed, course.headway_factor, StopPoint{}.most_braking,
                          LimitReason::Leader, leader.id, leader.acceleration});
}

/// Cooperative lane changing: who waits for a gap gets one where that is easy, who is on its way
/// gets it anyhow.
void let_merge(const Driver& driver, StopPoints& found) {
  const DrivingAhead::Vehicle& merging = found.ahead.merging;
  if (merging.id < 0) return;
  StopPoint point{merging.rear - driver.front, merging.speed,       driver.course.headway_factor,
                  StopPoint{}.most_braking,    LimitReason::Leader, merging.id};
  if (acceleration_behind(driver, point) <= -driver.view.parameters.courtesy_braking &&
      !found.ahead.on_its_way)
    return;
  point.most_braking = driver.view.parameters.courtesy_braking;
  found.points.push_back(point);
}

/// Stop lines of neighbouring lanes need not be level: who reaches over the edge of its lane halts
/// a little before its own [m].
double beside_lane(const TrafficView& view, const Course& course) {
  const Lane& lane = view.model.road.lane(course.path.stretch_at(course.along).lane);
  const bool beside = lane.kind == LaneKind::Normal &&
                      std::abs(course.offset) + 0.5 * course.type.width > 0.5 * lane.width;
  return beside ? view.parameters.stop_margin : 0.0;
}

/// Who rides wholly in the lane beside its own, past a queue, drives over that lane's line: at red
/// it halts there, though its own lane be free to go.
LinkDecision decide_beside(const TrafficView& view, const Course& course,
                           const Traveller& traveller, const PathLink& link) {
  const RoadNetwork& network = view.model.road;
  const LaneId own = course.path.stretch_at(course.along).lane;
  const Lane& lane = network.lane(own);
  const double over = std::abs(course.offset) - 0.5 * course.type.width - 0.5 * lane.width;
  if (over < 0.0 || network.connection(link.connection).from != own) return {};
  const LaneId beside = lane_beside(network, lane, course.offset);
  if (beside == kNoLane || network.lane(beside).outgoing.empty()) return {};
  const auto& links = network.lane(beside).outgoing;
  const bool red = std::all_of(links.begin(), links.end(), [&](ConnectionId id) {
    return is_red(view.road.signal(network.connection(id)));
  });
  const double left = link.halt - traveller.front;
  if (!red || left < -1.0 || goes_at_red(view, course.row, link.connection) ||
      deceleration_to_stop(traveller.speed, left) > course.type.max_deceleration)
    return {};
  return {true, link.halt - view.parameters.stop_margin, LimitReason::Signal, -1};
}

/// Zipper merge: who is nearer to the end of the common ground is followed. Closer than later on:
/// the gap opens while lanes run together.
void follow_teeth(const Driver& driver, const PathLink& link, StopPoints& found) {
  const AgentType& type = driver.course.type;
  const ZipperLeader teeth = find_zipper_leader(driver.view, driver.traveller, link);
  if (teeth.id < 0) return;
  const double headway = driver.course.headway_factor * kept_headway(type, driver.course.speed);
  const double gap = std::max(teeth.gap, 0.3) + 0.6 * headway * driver.course.speed;
  found.points.push_back({gap, teeth.speed, driver.course.headway_factor,
                          type.comfortable_deceleration, LimitReason::Leader, teeth.id});
}

/// What signals and right of way say of a link.
LinkDecision go_by_law(const Driver& driver, const PathLink& link) {
  const Traveller& traveller = driver.traveller;
  const LinkDecision decision = decide_link(driver.view, traveller, link);
  if (decision.must_stop || traveller.front <= driver.front) return decision;
  // who gets over the edge of its lane just before its line isn't too near to halt for that
  if (link.stop_line > driver.front) {
    const Traveller own{traveller.row, driver.front, traveller.length, traveller.speed};
    const LinkDecision held = decide_link(driver.view, own, link);
    if (held.must_stop && held.reason == LimitReason::Signal) return held;
  }
  return decide_beside(driver.view, driver.course, traveller, link);
}

/// Signals and right of way, room behind the junction, room for others to turn, cooperative
/// yielding: whether and where to halt before a link.
LinkDecision halt_before(const Driver& driver, const PathLink& link, StopPoints& found,
                         bool first) {
  const TrafficView& view = driver.view;
  const Course& course = driver.course;
  const Traveller& traveller = driver.traveller;
  LinkDecision decision = go_by_law(driver, link);
  if (first) found.at_red = decision.must_stop && decision.reason == LimitReason::Signal;
  if (!decision.must_stop) decision = keep_clear(view, course, traveller, link, found.ahead);
  // who may go on to a place on the junction leaves room before it all the same
  if (!takes_turning_room(view, course, link)) {
    const LinkDecision room = leave_turning_room(view, traveller, link);
    if (room.must_stop && (!decision.must_stop || room.stop_at < decision.stop_at)) decision = room;
  }
  return decision.must_stop ? decision : let_one_in(view, course, traveller, link);
}

/// The links ahead, up to the first at which it has to halt.
void obey_links(const Driver& driver, StopPoints& found) {
  const Course& course = driver.course;
  bool first = true;
  for (PathLink link : course.path.links) {
    if (link.end < course.along - course.half_length) continue;
    if (link.stop_line > driver.front + looked_at(driver)) break;
    link.halt = halt_for_long_bodies(driver.view, driver.traveller, link);
    follow_teeth(driver, link, found);
    const LinkDecision decision = halt_before(driver, link, found, first);
    first = false;
    if (!decision.must_stop) continue;
    const double way = decision.stop_at - driver.traveller.front;
    StopPoint point = halt_in(way, course.type, decision.reason, decision.foe);
    found.to_halt = std::max(way, 0.0);
    // a junction is kept clear at ease or not at all
    if (decision.reason == LimitReason::BlockedJunction)
      point.most_braking = driver.view.parameters.slack * course.type.comfortable_deceleration;
    found.points.push_back(point);
    break;
  }
}

/// Whose trip ends where long bodies sweep the lane's end leaves them room.
void leave_room_behind(const Driver& driver, StopPoints& found) {
  const Course& course = driver.course;
  if (course.path.arrival >= driver.front + looked_at(driver)) return;
  const LinkDecision room = leave_room_at_end(driver.view, course, driver.traveller);
  if (room.must_stop)
    found.points.push_back(
        halt_in(room.stop_at - driver.traveller.front, course.type, room.reason, room.foe));
}

/// Some way before its gate: who rolls over it by a hair begins its change, whoever is beside.
void wait_at_gate(const Driver& driver, StopPoints& found) {
  const double gate = driver.view.traffic.gate[driver.course.row];
  if (!std::isfinite(gate)) return;
  const double way = gate - driver.view.parameters.line_tolerance - driver.course.along;
  found.points.push_back(halt_in(way, driver.course.type, LimitReason::Merge));
}

/// Planned halts: stands for the stop's duration with the front at its end.
void serve_stop(const Driver& driver, StopPoints& found) {
  const Course& course = driver.course;
  const PathStop* stop = next_stop(course.path, driver.view.scene, course.row);
  if (stop == nullptr) return;
  const double way = stop->along - course.along - course.half_length;
  found.points.push_back(halt_in(way, course.type, LimitReason::Stop));
}

using Rule = void (*)(const Driver&, StopPoints&);
constexpr Rule kDriving[] = {follow_leader,     let_merge,    obey_links,
                             leave_room_behind, wait_at_gate, serve_stop};

}  // namespace

double driver_reach(const AgentType& type, double speed) {
  const double braking = speed * speed / (2.0 * type.comfortable_deceleration);
  return std::min(40.0 + 2.5 * speed + braking, 250.0);
}

Driver driver_of(const TrafficView& view, const Course& course, double free_speed) {
  const double front = course.along + course.half_length;
  return {view,
          course,
          front,
          {course.row, front + beside_lane(view, course), 2.0 * course.half_length, course.speed},
          free_speed,
          driver_reach(course.type, course.speed)};
}

double acceleration_behind(const Driver& driver, const StopPoint& point) {
  const Course& course = driver.course;
  const double acceleration =
      point.acceleration
          ? behind_acceleration(course.type, course.speed, driver.free_speed,
                                {point.gap, point.speed, *point.acceleration}, point.headway_factor)
          : following_acceleration(course.type, course.speed, driver.free_speed, point.gap,
                                   point.speed, point.headway_factor);
  return std::max(acceleration, -point.most_braking);
}

void find_stop_points(const Driver& driver, StopPoints& found) {
  found.points.clear();
  found.ahead = {};
  found.to_halt = std::numeric_limits<double>::infinity();
  found.at_red = false;
  for (const Rule rule : kDriving) rule(driver, found);
}

}  // namespace sumogamma
