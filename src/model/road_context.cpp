#include "model/road_context.h"

#include <algorithm>

#include "model/course.h"
#include "model/following.h"
#include "model/jaywalking.h"
#include "model/leader.h"
#include "model/locate.h"
#include "model/passing.h"
#include "model/right_of_way.h"
#include "model/turning_room.h"
#include "scene/storey.h"

namespace sumogamma {

namespace {

/// The frozen scene and what is known of its roads.
struct View {
  const Model& model;
  const RoadState& road;
  const Scene& scene;
  const SpatialGrid& grid;
  const ApproachTable& approaches;
};

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
  const auto next = static_cast<std::size_t>(scene.next_stop[course.row]);
  if (next >= course.path.stops.size()) return course.type.max_acceleration;
  const double gap =
      course.path.stops[next].along - course.along - course.half_length + course.type.min_gap;
  return following_acceleration(course.type, course.speed, free_speed, gap, 0.0);
}

/// Where the next queue behind a link may have its head [m along the path]: before the next link
/// at which somebody might have to wait, infinite where none is near.
double next_queue_head(const View& view, const Course& course, const PathLink& link) {
  constexpr double kNear = 80.0;  // [m]
  for (const PathLink& next : course.path.links) {
    if (next.stop_line <= link.stop_line) continue;
    if (next.stop_line > link.end + kNear) break;
    const Connection& connection = view.model.road.connection(next.connection);
    const char signal = view.road.signal(connection);
    const bool first = signal == 'G' || (signal == 'O' && connection.state == 'M');
    if (!first && has_crossing_traffic(view.model, next.connection)) return next.halt;
  }
  return std::numeric_limits<double>::infinity();
}

/// Calls `visit` for everybody who has halted at its line, to give way to the row for the lane that
/// `link` leads into, and isn't past the place that both need.
template <typename Visit>
void visit_joining(const View& view, const Course& course, const PathLink& link, Visit visit) {
  const LaneId to = view.model.road.connection(link.connection).to;
  for (const ConflictZone& zone : view.model.conflicts[index_of(link.connection)]) {
    if (zone.yields || view.model.road.connection(zone.foe).to != to) continue;
    for (const Approach& foe : view.approaches.of(zone.foe)) {
      const Waiting& waiting = view.approaches.waiting(foe.row);
      if (foe.row != course.row && waiting.halted_for == zone.foe && foe.front < zone.foe_end)
        visit(foe, waiting);
    }
  }
}

/// Length [m] of who has stood for long at its line and waits to join; of the longest there, 0
/// where nobody does.
double waits_to_join(const View& view, const Course& course, const PathLink& link) {
  constexpr double kLong = 20.0;  // [s]
  double length = 0.0;
  visit_joining(view, course, link, [&](const Approach& foe, const Waiting& waiting) {
    const bool gives_way = waiting.reason == LimitReason::Yield ||
                           waiting.reason == LimitReason::Crossing ||
                           waiting.reason == LimitReason::BlockedJunction;
    if (foe.stands && gives_way && view.scene.time - waiting.halted_at > kLong)
      length = std::max(length, foe.length);
  });
  return length;
}

/// The teeth of a zipper where a road is full: who has the right of way there, but has come to
/// stand before the junction, lets one in who came to its line before, some time ago. Not into the
/// short roads of rings, where everybody waits for who is let in.
LinkDecision let_one_in(const View& view, const Course& course, const Traveller& traveller,
                        const PathLink& link) {
  constexpr double kStands = 2.0, kSomeTime = 10.0;  // [s]
  constexpr double kAtLine = 6.0, kShort = 40.0;     // [m]
  const Connection& connection = view.model.road.connection(link.connection);
  if (traveller.front > link.stop_line + 0.3 || traveller.front < link.halt - kAtLine ||
      view.scene.waiting_time[course.row] < kStands || connection.signal != kNoSignal ||
      view.model.road.lane(connection.to).length < kShort)
    return {};
  const Waiting& own = view.approaches.waiting(course.row);
  const double came = own.halted_for == link.connection ? own.halted_at : view.scene.time;
  const auto id = static_cast<std::int64_t>(view.scene.id[course.row].value);
  LinkDecision decision;
  visit_joining(view, course, link, [&](const Approach& foe, const Waiting& waiting) {
    const bool first = waiting.halted_at <= came && view.scene.time - waiting.halted_at > kSomeTime;
    // not for somebody who has others to wait for
    const bool comes = waiting.reason == LimitReason::None ||
                       waiting.reason == LimitReason::Leader ||
                       waiting.reason == LimitReason::BlockedJunction ||
                       (waiting.reason == LimitReason::Yield && waiting.foe == id);
    if (foe.front > -kAtLine && first && comes)
      decision = {true, link.halt - kStopMargin, LimitReason::LetsIn,
                  static_cast<std::int64_t>(view.scene.id[foe.row].value)};
  });
  return decision;
}

/// Keep clear: is there room behind a link for the body, should everybody ahead close up and stop?
/// Into a full road drivers let one in who has waited for long, and count its body as well. Id of
/// who takes the room, -1 where there is enough. Sorts `ahead`.
std::int64_t blocks_exit(const View& view, DrivingAhead& ahead, const Course& course,
                         const PathLink& link) {
  constexpr double kBraking = 3.5;   // [m/s^2]
  constexpr double kDrives = 3.0;    // [m/s]
  constexpr double kStarts = 0.8;    // likewise of who follows those who drive [m/s]
  constexpr double kClosedUp = 1.0;  // [m]
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (ahead.count == 0) return -1;
  const auto begin = ahead.vehicles.begin(), end = begin + static_cast<std::ptrdiff_t>(ahead.count);
  std::sort(begin, end, [](const auto& a, const auto& b) {
    return a.rear != b.rear ? a.rear > b.rear : a.id < b.id;
  });
  // where each comes to rest at the least, from the far end of the queue
  const double head = next_queue_head(view, course, link);
  double rest = kNever;
  for (auto vehicle = begin; vehicle != end; ++vehicle) {
    // who drives and has nobody slow ahead goes on, as far as to the next place where it may have
    // to wait
    const LimitReason why = view.approaches.waiting(vehicle->row).reason;
    const bool starts = rest == kNever && vehicle->speed > kStarts &&
                        (why == LimitReason::None || why == LimitReason::Leader);
    const double alone = vehicle->speed > kDrives || starts
                             ? kNever
                             : vehicle->rear + vehicle->speed * vehicle->speed / (2.0 * kBraking);
    if (vehicle->front < head) rest = std::min(rest, head + kClosedUp);
    rest = std::min(alone, rest - kClosedUp - (vehicle->front - vehicle->rear));
  }
  if (rest == kNever) return -1;
  const double joining = waits_to_join(view, course, link);
  const double needed = link.end + 2.0 * course.half_length + course.type.min_gap + 0.3 +
                        (joining > 0.0 ? joining + kClosedUp : 0.0);
  return rest < needed ? (end - 1)->id : -1;
}

// kept clear at the most, and driven on for so long then. Round a block whose roads are full nobody
// would ever move on: somebody has to lend the queue the room of the junction [s]
constexpr double kKeepsClear = 40.0, kGoesOn = 10.0;

/// Counts for how long the agent has kept a junction, or the room that others need to turn, clear.
void note_keeping_clear(const Course& course, const RoadContext& context, double dt, Scene& scene) {
  double& kept = scene.keeps_clear[course.row];
  const bool for_others =
      context.reason == LimitReason::BlockedJunction || context.reason == LimitReason::TurningRoom;
  if (for_others && course.speed < 0.3) {
    kept += dt;
    if (kept > kKeepsClear) kept = kKeepsClear + kGoesOn;
  } else if (kept > kKeepsClear) {
    kept = kept - dt > kKeepsClear ? kept - dt : 0.0;
  } else if (scene.waiting_time[course.row] == 0.0) {
    kept = 0.0;
  }
}

/// Does the agent no longer leave others the room to turn? At a signal who stands in its way gets
/// green while it waits, and whoever comes next halts further back: there it lets some cycles pass.
bool takes_turning_room(const RoadNetwork& network, const Scene& scene, const Course& course,
                        const PathLink& link) {
  constexpr double kCycles = 180.0;  // [s]
  const bool signalled = network.connection(link.connection).signal != kNoSignal;
  return scene.keeps_clear[course.row] > kKeepsClear &&
         (!signalled || scene.waiting_time[course.row] > kCycles);
}

/// Remembers for stop signs that the agent came to a halt before its next link.
void note_halt(const Course& course, Scene& scene) {
  constexpr double kAtLine = 4.0, kHalt = 0.3;
  if (scene.standing_time[course.row] < kHalt) return;
  const double front = course.along + course.half_length;
  for (const PathLink& link : course.path.links) {
    if (link.stop_line < front - 0.3) continue;
    if (link.halt < front + kAtLine && scene.halted_for[course.row] != link.connection) {
      scene.halted_for[course.row] = link.connection;
      scene.halted_at[course.row] = scene.time;
    }
    return;
  }
}

/// Keep clear of junctions that follow each other closely: who would have to wait before the next
/// one with its rear still on this one waits here already, for some time.
LinkDecision decide_beyond(const View& view, const Course& course, const Traveller& traveller,
                           const PathLink& link) {
  constexpr double kPatience = 20.0;  // [s]
  constexpr double kFarthest = 20.0;  // [m]
  constexpr double kSetOut = 0.3;     // [m]
  if (view.scene.waiting_time[course.row] > kPatience) return {};
  // nor does it halt again who has set out from a place short of the line
  if (traveller.front > link.halt + kSetOut && link.stop_line > link.halt + kSetOut) return {};
  const PathLink* last = &link;
  for (const PathLink& next : course.path.links) {
    // who waits with its rear on a junction already goes as far as it can
    if (next.stop_line < link.stop_line && next.end > link.halt - kStopMargin - traveller.length)
      return {};
    if (next.stop_line <= link.stop_line) continue;
    if (next.halt - kStopMargin - traveller.length > last->end ||
        next.stop_line > link.stop_line + kFarthest)
      break;
    const LinkDecision decision =
        decide_link(view.model, view.road, view.scene, view.approaches, traveller, next);
    if (decision.must_stop) return decision;
    last = &next;
  }
  return {};
}

/// The throttle goes down at ease where the vehicle drives: a cap on the jerk that following and
/// avoidance leave, however they take turns. Brakes and the start are not eased.
double eased(const Scene& scene, const Course& course, double acceleration, double dt) {
  constexpr double kJerk = 2.8;    // [m/s^3]
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

void set_allowed_speed(const View& view, const Course& course, double dt, RoadContext& context) {
  const auto& [model, road, scene, grid, approaches] = view;
  const AgentType& type = course.type;
  const double front = course.along + course.half_length;
  const double free_speed = context.speed_limit;
  const double braking = course.speed * course.speed / (2.0 * type.comfortable_deceleration);
  const double reach = std::min(40.0 + 2.5 * course.speed + braking, 250.0);

  double binding = following_acceleration(type, course.speed, free_speed,
                                          std::numeric_limits<double>::infinity(), 0.0);
  DrivingAhead ahead;
  const Leader leader = find_leader(model, road, scene, grid, course.row, reach, ahead);
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
  const Traveller traveller{course.row, front + beside_lane(model, course), length, course.speed,
                            free_speed};
  // who stands sees the light at the head of its queue
  constexpr double kSeesLight = 100.0;  // [m]
  bool first = true;
  const double looked_at = scene.standing_time[course.row] > 0.0 ? kSeesLight : reach;
  for (PathLink link : course.path.links) {
    if (link.end < course.along - course.half_length) continue;
    if (link.stop_line > front + looked_at) break;
    link.halt = halt_for_long_bodies(model, scene, approaches, traveller, link);
    const ZipperLeader teeth = find_zipper_leader(model, scene, approaches, traveller, link);
    if (teeth.id >= 0) {
      // closer than it will follow afterwards: the gap opens while lanes run together
      const double headway = course.headway_factor * kept_headway(type, course.speed);
      const double gap = std::max(teeth.gap, 0.3) + 0.6 * headway * course.speed;
      const double zipped = following_acceleration(type, course.speed, free_speed, gap, teeth.speed,
                                                   course.headway_factor);
      limit(std::max(zipped, -type.comfortable_deceleration), LimitReason::Leader, teeth.id,
            binding, context);
    }
    LinkDecision decision = decide_link(model, road, scene, approaches, traveller, link);
    // who gets over the edge of its lane just before its line isn't too near to halt for that
    if (!decision.must_stop && traveller.front > front && link.stop_line > front) {
      const Traveller own{course.row, front, length, course.speed, free_speed};
      const LinkDecision held = decide_link(model, road, scene, approaches, own, link);
      if (held.must_stop && held.reason == LimitReason::Signal) decision = held;
    }
    if (first) context.at_red = decision.must_stop && decision.reason == LimitReason::Signal;
    first = false;
    // who waits on the junction goes no further, either
    const double entry = std::max(link.stop_line, link.inside);
    if (!decision.must_stop && entry > front - 0.3 &&
        scene.keeps_clear[course.row] <= kKeepsClear &&
        has_crossing_traffic(model, link.connection)) {
      const std::int64_t blocker = blocks_exit(view, ahead, course, link);
      const LinkDecision beyond =
          blocker >= 0 ? LinkDecision{true, 0.0, LimitReason::BlockedJunction, blocker}
                       : decide_beyond(view, course, traveller, link);
      const double line = link.halt > front              ? link.halt
                          : link.stop_line > front - 0.3 ? link.stop_line
                                                         : link.inside;
      if (beyond.must_stop) decision = {true, line - kStopMargin, beyond.reason, beyond.foe};
    }
    if (!decision.must_stop && !takes_turning_room(model.road, scene, course, link))
      decision = leave_turning_room(model, road, scene, approaches, traveller, link);
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
  if (std::isfinite(scene.gate[course.row])) {
    // some way before it: who rolled over it by a hair had begun its change, whoever was beside
    constexpr double kBefore = 0.3;  // [m]
    const double gap = scene.gate[course.row] - kBefore - course.along + type.min_gap;
    limit(following_acceleration(type, course.speed, free_speed, gap, 0.0), LimitReason::Merge, -1,
          binding, context);
  }
  limit(stop_acceleration(scene, course, free_speed), LimitReason::Stop, -1, binding, context);
  context.allowed_speed = std::max(0.0, course.speed + eased(scene, course, binding, dt) * dt);
  if (scene.gives_way_left[course.row] > 0.0) {
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

/// People who walk the same way one behind the other keep a distance that grows with their speed,
/// as on any sidewalk (Seyfried et al. 2005: 0.36 m + 1.06 s v from middle to middle); whoever
/// comes towards them is left to avoidance.
void follow_on_foot(const View& view, const Course& course, RoadContext& context) {
  constexpr double kReach = 2.5;   // [m]
  constexpr double kFile = 0.05;   // two who overlap sideways by more than this walk in file [m]
  constexpr double kBeside = 0.1;  // who is no further ahead is beside [m]
  const Scene& scene = view.scene;
  const std::size_t row = course.row;
  const Vec2 left = left_of(context.tangent);
  const double half_width = half_extent(scene, row, left);
  view.grid.visit_within(scene.position[row], kReach, [&](std::size_t other, double) {
    if (other == row || on_other_storey(view.model.road, scene, row, other)) return;
    if (type_of(view.model.types, scene.type[other]).kinematics != Kinematics::Holonomic) return;
    const Vec2 offset = scene.position[other] - scene.position[row];
    const double ahead = offset.dot(context.tangent);
    const double aside = half_width + half_extent(scene, other, left) - kFile;
    if (ahead < kBeside || std::abs(offset.dot(left)) > aside) return;
    if (direction_of(scene.heading[other]).dot(context.tangent) < 0.5) return;
    const double gap = ahead - course.half_length - half_extent(scene, other, context.tangent);
    const double allowed = std::max(gap, 0.0) / (course.type.headway * course.headway_factor);
    if (allowed >= context.allowed_speed || allowed >= context.speed_limit) return;
    context.allowed_speed = allowed;
    context.reason = LimitReason::Leader;
    context.foe = scene.id[other].value;
  });
}

bool is_on(const Lane& crossing, const Vec2& place) {
  const PolylinePosition at = crossing.centerline.project(place);
  return at.along > 0.0 && at.along < crossing.centerline.length() &&
         at.distance < 0.5 * crossing.width;
}

/// Who makes way for others beside a crossing doesn't step onto it while it is red: its edge bounds
/// the room beside the path of somebody on foot who doesn't cross there.
void keep_off_red_crossings(const View& view, const Course& course, RoadContext& context) {
  constexpr double kNear = 2.0, kStep = 0.1;  // [m]
  const RoadNetwork& network = view.model.road;
  const Vec2& position = view.scene.position[course.row];
  const Vec2 left = left_of(context.tangent);
  const double extent = half_extent(view.scene, course.row, left);
  auto bound = [&](const Lane& crossing) {
    if (is_on(crossing, position)) return;
    for (double aside = kStep; aside < extent + kNear; aside += kStep) {
      if (aside - extent < context.room_left && is_on(crossing, position + aside * left))
        context.room_left = aside - extent;
      if (aside - extent < context.room_right && is_on(crossing, position - aside * left))
        context.room_right = aside - extent;
    }
  };
  for (const PathStretch& stretch : course.path.stretches) {
    if (stretch.to < course.along - kNear || stretch.from > course.along + kNear) continue;
    const Lane& area = network.lane(stretch.lane);
    if (area.kind != LaneKind::WalkingArea) continue;
    auto look = [&](LaneId beside) {
      const Lane& crossing = network.lane(beside);
      // one of its two directions has the light
      const auto& ways = crossing.incoming;
      const bool red = std::any_of(ways.begin(), ways.end(), [&](ConnectionId id) {
        return is_red(view.road.signal(network.connection(id)));
      });
      const auto& own = course.path.stretches;
      if (crossing.kind == LaneKind::Crossing && red &&
          std::none_of(own.begin(), own.end(),
                       [&](const PathStretch& other) { return other.lane == beside; }))
        bound(crossing);
    };
    for (const ConnectionId id : area.outgoing) look(network.connection(id).to);
    for (const ConnectionId id : area.incoming) look(network.connection(id).from);
  }
}

/// Where somebody on foot waits for a crossing [m along its path]: where its way off the road ends,
/// or before its place beside the path gets onto the crossing, as inside the corner in which the
/// way turns there; behind the crossing before, in the middle of what is between the two where that
/// is no deeper than a body.
double kerb_halt(const Model& model, const Course& course, const PathLink& link) {
  constexpr double kFarthest = 4.0, kStep = 0.2, kOnIt = 0.2;  // [m]
  const Polyline& line = course.path.line;
  const Vec2 begin = line.point_at(link.stop_line), way = line.point_at(link.end) - begin;
  if (way.norm() < kOnIt) return link.halt;
  const Vec2 across = way.normalized();
  const LaneId crossing = course.path.stretch_at(0.5 * (link.stop_line + link.end)).lane;
  const double half_width = 0.5 * model.road.lane(crossing).width;
  double crossed = -std::numeric_limits<double>::infinity();
  for (const PathLink& before : course.path.links)
    if (before.stop_line < link.stop_line) crossed = std::max(crossed, before.end);
  if (link.halt - kStopMargin - 2.0 * course.half_length < crossed)
    return 0.5 * (crossed + link.stop_line) + course.half_length + kStopMargin;
  const double least = std::max(link.stop_line - kFarthest, crossed + kStep);
  double halt = link.halt;
  for (double along = link.stop_line; along > least; along -= kStep) {
    const Vec2 beside = course.offset * left_of(line.direction_at(along));
    const Vec2 place = line.point_at(along) + beside - begin;
    if (place.dot(across) > kOnIt && std::abs(cross(across, place)) < half_width)
      halt = std::min(halt, along - kStep);
  }
  return halt;
}

/// Walkers stop dead at a kerb, and otherwise leave each other to avoidance.
void set_walker_limit(const View& view, const Course& course, RoadContext& context) {
  constexpr double kStep = 0.4;     // [m]
  constexpr double kOnIt = 0.7;     // whose front is further past the line crosses [m]
  constexpr double kPressed = 3.0;  // likewise who waited for the light, and was pressed on [m]
  const bool was_held = view.scene.context[course.row].reason == LimitReason::Signal;
  const double front = course.along + course.half_length;
  const Traveller traveller{course.row, front, 2.0 * course.half_length, course.speed,
                            context.speed_limit};
  auto halt = [&](const LinkDecision& decision) {
    const double allowed = std::max(0.0, (decision.stop_at - front) / 0.7);
    context.to_halt = std::max(decision.stop_at - front, 0.0);
    context.allowed_speed = std::min(context.allowed_speed, allowed);
    context.reason = decision.reason;
    context.foe = decision.foe;
  };
  const LinkDecision at_kerb =
      decide_at_kerb(view.model, view.road, view.scene, view.grid, traveller);
  if (at_kerb.must_stop) return halt(at_kerb);
  for (PathLink link : course.path.links) {
    const double past = front - link.stop_line;
    if (link.end < course.along || past > (was_held ? kPressed : kOnIt)) continue;
    if (link.halt > front + 8.0) break;
    link.halt = kerb_halt(view.model, course, link);
    if (link.halt > front + 4.0) continue;
    Traveller waiting = traveller;
    waiting.front = std::min(front, link.stop_line + kOnIt);
    const LinkDecision decision =
        decide_link(view.model, view.road, view.scene, view.approaches, waiting, link);
    if (!decision.must_stop) continue;
    if (past > kOnIt && decision.reason != LimitReason::Signal) continue;
    const double beyond = front - (link.halt - kStopMargin);
    if (beyond <= (link.halt < link.stop_line ? kStep : 1.0)) return halt(decision);
    // on the road already when the light changed, or pressed on: back to where nobody drives
    context.sub_goal = course.path.line.point_at(course.along - beyond);
    context.allowed_speed = std::min(beyond / 0.7, 1.0);
    context.reason = decision.reason;
    context.foe = decision.foe;
    return;
  }
}

}  // namespace

void update_road_contexts(const Model& model, const RoadState& road, const SpatialGrid& grid,
                          double dt, Workers& workers, ApproachTable& approaches, Scene& scene) {
  approaches.rebuild(model, road, scene);
  const View view{model, road, scene, grid, approaches};
  workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      RoadContext context;
      const Path* path = road.path(scene.path[row]);
      if (path != nullptr) {
        const double along = scene.path_along[row];
        const Vec2 tangent = path->line.direction_at(along);
        const Course course{
            *path,
            type_of(model.types, scene.type[row]),
            row,
            along,
            cross(tangent, scene.position[row] - path->line.point_at(along)),
            half_extent(scene, row, tangent),
            path->walking ? std::max(0.0, scene.velocity[row].dot(tangent)) : scene.speed[row],
            scene.manners[row].headway_factor};
        context.active = true;
        context.speed_limit =
            std::min(path->walking ? path->profile_at(along)
                                   : foreseen_limit(*path, along, course.speed, dt),
                     scene.preferred_speed[row]);
        set_geometry(model, scene, course, context);
        if (path->walking) {
          keep_off_red_crossings(view, course, context);
          follow_on_foot(view, course, context);
          set_walker_limit(view, course, context);
        } else {
          note_halt(course, scene);
          set_allowed_speed(view, course, dt, context);
          note_keeping_clear(course, context, dt, scene);
        }
      }
      // a row reads other rows' state but never their new context
      scene.context[row] = context;
    }
  });
}

}  // namespace sumogamma
