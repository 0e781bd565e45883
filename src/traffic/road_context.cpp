#include "traffic/road_context.h"

#include <algorithm>

#include "scene/locate.h"
#include "traffic/junction/arbitration.h"
#include "traffic/junction/keep_clear.h"
#include "traffic/junction/turning_room.h"
#include "traffic/lateral/course.h"
#include "traffic/lateral/passing.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/leader.h"
#include "traffic/rule_breaking.h"
#include "traffic/traffic_view.h"
#include "traffic/walking/walker_limits.h"

namespace sumogamma {

namespace {

constexpr double kStart = 0.6;             // [m/s]
constexpr double kKeepsClearAtEase = 1.4;  // of the comfortable deceleration
constexpr double kCourtesy = 2.0;          // braking for somebody who has to change lanes [m/s^2]

/// Tightens the context's acceleration for something to stop for or to follow.
void limit(double acceleration, LimitReason reason, std::int64_t foe, double& binding,
           RoadContext& context) {
  if (acceleration >= binding) return;
  binding = acceleration;
  context.reason = reason;
  context.foe = foe;
}

/// Planned halts: stands for the stop's duration with the front at its end.
double stop_acceleration(const Scene& scene, const Course& course, double free_speed) {
  const auto next = static_cast<std::size_t>(scene.halt[course.row].next);
  if (next >= course.path.stops.size()) return course.type.max_acceleration;
  const double gap =
      course.path.stops[next].along - course.along - course.half_length + course.type.min_gap;
  return following_acceleration(course.type, course.speed, free_speed, gap, 0.0);
}

/// Remembers that the agent came to a halt before its next link, on the junction where it may wait
/// there, or before the link right behind it where it has priority at the next.
void note_halt(const TrafficView& view, const Course& course, TrafficState& traffic) {
  const RoadNetwork& road = view.model.road;
  const Scene& scene = view.scene;
  constexpr double kAtLine = 4.0, kHalt = 0.3;
  if (scene.held[course.row].standing < kHalt) return;
  const double front = course.along + course.half_length;
  for (const PathLink& link : course.path.links) {
    if (link.stop_line < front - 0.3 && front > link.inside + 0.3) continue;
    if (link.halt >= front + kAtLine) return;
    const Connection& connection = road.connection(link.connection);
    const ConnectionId halted_for =
        halt_counts_for(road, course.path, link, 2.0 * course.half_length);
    const bool has_priority = connection.state == 'M' && connection.signal == kNoSignal;
    if (has_priority && halted_for == link.connection) continue;
    if (traffic.halted_for[course.row] != halted_for) {
      traffic.halted_for[course.row] = halted_for;
      traffic.halted_at[course.row] = scene.time;
    }
    return;
  }
}

/// The throttle goes down at ease where the vehicle drives: a cap on the jerk that following and
/// avoidance leave, however they take turns. Brakes and the start are not eased.
double eased(const Scene& scene, const Course& course, double acceleration, double dt) {
  constexpr double kJerk = 2.4;    // [m/s^3]
  constexpr double kBraked = 0.0;  // the throttle is taken up from here at the least [m/s^2]
  constexpr double kDrives = 8.0;  // [m/s]
  if (course.speed < kDrives) return acceleration;
  const double now = scene.acceleration[course.row].dot(direction_of(scene.heading[course.row]));
  return std::min(acceleration, std::max(now, kBraked) + kJerk * dt);
}

/// The profile's speed with some time to reach it: who follows a line of short straight pieces,
/// aside of it, gets on along it by jumps.
double foreseen_limit(const Path& path, double along, double speed, double dt) {
  constexpr double kAhead = 0.4;    // [s]
  constexpr double kNearest = 0.5;  // [m]
  const double here = path.profile_at(along);
  const double way = std::max(std::max(kAhead, dt) * speed, kNearest);
  const double there = path.profile_at(along + way);
  if (there >= speed) return std::max(here, speed);
  const double braking = (speed * speed - there * there) / (2.0 * way);
  return std::max(speed - braking * dt, there);
}

/// Stop lines of neighbouring lanes need not be level: who reaches over the edge of its lane halts
/// a little before its own [m].
double beside_lane(const Model& model, const Course& course) {
  constexpr double kEarlier = 0.6;  // [m]
  const Lane& lane = model.road.lane(course.path.stretch_at(course.along).lane);
  const bool beside = lane.kind == LaneKind::Normal &&
                      std::abs(course.offset) + 0.5 * course.type.width > 0.5 * lane.width;
  return beside ? kEarlier : 0.0;
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
  if (!red || left < -1.0 || goes_at_red(view.model, view.scene, course.row, link.connection) ||
      deceleration_to_stop(traveller.speed, left) > course.type.max_deceleration)
    return {};
  return {true, link.halt - kStopMargin, LimitReason::Signal, -1};
}

/// Who has to be aside within `way` aims at a sub-goal no further ahead.
void aim_sooner(const Scene& scene, const Course& course, double way, RoadContext& context) {
  constexpr double kNearest = 1.2;   // [m]
  constexpr double kSteepest = 1.8;  // ahead for a metre aside [m]
  const Vec2 position = scene.position[course.row];
  const Vec2 goal = to_body(context.sub_goal - position, context.tangent);
  const double ahead =
      std::min(goal.x(), std::max({0.6 * way, kSteepest * std::abs(goal.y()), kNearest}));
  context.sub_goal = position + from_body(Vec2(ahead, goal.y()), context.tangent);
}

void set_allowed_speed(const TrafficView& view, const Course& course, double dt,
                       RoadContext& context) {
  const auto& [model, road, scene, traffic, grid, approaches] = view;
  const AgentType& type = course.type;
  const double front = course.along + course.half_length;
  const double free_speed = context.speed_limit;
  const double braking = course.speed * course.speed / (2.0 * type.comfortable_deceleration);
  const double reach = std::min(40.0 + 2.5 * course.speed + braking, 250.0);

  double binding = following_acceleration(type, course.speed, free_speed,
                                          std::numeric_limits<double>::infinity(), 0.0);
  DrivingAhead ahead;
  const Leader leader = find_leader(view, course.row, reach, ahead);
  if (leader.id >= 0)
    limit(
        behind_acceleration(type, course.speed, free_speed,
                            {leader.gap, leader.speed, leader.acceleration}, course.headway_factor),
        LimitReason::Leader, leader.id, binding, context);
  if (std::isfinite(ahead.turning_way)) aim_sooner(scene, course, ahead.turning_way, context);
  if (ahead.merging.id >= 0) {
    const double courtesy =
        following_acceleration(type, course.speed, free_speed, ahead.merging.rear - front,
                               ahead.merging.speed, course.headway_factor);
    // who waits for a gap gets one where that is easy, who is on its way gets it anyhow
    if (courtesy > -kCourtesy || ahead.on_its_way)
      limit(std::max(courtesy, -kCourtesy), LimitReason::Leader, ahead.merging.id, binding,
            context);
  }
  const double length = 2.0 * course.half_length;
  const Traveller traveller{course.row, front + beside_lane(model, course), length, course.speed};
  // who stands sees the light at the head of its queue
  constexpr double kSeesLight = 100.0;  // [m]
  bool first = true;
  const double looked_at = scene.held[course.row].standing > 0.0 ? kSeesLight : reach;
  for (PathLink link : course.path.links) {
    if (link.end < course.along - course.half_length) continue;
    if (link.stop_line > front + looked_at) break;
    link.halt = halt_for_long_bodies(view, traveller, link);
    const ZipperLeader teeth = find_zipper_leader(view, traveller, link);
    if (teeth.id >= 0) {
      // closer than it will follow afterwards: the gap opens while lanes run together
      const double headway = course.headway_factor * kept_headway(type, course.speed);
      const double gap = std::max(teeth.gap, 0.3) + 0.6 * headway * course.speed;
      const double zipped = following_acceleration(type, course.speed, free_speed, gap, teeth.speed,
                                                   course.headway_factor);
      limit(std::max(zipped, -type.comfortable_deceleration), LimitReason::Leader, teeth.id,
            binding, context);
    }
    LinkDecision decision = decide_link(view, traveller, link);
    // who gets over the edge of its lane just before its line isn't too near to halt for that
    if (!decision.must_stop && traveller.front > front && link.stop_line > front) {
      const Traveller own{course.row, front, length, course.speed};
      const LinkDecision held = decide_link(view, own, link);
      if (held.must_stop && held.reason == LimitReason::Signal) decision = held;
    }
    if (!decision.must_stop && traveller.front > front)
      decision = decide_beside(view, course, traveller, link);
    if (first) context.at_red = decision.must_stop && decision.reason == LimitReason::Signal;
    first = false;
    if (!decision.must_stop) decision = keep_clear(view, course, traveller, link, ahead);
    // who may go on to a place on the junction leaves room before it all the same
    if (!takes_turning_room(view, course, link)) {
      const LinkDecision room = leave_turning_room(view, traveller, link);
      if (room.must_stop && (!decision.must_stop || room.stop_at < decision.stop_at))
        decision = room;
    }
    if (!decision.must_stop) decision = let_one_in(view, course, traveller, link);
    if (!decision.must_stop) continue;
    const double gap = decision.stop_at - traveller.front + type.min_gap;
    context.to_halt = std::max(decision.stop_at - traveller.front, 0.0);
    double halting = following_acceleration(type, course.speed, free_speed, gap, 0.0);
    // a junction is kept clear at ease or not at all
    if (decision.reason == LimitReason::BlockedJunction)
      halting = std::max(halting, -kKeepsClearAtEase * type.comfortable_deceleration);
    limit(halting, decision.reason, decision.foe, binding, context);
    break;
  }
  if (course.path.arrival < front + looked_at) {
    const LinkDecision room = leave_room_at_end(view, course, traveller);
    const double gap = room.stop_at - traveller.front + type.min_gap;
    if (room.must_stop)
      limit(following_acceleration(type, course.speed, free_speed, gap, 0.0), room.reason, room.foe,
            binding, context);
  }
  if (std::isfinite(traffic.gate[course.row])) {
    // some way before it: who rolled over it by a hair had begun its change, whoever was beside
    constexpr double kBefore = 0.3;  // [m]
    const double gap = traffic.gate[course.row] - kBefore - course.along + type.min_gap;
    limit(following_acceleration(type, course.speed, free_speed, gap, 0.0), LimitReason::Merge, -1,
          binding, context);
  }
  limit(stop_acceleration(scene, course, free_speed), LimitReason::Stop, -1, binding, context);
  context.allowed_speed = std::max(0.0, course.speed + eased(scene, course, binding, dt) * dt);
  if (traffic.gives_way_left[course.row] > 0.0) {
    context.allowed_speed = 0.0;
    context.reason = LimitReason::GivesWay;
    context.foe = -1;
    return;
  }
  // who may start has room to find out where to: how fast it gets there is the body's business
  if (binding > 0.5 * type.max_acceleration)
    context.allowed_speed = std::max(context.allowed_speed, kStart);
  const double passing =
      std::max(ahead.passing_speed, course.speed - type.comfortable_deceleration * dt);
  if (passing < context.allowed_speed) {
    context.allowed_speed = passing;
    context.reason = LimitReason::Leader;
    context.foe = ahead.passed;
  }
}

/// Where a row is on its path.
Course course_of(const TrafficView& view, const Path& path, std::size_t row) {
  const Scene& scene = view.scene;
  const double along = scene.path_along[row];
  const Vec2 tangent = path.line.direction_at(along);
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const bool remembers = !path.walking && !type.steady_headway;
  return {path,
          type,
          row,
          along,
          cross(tangent, scene.position[row] - path.line.point_at(along)),
          half_extent(scene, row, tangent),
          path.walking ? std::max(0.0, scene.velocity[row].dot(tangent)) : scene.speed[row],
          scene.manners[row].headway_factor *
              (remembers ? headway_memory(scene.time - view.traffic.stood_at[row]) : 1.0)};
}

/// Writes the row's own columns of `traffic` alone.
RoadContext road_context(const TrafficView& view, std::size_t row, double dt,
                         TrafficState& traffic) {
  const Scene& scene = view.scene;
  RoadContext context;
  const Path* path = view.road.path(scene.path[row]);
  if (path == nullptr) return context;
  const Course course = course_of(view, *path, row);
  context.active = true;
  context.speed_limit =
      std::min(path->walking ? path->profile_at(course.along)
                             : foreseen_limit(*path, course.along, course.speed, dt),
               scene.preferred_speed[row]);
  context.merge_to = traffic.merge_to[row];
  context.aside = traffic.lateral_aim[row] - scene.manners[row].path_offset;
  set_geometry(view, course, context);
  note_halt(view, course, traffic);
  if (path->walking) {
    set_walker_limits(view, course, context);
  } else {
    set_allowed_speed(view, course, dt, context);
    note_keeping_clear(view, course, context, dt, traffic);
  }
  return context;
}

}  // namespace

void update_road_contexts(const TrafficTick& tick) {
  const TrafficView view = tick.view();
  const Scene& scene = tick.scene;
  tick.approaches.rebuild(tick.model, tick.road, scene, tick.traffic);
  tick.workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    // a row reads other rows' state but never their new context
    for (std::size_t row = begin; row < end; ++row)
      tick.scene.context[row] = road_context(view, row, tick.dt, tick.traffic);
  });
}

}  // namespace sumogamma
