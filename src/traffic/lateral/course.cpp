#include "traffic/lateral/course.h"

#include <algorithm>
#include <cmath>

#include "geometry/rotation.h"
#include "model/tracking.h"
#include "scene/extent.h"
#include "traffic/lateral/passing.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// Distance to the look-ahead sub-goal [m] (III-D): a body length and some, growing with speed.
double look_ahead(const Course& course) {
  if (course.path.walking) return 1.2 + 0.6 * course.speed;
  return 0.6 * course.half_length + 1.8 + 0.5 * course.speed;
}

/// See RoadContext::bend. Not amid a lane change, which may be given up.
Vec2 bend_of(const Course& course, const Heading& heading) {
  const double end = course.along + std::max(kBendTime * course.speed, 0.5);
  const Polyline& line = course.path.line;
  if (end > line.length() || course.path.stretch_at(course.along).changing ||
      course.path.stretch_at(end).changing)
    return {1, 0};
  const Vec2 chord = line.point_at(end) - line.point_at(course.along);
  return to_body(chord / (end - course.along), direction_of(heading));
}

/// Mean direction of the path between two places.
Vec2 chord_direction(const Polyline& line, double from, double to) {
  const Vec2 chord = line.point_at(to) - line.point_at(from);
  return chord.norm() > 1e-6 ? Vec2(chord.normalized()) : line.direction_at(to);
}

/// Over which a path's direction is taken [m]: half a second and more, so that the corners of a
/// coarse line don't ask for a jerk of the wheel; less for who is short between its axles and turns
/// in a hook of a cycle path.
double bend_window(const AgentType& type, double speed) {
  return std::min(1.0, type.wheelbase / 2.5) * (1.0 + 0.5 * speed);
}

/// The tightest bend that a body can turn in [1/m].
double tightest_bend(const AgentType& type) { return std::tan(type.max_steering) / type.wheelbase; }

/// How the path bends at the body [1/m], positive to the left; no more than the body can.
double curvature_of(const Course& course) {
  const Polyline& line = course.path.line;
  const double along = course.along, window = bend_window(course.type, course.speed);
  const Vec2 before = chord_direction(line, along - window, along);
  const double turn = heading_of(to_body(chord_direction(line, along, along + window), before));
  const double tightest = tightest_bend(course.type);
  return std::clamp(turn / window, -tightest, tightest);
}

/// Where to steer so that the body stays beside its path as it is: the path's direction a little
/// ahead, for the time that steering takes, less what a steady bend turns until there, which would
/// cut every long bend. Bends that are too tight for the body are begun early all the same.
Vec2 direction_to_steer(const Course& course, double curvature) {
  const AgentType& type = course.type;
  const double to_steer = 0.1 + 0.5 * type.max_steering / type.max_steering_rate;  // [s]
  // as fast as it will be there: who brakes for a corner with the preview of its speed now cuts it.
  // Long bodies less so: those that begin it late swing out behind it. Nor two-wheelers: in the
  // hooks of cycle paths bicycles would come out on the other lane
  const double there = course.path.profile_at(course.along + 0.4 + to_steer * course.speed);
  const double share = is_narrow(type.width)                  ? 0.0
                       : 2.0 * course.half_length > kLongBody ? 0.5
                                                              : 1.0;
  const double speed = course.speed - share * std::max(course.speed - there, 0.0);
  const double preview = 0.4 + to_steer * speed;
  const double place = course.along + preview, window = bend_window(type, speed);
  const Vec2 ahead = chord_direction(course.path.line, place - window, place + window);
  return from_body(ahead, direction_of(-curvature * (preview - steering_lead(type, course.speed))));
}

/// How far inwards the middle of a body keeps in a bend towards the kerb [m], positive left: its
/// ends swing outwards by length^2 / 8 R, so that the way it sweeps lies evenly about the path. In
/// a bend the other way whoever waits in the road turned into would be in the way of that.
double lean_of(const TrafficParameters& parameters, const Course& course, double curvature,
               bool keep_left) {
  if ((curvature > 0.0) != keep_left) return 0.0;
  const double length = 2.0 * course.half_length;
  return std::clamp(curvature * length * length / 16.0, -parameters.ample_side,
                    parameters.ample_side);
}

/// How far to the inside of a bend an offset from the path may be [m]: what is left of the bend
/// there, a body can still turn.
double inside_of(const Course& course, double curvature, double offset) {
  if (curvature * offset <= 0.0) return offset;
  const double most = std::max(1.0 / std::abs(curvature) - 1.0 / tightest_bend(course.type), 0.0);
  return std::clamp(offset, -most, most);
}

/// Is somebody on foot caught in a nook beside its way, a wall between its body and its `goal`?
/// Houses leave the middle of the way free.
bool is_caught(const TrafficView& view, const Course& course, double half_width, const Vec2& goal) {
  if (waited(view, course.row) < Patience::Pressing ||
      view.scene.context[course.row].reason != LimitReason::None)
    return false;
  const Vec2 position = view.scene.position[course.row];
  const Vec2 side = half_width * left_of((goal - position).normalized());
  return view.model.obstacles.is_between(position + side, goal + side) ||
         view.model.obstacles.is_between(position - side, goal - side);
}

/// Room beyond the boundaries of the own direction, to pass others there [m].
Sides room_over(const TrafficView& view, const Course& course) {
  const double over = view.traffic.overtaking_room[course.row];
  if (course.path.walking) return {over, over};
  return view.model.road.left_hand ? Sides{0.0, over} : Sides{over, 0.0};
}

/// Where the body means to be beside its path at its sub-goal [m].
double offset_ahead(const TrafficView& view, const Course& course, const Sides& over,
                    double half_width) {
  const PathStretch& target = course.path.stretch_at(course.along + look_ahead(course));
  return std::clamp(view.traffic.lateral_aim[course.row],
                    -std::max(target.room_right + over.right - half_width - 0.1, 0.0),
                    std::max(target.room_left + over.left - half_width - 0.1, 0.0));
}

/// On foot. Inside a sharp corner the place beside the path would be where a slow walker is
/// already: it would stay there for ever.
void aim_on_foot(const TrafficView& view, const Course& course, double offset, double half_width,
                 RoadContext& context) {
  const Polyline& line = course.path.line;
  const double ahead = course.along + look_ahead(course);
  const Vec2 direction = line.direction_at(ahead);
  const double turn = direction.dot(line.direction_at(course.along));
  const double kept = std::clamp(2.0 * turn, 0.0, 1.0);
  const Vec2 middle = line.point_at(ahead) + std::max(0.0, ahead - line.length()) * direction;
  context.sub_goal = middle + kept * offset * left_of(direction);
  if (is_caught(view, course, half_width, context.sub_goal))
    context.sub_goal = line.point_at(course.along + view.parameters.footstep);
  const Vec2 chord = middle - line.point_at(course.along);
  context.tangent = chord.norm() > 1e-6 ? Vec2(chord.normalized()) : direction;
}

/// On wheels, returns the offset at the sub-goal with what a bend makes of it [m]. The sub-goal
/// lies ahead in the path's own coordinates: aimed at straight, it would cut every bend by the
/// look-ahead squared over twice the radius, which is metres for a bus.
double aim_on_wheels(const TrafficView& view, const Course& course, double offset,
                     RoadContext& context) {
  const double curvature = curvature_of(course);
  const double there = inside_of(course, curvature, offset) +
                       lean_of(view.parameters, course, curvature, view.model.road.left_hand);
  context.tangent = direction_to_steer(course, curvature);
  context.bend = bend_of(course, view.scene.heading[course.row]);
  context.sub_goal = view.scene.position[course.row] + look_ahead(course) * context.tangent +
                     (there - course.offset) * left_of(context.tangent);
  return there;
}

/// To the edges of its carriageway, of which there is none amid a junction.
void set_edges(const TrafficView& view, const Course& course, const Sides& room,
               RoadContext& context) {
  const LaneId soon = course.path.stretch_at(course.along + view.parameters.waiting_room).lane;
  if (view.model.road.lane(soon).kind == LaneKind::Internal) return;
  const Vec2 heading = to_body(direction_of(view.scene.heading[course.row]), context.tangent);
  const double to_turn = (1.0 - heading.x()) / tightest_bend(course.type);
  context.edge_left = room.left - course.offset - (heading.y() > 0.0 ? to_turn : 0.0);
  context.edge_right = room.right + course.offset - (heading.y() < 0.0 ? to_turn : 0.0);
}

/// differs from the paper: who drives keeps to its lane, not just to its carriageway, but for where
/// it means to pass (`offset`); whoever is in the way is slowed down for, not swerved around.
Sides corridor_of(const TrafficView& view, const Course& course, const Sides& room, double offset,
                  double half_width, double extent) {
  const PathStretch& here = course.path.stretch_at(course.along);
  const Lane& lane = view.model.road.lane(here.lane);
  const double corridor = std::max(0.5 * lane.width, half_width + 0.3) +
                          (lane.kind == LaneKind::Internal || here.changing ? 0.6 : 0.0);
  // a lane is no wall: at a snail's pace it may be left, so that two who are wedged side by side
  // find a way on
  const double drift = view.parameters.drift_speed * course.type.horizon + extent;
  // who filters or overtakes turns out of its lane within a few metres
  const bool overtakes = view.traffic.overtaking_room[course.row] > 0.0;
  const double spare = overtakes ? 2.0 : is_narrow(course.type.width) ? 1.2 : 0.4;
  const double beside = half_width + spare;
  return {std::min(room.left, std::max({corridor, beside + offset, course.offset + drift})),
          std::min(room.right, std::max({corridor, beside - offset, drift - course.offset}))};
}

}  // namespace

void set_geometry(const TrafficView& view, const Course& course, RoadContext& context) {
  const double half_width = course.half_width;
  const Sides over = room_over(view, course);
  double offset = offset_ahead(view, course, over, half_width);
  if (course.path.walking)
    aim_on_foot(view, course, offset, half_width, context);
  else
    offset = aim_on_wheels(view, course, offset, context);
  const PathStretch& here = course.path.stretch_at(course.along);
  const double extent = half_extent(view.scene, course.row, left_of(context.tangent));
  Sides room{here.room_left + over.left, here.room_right + over.right};
  if (!course.path.walking) {
    set_edges(view, course, room, context);
    if (view.rules) room = corridor_of(view, course, room, offset, half_width, extent);
  }
  context.room_left = room.left - course.offset - extent;
  context.room_right = room.right + course.offset - extent;
}

}  // namespace sumogamma
