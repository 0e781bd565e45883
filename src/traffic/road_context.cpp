#include "traffic/road_context.h"

#include <algorithm>

#include "traffic/junction/keep_clear.h"
#include "traffic/lateral/course.h"
#include "traffic/longitudinal/allowed_speed.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"
#include "traffic/walking/walker_limits.h"

namespace sumogamma {

namespace {

/// Has an agent all but come to the line of a stop sign, as slow as those who roll over it?
bool rolls_up_to(const TrafficView& view, const Course& course, const PathLink& link) {
  const double way = link.halt - course.along - course.half_length;
  return course.speed <= view.parameters.rolling_speed && way < view.parameters.near_line &&
         rolls_over(view, course.row, link.connection);
}

/// Remembers that the agent came to a halt before its next link, on the junction where it may wait
/// there, or before the link right behind it where it has priority at the next.
void note_halt(const TrafficView& view, const Course& course, TrafficState& traffic) {
  const RoadNetwork& road = view.model.road;
  const Scene& scene = view.scene;
  const bool stands = has_come_to_a_halt(view, course.row);
  if (!stands && course.speed > view.parameters.rolling_speed) return;
  const double front = course.along + course.half_length;
  for (const PathLink& link : course.path.links) {
    if (link.stop_line < front - 0.3 && front > link.inside + 0.3) continue;
    if (link.halt >= front + view.parameters.near) return;
    if (!stands && !rolls_up_to(view, course, link)) return;
    const Connection& connection = road.connection(link.connection);
    const ConnectionId halted_for =
        halt_counts_for(road, course.path, link, 2.0 * course.half_length);
    const bool has_priority =
        connection.priority == LinkPriority::Major && connection.signal == kNoSignal;
    if (has_priority && halted_for == link.connection) continue;
    if (traffic.halted_for[course.row] != halted_for) {
      traffic.halted_for[course.row] = halted_for;
      traffic.halted_at[course.row] = scene.time;
    }
    return;
  }
}

Course course_of(const TrafficView& view, const Path& path, std::size_t row) {
  const Scene& scene = view.scene;
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const bool remembers = !path.walking && !type.steady_headway;
  return {view.perception.ego[row], path, type, row,
          scene.manners[row].headway_factor *
              (remembers ? headway_memory(view.parameters, scene.time - view.traffic.stood_at[row])
                         : 1.0)};
}

/// Writes the row's own columns of `traffic` alone.
RoadContext road_context(const TrafficView& view, std::size_t row, double dt, TrafficState& traffic,
                         StopPoints& scratch) {
  const Scene& scene = view.scene;
  RoadContext context;
  const Path* path = view.road.path(scene.path[row]);
  if (path == nullptr) return context;
  const Course course = course_of(view, *path, row);
  context.active = true;
  context.speed_limit = std::min(
      path->walking ? path->profile_at(course.along)
                    : foreseen_limit(view.parameters, *path, course.along, course.speed, dt),
      scene.preferred_speed[row]);
  context.merge_to = traffic.merge_to[row];
  context.aside = traffic.lateral_aim[row] - scene.manners[row].path_offset;
  set_geometry(view, course, context);
  if (!view.rules) return context;
  note_halt(view, course, traffic);
  if (path->walking) {
    set_walker_limits(view, course, context);
  } else {
    set_allowed_speed(view, course, dt, scratch, context);
    note_keeping_clear(view, course, context, dt, traffic);
  }
  return context;
}
}  // namespace

void update_road_contexts(const TrafficTick& tick) {
  const TrafficView view = tick.view();
  const Scene& scene = tick.scene;
  tick.waits.rebuild(scene);
  if (tick.rules) tick.approaches.rebuild(view);
  tick.workers.for_each_range(scene.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    StopPoints scratch;
    // a row reads other rows' state but never their new context
    for (std::size_t row = begin; row < end; ++row)
      tick.scene.context[row] = road_context(view, row, tick.dt, tick.traffic, scratch);
  });
}

}  // namespace sumogamma
