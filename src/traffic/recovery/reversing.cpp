#include "traffic/recovery/reversing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/random.h"
#include "geometry/rotation.h"
#include "model/stopping_guard.h"

namespace sumogamma {

namespace {

constexpr double kPace = 0.48;          // walking backwards [m/s]
constexpr double kThrottle = 1.0;       // [m/s^2]
constexpr double kBrake = 2.0;          // [m/s^2]
constexpr double kLeast = 8.0;          // wedged for so long before anybody backs out [s]
constexpr double kStagger = 8.0;        // and up to so much longer, so that not all do at once [s]
constexpr double kTries = 14.0;         // rolls back for so long at the most [s]
constexpr double kStarts = 0.5;         // until it rolls [s]
constexpr double kMakesRoom = 12.0;     // likewise who lets somebody back out [s]
constexpr double kStepsBack = 5.0;      // likewise who stands in somebody's way [s]
constexpr double kHeldUp = 8.0;         // and has stood for so long before [s]
constexpr double kGivesWay = 6.0;       // then let others go first, for so long at the least [s]
constexpr double kStaggerAfter = 18.0;  // and up to so much longer [s]
constexpr double kClear = 0.25;         // kept to everybody behind [m]
constexpr double kRoomToBegin = 0.5;    // [m]
constexpr double kTarget = 3.0;         // behind the rear axle, aimed at on the path [m]
constexpr double kStill = 0.01;         // [m/s]
constexpr int kLongest = 12;            // chain of those who wait for one another

double backward_speed(const Scene& scene, std::size_t row) {
  return std::max(0.0, -scene.velocity[row].dot(direction_of(scene.heading[row])));
}

/// How long this row stands wedged before it backs out [s]: drawn anew for each stretch of time.
double patience(const Scene& scene, std::size_t row) {
  const auto stretch = static_cast<std::uint64_t>(scene.time / (kLeast + kStagger));
  return kLeast + random_uniform(0, scene.id[row].value, stretch, Draw::Intention, 0.0, kStagger);
}

/// How long this row lets others go first after it has backed out [s].
double courtesy(const Scene& scene, std::size_t row) {
  return kGivesWay + random_uniform(1, scene.id[row].value, static_cast<std::uint64_t>(scene.time),
                                    Draw::Intention, 0.0, kStaggerAfter);
}

/// Front wheels that bring the rear axle back along the path (pure pursuit backwards).
double lock_along_path(const Path& path, const Scene& scene, const AgentType& type,
                       std::size_t row) {
  const Vec2 forward = direction_of(scene.heading[row]);
  const Vec2 axle = scene.position[row] - type.rear_axle_to_center * forward;
  const double behind = scene.path_along[row] - type.rear_axle_to_center - kTarget;
  if (behind < 0.0) return 0.0;
  const Vec2 way = path.line.point_at(behind) - axle;
  return type.wheelbase * 2.0 * cross(forward, way) / std::max(way.squaredNorm(), 1.0);
}

/// Where a vehicle is until it stands if it brakes now, and over the next second: nobody backs out
/// across the way of who drives past.
OrientedBox ahead_of(const AgentGeometry& their) {
  constexpr double kDrivesPast = 1.0;  // [m/s]
  constexpr double kAhead = 1.0;       // [s]
  const double way = kAhead * their.velocity.dot(their.forward);
  const double rest = their.braking.half.x() - their.half.x();  // half the way to a stop
  if (way < kDrivesPast * kAhead || way < 2.0 * rest) return their.braking;
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
  return std::none_of(view.perception.near[row].begin(), view.perception.near[row].end(),
                      [&](std::uint32_t other) {
                        const AgentGeometry& their = geometry.agent[other];
                        if (!is_within_reach(own, body.position, their)) return false;
                        const double kept = kClear + std::min(their.throttle_way, 0.3);
                        if (!their.is_box) {
                          const double distance = (their.position - body.position).norm();
                          return distance <= own.radius + their.radius + kept &&
                                 distance <= (their.position - own.position).norm();
                        }
                        const OrientedBox taken = ahead_of(their);
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
  constexpr double kTried = 1.0;  // [s]
  const RoadContext& context = view.scene.context[row];
  if (context.reason != LimitReason::Leader || view.scene.held[row].standing < kHeldUp)
    return false;
  const std::size_t leader = foe_row(view.scene, row);
  return leader < view.scene.size() && view.scene.held[leader].standing > kHeldUp &&
         view.traffic.backing_left[leader] > 0.0 &&
         view.traffic.backing_left[leader] < kTries - kTried;
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
bool is_in_room_of(const AgentGeometry& body, const AgentGeometry& other) {
  constexpr double kWay = 2.0, kBeside = 0.4;  // [m]
  const OrientedBox box = other.box();
  const OrientedBox room{box.center + 0.5 * (kWay - kBeside) * box.forward, box.forward,
                         box.half + Vec2(0.5 * (kWay + kBeside), kBeside)};
  return separation(body.box(), room) < 0.0;
}

/// Does this row stand in the way of somebody wedged of whom `concerns` is true?
template <typename Concerns>
bool stands_before(const TrafficView& view, const TickGeometry& geometry, std::size_t row,
                   Concerns concerns) {
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    return is_wedged(view.scene, other) &&
           is_in_room_of(geometry.agent[row], geometry.agent[other]) && concerns(other);
  });
}

/// Does somebody who lets others go first stand in this row's way? It steps back further.
bool is_made_way_for(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    return view.traffic.gives_way_left[other] > 0.0 &&
           is_in_room_of(geometry.agent[other], geometry.agent[row]);
  });
}

/// Does a row wait for another, be it over others?
bool is_in_chain_behind(const Scene& scene, std::size_t row, std::size_t other) {
  return waits_for(scene, row, other, kLongest,
                   [&](std::size_t waiting) { return foe_row(scene, waiting); });
}

/// Is there somebody wedged at the end of the chain of those who wait for one another from this row
/// on?
bool waits_for_wedged(const Scene& scene, std::size_t row) {
  std::size_t last = row;
  for (int k = 0; k < kLongest; ++k) {
    const std::size_t next = foe_row(scene, last);
    if (next >= scene.size()) break;
    last = next;
  }
  return last != row && is_wedged(scene, last);
}

/// Does this row stand in the way of somebody wedged, and wait itself for that one or for another
/// who is? Of three who hold each other the one with room behind may wait for the wrong one.
bool stands_in_the_way(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  const Scene& scene = view.scene;
  constexpr double kLong = 12.0;  // [s]
  return scene.held[row].standing > kLong && !is_wedged(scene, row) && !scene.context[row].at_red &&
         stands_before(view, geometry, row, [&](std::size_t other) {
           return scene.held[other].blocked > kHeldUp &&
                  (is_in_chain_behind(scene, row, other) || waits_for_wedged(scene, row));
         });
}

/// Has this row rolled back to let others go first, but not far enough for one of them?
bool is_still_in_the_way(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  constexpr double kSees = 3.0;  // [s]
  return backward_speed(view.scene, row) < kStill &&
         stands_before(view, geometry, row,
                       [&](std::size_t other) { return view.scene.held[other].blocked > kSees; });
}

/// Is somebody near in front of a row that lets others go first held up for other reasons than the
/// row?
bool lets_somebody_go(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  constexpr double kHeld = 2.0;  // [s]
  const AgentGeometry& own = geometry.agent[row];
  return any_wheeled(view, geometry, row, [&](std::size_t other) {
    const Vec2 way = geometry.agent[other].position - own.position;
    return way.dot(own.forward) > 0.0 && view.traffic.waiting_time[other] > kHeld &&
           !is_in_chain_behind(view.scene, other, row);
  });
}

/// One that rolls back goes on with it for its time, unless it moves on, and then lets the others
/// go first. Who finds no gap to change lanes and comes up against somebody behind gives way from
/// there. Not for other reasons: that may lock up a large junction.
Backing go_on_backing(const Scene& scene, std::size_t row, double dt, Backing now) {
  const bool moved_on = scene.speed[row] > kPace;
  const double standing = scene.held[row].standing;
  const bool no_further = scene.context[row].reason == LimitReason::Merge &&
                          backward_speed(scene, row) < kStill &&
                          standing < kTries - now.left - kStarts;
  const double left = moved_on || no_further ? 0.0 : now.left - dt;
  if (left > 0.0) return {left, now.gives_way};
  // who made room for somebody follows it again
  const bool rolled = standing < kTries;
  const bool for_itself = scene.context[row].reason != LimitReason::Leader;
  return {0.0, rolled && for_itself && !moved_on ? courtesy(scene, row) : 0.0};
}

/// For how long a row rolls back that does neither that nor lets others go first [s]; 0: not at
/// all. Not before a red light: others wait there, too.
Backing begin_backing(const TrafficView& view, const TickGeometry& geometry, std::size_t row) {
  const Scene& scene = view.scene;
  if (!scene.context[row].at_red && is_wedged(scene, row) &&
      scene.held[row].blocked > patience(scene, row) && !is_made_way_for(view, geometry, row))
    return {kTries, 0.0};
  if (makes_room(view, row)) return {kMakesRoom, 0.0};
  if (stands_in_the_way(view, geometry, row)) return {kStepsBack, kStepsBack + kGivesWay};
  return {};
}

/// A row's next state from the frozen ones of everybody.
Backing next_backing(const TrafficView& view, const TickGeometry& geometry, double dt,
                     std::size_t row) {
  const Scene& scene = view.scene;
  Backing now{view.traffic.backing_left[row], std::max(0.0, view.traffic.gives_way_left[row] - dt)};
  if (finds_gap(view, row)) now = {};
  if (now.gives_way > 0.0 && now.left <= 0.0 && scene.held[row].standing > kGivesWay &&
      !lets_somebody_go(view, geometry, row))
    now.gives_way = 0.0;
  if (now.left > 0.0) return go_on_backing(scene, row, dt, now);
  if (now.gives_way <= 0.0) return begin_backing(view, geometry, row);
  if (is_still_in_the_way(view, geometry, row)) return {kStepsBack, kStepsBack + kGivesWay};
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
  const bool backing = traffic.backing_left[row] > 0.0 || now > kStill;
  if (!backing || scene.speed[row] > kStill) return std::nullopt;
  const AgentGeometry& own = geometry.agent[row];
  const Path* path = view.road.path(scene.path[row]);
  if (path == nullptr || !own.on_wheels || !own.is_box) return std::nullopt;
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const BodyState body = body_of(scene, row);
  // as fast as it can still stop before the time is over and before whoever is behind
  const double speed = std::min({kPace, now + kThrottle * dt, kBrake * traffic.backing_left[row]});
  const double to_stop = speed * dt + 0.5 * speed * speed / kBrake;
  // back along its path, or else straight or to a side: who stands beside may leave just that. Who
  // makes room stays on its road
  const double along_path = lock_along_path(*path, scene, type, row);
  const double most = std::tan(type.max_steering);
  const std::array locks{along_path, 0.0, most, -most};
  for (const double lock : std::span(locks).first(is_wedged(scene, row) ? 4 : 2)) {
    const auto is_free = [&](double way) {
      return keeps_clear(view, geometry, row, roll_back(type, body, lock, way / dt, dt));
    };
    // a nose that swings may press into somebody on the way to a place that is free
    if (is_free(to_stop) && (now > kStill || is_free(kRoomToBegin)))
      return roll_back(type, body, lock, speed, dt);
  }
  if (now <= kStill) return std::nullopt;
  return roll_back(type, body, along_path, std::max(0.0, now - kBrake * dt), dt);
}

}  // namespace sumogamma
