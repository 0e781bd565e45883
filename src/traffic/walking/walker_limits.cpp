#include "traffic/walking/walker_limits.h"

#include <algorithm>

#include "scene/extent.h"
#include "traffic/junction/arbitration.h"
#include "traffic/patience.h"
#include "traffic/perception.h"
#include "traffic/walking/mid_block_crossing.h"

namespace sumogamma {

namespace {

constexpr double kLeastWay = 1e-4;  ///< that has a direction: nobody creeps on over it [m]

/// People who walk the same way one behind the other keep a distance that grows with their speed,
/// as on any sidewalk (Seyfried et al. 2005: 0.36 m + 1.06 s v from middle to middle); whoever
/// comes towards them is left to avoidance.
void follow_on_foot(const TrafficView& view, const Course& course, RoadContext& context) {
  const Scene& scene = view.scene;
  const std::size_t row = course.row;
  const Vec2 left = left_of(context.tangent);
  const double half_width = half_extent(view.scene, row, left);
  visit_near(view, row, view.parameters.near, [&](std::size_t other) {
    if (type_of(view.model.types, scene.type[other]).kinematics != Kinematics::Holonomic) return;
    const Vec2 offset = scene.position[other] - scene.position[row];
    const double ahead = offset.dot(context.tangent);
    const double aside =
        half_width + half_extent(view.scene, other, left) - view.parameters.touching;
    if (ahead < view.parameters.touching || std::abs(offset.dot(left)) > aside) return;
    if (direction_of(view.scene.heading[other]).dot(context.tangent) < 0.5) return;
    // where their ways bend each may be ahead of the other: one of them goes
    const Waiting& theirs = view.approaches.waiting(other);
    if (theirs.reason == LimitReason::Leader && theirs.foe == scene.id[row].value &&
        scene.id[row] < scene.id[other])
      return;
    const double gap = ahead - course.half_length - half_extent(view.scene, other, context.tangent);
    const double allowed = std::max(gap, 0.0) / (course.type.headway * course.headway_factor);
    if (allowed >= context.allowed_speed || allowed >= context.speed_limit) return;
    context.allowed_speed = allowed;
    context.reason = LimitReason::Leader;
    context.foe = scene.id[other].value;
  });
}

/// The shortest way onto a crossing [m]; for who is on its rim a bit of the way on, zero further
/// on.
Vec2 way_onto(const TrafficParameters& parameters, const Lane& crossing, const Vec2& place) {
  const auto& points = crossing.centerline.points();
  const Vec2 along = points.back() - points.front();
  const double length = along.norm();
  if (length <= 0.0) return Vec2::Zero();
  const Vec2 forward = along / length;
  const Vec2 here = to_body(place - points.front(), forward);
  const double half_width = 0.5 * crossing.width;
  const Vec2 nearest(std::clamp(here.x(), 0.0, length),
                     std::clamp(here.y(), -half_width, half_width));
  if (nearest != here) return from_body(nearest - here, forward);
  const Vec2 from_middle = here - Vec2(0.5 * length, 0.0);
  const Vec2 depth = Vec2(0.5 * length, half_width) - from_middle.cwiseAbs();
  if (depth.minCoeff() > parameters.closed_up_gap) return Vec2::Zero();
  const Vec2 inwards = depth.x() < depth.y() ? Vec2(std::copysign(1.0, -from_middle.x()), 0.0)
                                             : Vec2(0.0, std::copysign(1.0, -from_middle.y()));
  return from_body(kLeastWay * inwards, forward);
}

/// Is a crossing red? One of its two directions has the light.
bool is_red_for_walkers(const TrafficView& view, const Lane& crossing) {
  return std::any_of(crossing.incoming.begin(), crossing.incoming.end(), [&](ConnectionId id) {
    return is_red(view.road.signal(view.model.road.connection(id)));
  });
}

/// Who makes way for others beside a crossing, or on its rim, doesn't step further onto it while it
/// is red; its own counts where it waits for it, and before its way leads there.
void keep_off_red_crossings(const TrafficView& view, const Course& course, RoadContext& context) {
  const RoadNetwork& network = view.model.road;
  const Vec2& position = view.scene.position[course.row];
  const auto& own = course.path.stretches;
  const bool waits = context.reason == LimitReason::Signal;
  auto look = [&](LaneId beside) {
    const Lane& crossing = network.lane(beside);
    if (crossing.kind != LaneKind::Crossing || !is_red_for_walkers(view, crossing)) return;
    Vec2 way = way_onto(view.parameters, crossing, position);
    const double distance = way.norm();
    if (distance == 0.0 || distance > view.parameters.near_line) return;
    // nor does who goes round others come back onto the one that lies behind it, or get onto its
    // own from the side, before its way leads there; nor back onto the one that it is about to
    // leave
    const bool crosses = std::any_of(own.begin(), own.end(), [&](const PathStretch& stretch) {
      return stretch.lane == beside && stretch.to > course.along + view.parameters.closed_up_gap &&
             stretch.from < course.along + view.parameters.near_line;
    });
    if (crosses && !waits) return;
    const double extent = half_extent(view.scene, course.row, way / distance);
    way *= std::max(distance - extent, kLeastWay) / distance;
    for (Vec2& kept : context.to_red) {
      if (way == kept || way.isZero()) return;
      if (kept.isZero() || way.squaredNorm() < kept.squaredNorm()) std::swap(way, kept);
    }
  };
  LaneId looked_at = kNoLane;
  for (auto stretch =
           own.begin() +
           (&course.path.stretch_at(course.along - view.parameters.near_line) - own.data());
       stretch != own.end() && stretch->from <= course.along + view.parameters.near_line;
       ++stretch) {
    const Lane& area = network.lane(stretch->lane);
    if (area.kind != LaneKind::WalkingArea || stretch->lane == looked_at) continue;
    looked_at = stretch->lane;
    for (const ConnectionId id : area.outgoing) look(network.connection(id).to);
    for (const ConnectionId id : area.incoming) look(network.connection(id).from);
  }
}

/// Where somebody on foot waits for a crossing [m along its path]: where its way off the road ends,
/// or before its place beside the path gets onto the crossing, as inside the corner in which the
/// way turns there; behind the crossing before, in the middle of what is between the two where that
/// is no deeper than a body.
double kerb_halt(const TrafficView& view, const Course& course, const PathLink& link) {
  const TrafficParameters& parameters = view.parameters;
  const Polyline& line = course.path.line;
  const Vec2 begin = line.point_at(link.stop_line), way = line.point_at(link.end) - begin;
  if (way.norm() < parameters.line_tolerance) return link.halt;
  const Vec2 across = way.normalized();
  const LaneId crossing = course.path.stretch_at(0.5 * (link.stop_line + link.end)).lane;
  const double half_width = 0.5 * view.model.road.lane(crossing).width;
  double crossed = -std::numeric_limits<double>::infinity();
  for (const PathLink& before : course.path.links)
    if (before.stop_line < link.stop_line) crossed = std::max(crossed, before.end);
  if (link.halt - parameters.stop_margin - 2.0 * course.half_length < crossed)
    return 0.5 * (crossed + link.stop_line) + course.half_length + parameters.stop_margin;
  const double least = std::max(link.stop_line - parameters.near, crossed + parameters.fine_step);
  double halt = link.halt;
  for (double along = link.stop_line; along > least; along -= parameters.fine_step) {
    const Vec2 beside = course.offset * left_of(line.direction_at(along));
    const Vec2 place = line.point_at(along) + beside - begin;
    if (place.dot(across) > parameters.line_tolerance &&
        std::abs(cross(across, place)) < half_width)
      halt = std::min(halt, along - parameters.fine_step);
  }
  return halt;
}

/// Walkers stop dead at a kerb, and otherwise leave each other to avoidance.
void set_walker_limit(const TrafficView& view, const Course& course, RoadContext& context) {
  // who waited for the light, or set out and got no further: a queue stands over the crossing
  const bool was_held = view.scene.context[course.row].reason == LimitReason::Signal ||
                        waited(view, course.row) >= Patience::Waiting;
  const double front = course.along + course.half_length;
  const Traveller traveller{course.row, front, 2.0 * course.half_length, course.speed};
  auto halt = [&](const LinkDecision& decision) {
    const double allowed = std::max(0.0, (decision.stop_at - front) / 0.7);
    context.to_halt = std::max(decision.stop_at - front, 0.0);
    context.allowed_speed = std::min(context.allowed_speed, allowed);
    context.reason = decision.reason;
    context.foe = decision.foe;
  };
  const LinkDecision at_kerb = decide_at_kerb(view, traveller, context.speed_limit);
  if (at_kerb.must_stop) return halt(at_kerb);
  for (PathLink link : course.path.links) {
    const double past = front - link.stop_line;
    if (link.end < course.along ||
        past > (was_held ? view.parameters.near_line : view.parameters.footstep))
      continue;
    if (link.halt > front + 8.0) break;
    link.halt = kerb_halt(view, course, link);
    if (link.halt > front + 4.0) continue;
    Traveller waiting = traveller;
    waiting.front = std::min(front, link.stop_line + view.parameters.footstep);
    const LinkDecision decision = decide_link(view, waiting, link);
    if (!decision.must_stop) continue;
    if (past > view.parameters.footstep && decision.reason != LimitReason::Signal) continue;
    const double beyond = front - (link.halt - view.parameters.stop_margin);
    if (beyond <= (link.halt < link.stop_line ? view.parameters.footstep : 1.0))
      return halt(decision);
    // on the road already when the light changed, or pressed on: back to where nobody drives
    context.sub_goal = course.path.line.point_at(course.along - beyond);
    context.allowed_speed = std::min(beyond / 0.7, 1.0);
    context.reason = decision.reason;
    context.foe = decision.foe;
    // and no further on, whoever comes back behind: at the kerb who turns round is pressed on
    if (decision.reason == LimitReason::Signal)
      context.to_red.back() = kLeastWay * course.path.line.direction_at(link.stop_line);
    return;
  }
}

}  // namespace

void set_walker_limits(const TrafficView& view, const Course& course, RoadContext& context) {
  follow_on_foot(view, course, context);
  set_walker_limit(view, course, context);
  keep_off_red_crossings(view, course, context);
}

}  // namespace sumogamma
