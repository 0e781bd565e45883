#include "traffic/recovery/reversing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/random.h"
#include "geometry/rotation.h"
#include "model/stopping_guard.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

double backward_speed(const Scene& scene, std::size_t row) {
  return std::max(0.0, -scene.velocity[row].dot(direction_of(scene.heading[row])));
}

/// How long this row lets others go first after it has backed out [s].
double courtesy(const TrafficView& view, std::size_t row) {
  const auto second = static_cast<std::uint64_t>(view.scene.time);
  return view.parameters.giving_way_time + random_uniform(1, view.scene.id[row].value, second,
                                                          Draw::Intention, 0.0,
                                                          view.parameters.giving_way_spread);
}

/// Front wheels that bring the rear axle back along the path (pure pursuit backwards).
double lock_along_path(const TrafficView& view, const Path& path, const AgentType& type,
                       std::size_t row) {
  const Scene& scene = view.scene;
  const Vec2 forward = direction_of(scene.heading[row]);
  const Vec2 axle = scene.position[row] - type.rear_axle_to_center * forward;
  const double behind =
      scene.path_along[row] - type.rear_axle_to_center - view.parameters.near_line;
  if (behind < 0.0) return 0.0;
  const Vec2 way = path.line.point_at(behind) - axle;
  return type.wheelbase * 2.0 * cross(forward, way) / std::max(way.squaredNorm(), 1.0);
}

/// Where a vehicle is until it stands if it brakes now, and over the time gap: nobody backs out
/// across the way of who drives past.
OrientedBox ahead_of(const TrafficParameters& parameters, const AgentGeometry& their) {
  const double way = parameters.time_gap * their.velocity.dot(their.forward);
  const double rest = their.braking.half.x() - their.half.x();  // half the way to a stop
  if (way < parameters.crawling_speed * parameters.time_gap || way < 2.0 * rest)
    return their.braking;
  const OrientedBox box = their.box();
  return {box.center + 0.5 * way * box.forward, box.forward, box.half + Vec2(0.5 * way, 0.0)};
}

/// May somebody's body be near a row's own, at a position? Of the bodies of the tick's begin.
bool is_within_reach(const AgentGeometry& own, const Vec2& position, const AgentGeometry& their) {
  const double reach = own.radius + kFarthestCorner;
  return (their.position - position).squaredNorm() <= reach * reach;
}

/// Does a pose keep clear of everybody, or come no closer to who is close?
bool keeps_clear(const TrafficView& view, const TickGeometry& geometry, std::size_t row,
                 const BodyState& body) {
  const AgentGeometry& own = geometry.agent[row];
  const Vec2 forward = direction_of(body.heading);
  const OrientedBox box{body.position + own.shift * forward, forward, own.half};
  const std::vector<std::uint32_t>& near = view.perception.near[row];
  return std::none_of(near.begin(), near.end(), [&](std::uint32_t other) {
    const AgentGeometry& their = geometry.agent[other];
    if (!is_within_reach(own, body.position, their)) return false;
    const double kept = view.parameters.side_clearance + std::min(their.throttle_way, 0.3);
    if (!their.is_box) {
      const double distance = (their.position - body.position).norm();
      return distance <= own.radius + their.radius + kept &&
             distance <= (their.position - own.position).norm();
    }
    const OrientedBox taken = ahead_of(view.parameters, their);
    const double gap = separation(box, taken);
    return gap < kept && gap <= separation(own.box(), taken) - 1e-9;
  });
}

/// Has the gap come into another lane that this row waits for?
bool finds_gap(const TrafficView& view, std::size_t row) {
  const LaneId lane = view.traffic.merge_to[row];
  return lane != kNoLane && lane != view.scene.lane[row].lane &&
         !std::isfinite(view.traffic.gate[row]);
}

/// Is this row right behind one that means to back out, or to make room itself, and can't?
bool makes_room(const TrafficView& view, std::size_t row) {
  const RoadContext& context = view.scene.context[row];
  if (context.reason != LimitReason::Leader || stood(view, row) < Patience::Pressing) return false;
  const std::size_t leader = view.waits.foe(row);
  return leader < view.scene.size() && stood(view, leader) >= Patience::Pressing &&
         view.traffic.backing_left[leader] > 0.0 &&
         view.traffic.backing_left[leader] <
             view.parameters.backing_time - view.parameters.time_gap;
}

/// Is `holds` true of anybody on wheels near a row, one that is itself on wheels?
template <typename Holds>
bool any_wheeled(const TrafficView& view, const TickGeometry& geometry, std::size_t row,
                 Holds holds) {
  const AgentGeometry& own = geometry.agent[row];
  if (!own.on_wheels || !own.is_box) return false;
  const std::vector<std::uint32_t>& near = view.perception.near[row];
  return std::any_of(near.begin(), near.end(), [&](std::uint32_t other) {
    const AgentGeometry& their = geometry.agent[other];
    return their.on_wheels && their.is_box && is_within_reach(own, own.position, their) &&
           holds(other);
  });
}

/// Is a body in the room that another one needs to drive on?
bool is_in_room_of(const TrafficParameters& parameters, const AgentGeometry& body,
                   const AgentGeometry& other) {
  const OrientedBox box = other.box();
  const OrientedBox room{
      box.center + 0.5 * (parameters.near_line - parameters.side_clearance) * box.forward,
      box.forward,
      box.half + Vec2(0.5 * (parameters.near_line + parameters.side_clearance),
                      parameters.side_clearance)};
  return separation(body.box(), room) < 0.0;
}

/// Does this row stand in the way of somebody wedged of whom `concerns` is true?
template <typename Concerns>
bool stands_before(const TrafficView& view, const TickGeometry& geometry, std::size_t row,
                   Concerns concerns) {
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    return is_wedged(view.scene, other) &&
           is_in_room_of(view.parameters, geometry.agent[row], geometry.agent[other]) &&
           concerns(other);
  });
}

/// Does somebody who lets others go first stand in this row's way? It steps back further.
bool is_made_way_for(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    return view.traffic.gives_way_left[other] > 0.0 &&
           is_in_room_of(view.parameters, geometry.agent[other], geometry.agent[row]);
  });
}

/// Does this row stand in the way of somebody wedged, and wait itself for that one or for another
/// who is? Of three who hold each other the one with room behind may wait for the wrong one.
bool stands_in_the_way(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  const auto waits_for_wedged = [&] {
    return view.waits.find_ahead(row, [&](std::size_t one) { return is_wedged(view.scene, one); }) <
           view.waits.size();
  };
  const Scene& scene = view.scene;
  return stood(view, row) >= Patience::Pressing && !is_wedged(scene, row) &&
         !scene.context[row].at_red && stands_before(view, geometry, row, [&](std::size_t other) {
           return blocked(view, other) >= Patience::Pressing &&
                  (view.waits.waits_for(row, other) || waits_for_wedged());
         });
}

/// Has this row rolled back to let others go first, but not far enough for one of them?
bool is_still_in_the_way(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  return backward_speed(view.scene, row) < 1e-2 &&
         stands_before(view, geometry, row, [&](std::size_t other) {
           return blocked(view, other) >= Patience::Waiting;
         });
}

/// Is somebody near in front of a row that lets others go first held up for other reasons than the
/// row?
bool lets_somebody_go(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  const AgentGeometry& own = geometry.agent[row];
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    const Vec2 way = geometry.agent[other].position - own.position;
    return way.dot(own.forward) > 0.0 && waited(view, other) >= Patience::Waiting &&
           !view.waits.waits_for(other, row);
  });
}

/// One that rolls back goes on with it for its time, unless it moves on, and then lets the others
/// go first. Who finds no gap to change lanes and comes up against somebody behind gives way from
/// there. Not for other reasons: that may lock up a large junction.
Backing go_on_backing(const TrafficView& view, std::size_t row, double dt, Backing now) {
  const Scene& scene = view.scene;
  const TrafficParameters& parameters = view.parameters;
  const bool moved_on = scene.speed[row] > parameters.slow_walk;
  const double since = parameters.backing_time - now.left - parameters.reaction_time;
  const bool no_further = scene.context[row].reason == LimitReason::Merge &&
                          backward_speed(scene, row) < 1e-2 && has_moved_within(view, row, since);
  const double left = moved_on || no_further ? 0.0 : now.left - dt;
  if (left > 0.0) return {left, now.gives_way};
  // who made room for somebody follows it again
  const bool rolled = has_moved_within(view, row, parameters.backing_time);
  const bool for_itself = scene.context[row].reason != LimitReason::Leader;
  return {0.0, rolled && for_itself && !moved_on ? courtesy(view, row) : 0.0};
}

/// For how long a row rolls back that does neither that nor lets others go first [s]; 0: not at
/// all. Not before a red light: others wait there, too.
Backing begin_backing(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  const Scene& scene = view.scene;
  if (!scene.context[row].at_red && is_wedged(scene, row) && is_out_of_patience(view, row) &&
      !is_made_way_for(view, geometry, row))
    return {view.parameters.backing_time, 0.0};
  if (makes_room(view, row)) return {view.parameters.backing_time, 0.0};
  if (stands_in_the_way(view, geometry, row))
    return {view.parameters.giving_way_time, 2.0 * view.parameters.giving_way_time};
  return {};
}

/// A row's next state from the frozen ones of everybody.
Backing next_backing(const TrafficView& view, const TickGeometry& geometry, double dt,
                     std::size_t row) {
  Backing now{view.traffic.backing_left[row], std::max(0.0, view.traffic.gives_way_left[row] - dt)};
  if (finds_gap(view, row)) now = {};
  if (now.gives_way > 0.0 && now.left <= 0.0 && stood(view, row) >= Patience::Impatient &&
      !lets_somebody_go(view, geometry, row))
    now.gives_way = 0.0;
  if (now.left > 0.0) return go_on_backing(view, row, dt, now);
  if (now.gives_way <= 0.0) return begin_backing(view, geometry, row);
  if (is_still_in_the_way(view, geometry, row))
    return {view.parameters.giving_way_time, 2.0 * view.parameters.giving_way_time};
  return now;
}

}  // namespace

void update_backing(const TrafficView& view, const TickGeometry& geometry, double dt,
                    Workers& workers, std::vector<Backing>& next, TrafficState& traffic) {
  const std::size_t rows = traffic.size();
  next.resize(rows);
  workers.for_each_range(rows, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      next[row] = next_backing(view, geometry, dt, row);
  });
  for (std::size_t row = 0; row < rows; ++row) {
    traffic.backing_left[row] = next[row].left;
    traffic.gives_way_left[row] = next[row].gives_way;
  }
}

std::optional<BodyState> back_out(const TrafficView& view, const TickGeometry& geometry,
                                  std::size_t row, double dt) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const double now = backward_speed(scene, row);
  const bool backing = traffic.backing_left[row] > 0.0 || now > 1e-2;
  if (!backing || scene.speed[row] > 1e-2) return std::nullopt;
  const AgentGeometry& own = geometry.agent[row];
  const Path* path = view.road.path(scene.path[row]);
  if (path == nullptr || !own.on_wheels || !own.is_box) return std::nullopt;
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const BodyState body = body_of(scene, row);
  // as fast as it can still stop before the time is over and before whoever is behind
  const double speed = std::min({view.parameters.slow_walk, now + view.parameters.easy_braking * dt,
                                 view.parameters.easy_braking * traffic.backing_left[row]});
  const double to_stop = speed * dt + 0.5 * speed * speed / view.parameters.easy_braking;
  // back along its path, or else straight or to a side: who stands beside may leave just that. Who
  // makes room stays on its road
  const double along_path = lock_along_path(view, *path, type, row);
  const double most = std::tan(type.max_steering);
  const std::array locks{along_path, 0.0, most, -most};
  for (const double lock : std::span(locks).first(is_wedged(scene, row) ? 4 : 2)) {
    const auto is_free = [&](double way) {
      return keeps_clear(view, geometry, row, roll_back(type, body, lock, way / dt, dt));
    };
    // a nose that swings may press into somebody on the way to a place that is free
    if (is_free(to_stop) && (now > 1e-2 || is_free(view.parameters.least_gap)))
      return roll_back(type, body, lock, speed, dt);
  }
  if (now <= 1e-2) return std::nullopt;
  return roll_back(type, body, along_path, std::max(0.0, now - view.parameters.easy_braking * dt),
                   dt);
}

}  // namespace sumogamma
