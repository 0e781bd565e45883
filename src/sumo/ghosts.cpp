#include "sumo/ghosts.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

#include "base/units.h"
#include "geometry/oriented_box.h"

namespace sumogamma {

namespace {

/// Is a ghost in the way of a body that jumps sideways by `aside` [m, left positive], as SUMO's
/// lane changes do? Beside it, or so near that whoever is behind would have to brake hard.
bool bars_change(const Scene& scene, std::size_t row, std::size_t ghost, double aside) {
  constexpr BodyMargins kMargins{0.3, 1.5, 1.2, 3.0};
  OrientedBox body = box_of(scene, row);
  body.center += aside * left_of(body.forward);
  return !leaves_room(scene, ghost, body, scene.speed[row], kMargins);
}

/// +1 where the lane with the next higher index is on the left, -1 where it is on the right.
double inner_side(const RoadNetwork& network, const Lane& lane) {
  const bool has_inner = lane.inner != kNoLane;
  const Lane& other = network.lane(has_inner ? lane.inner : lane.outer);
  const Vec2 here = lane.centerline.point_at(0.5 * lane.centerline.length());
  const PolylinePosition place = other.centerline.project(here);
  const bool other_on_left = place.offset < 0.0;
  return other_on_left == has_inner ? 1.0 : -1.0;
}

/// A row's body after `way` [m] along `path`, straight on where that is null: its ends are on it.
OrientedBox body_after(const Scene& scene, std::size_t row, const Path* path, const Vec2& half,
                       double way) {
  const Vec2 heading = direction_of(scene.heading[row]);
  if (path == nullptr) return {scene.position[row] + way * heading, heading, half};
  const double along = scene.path_along[row];
  const Vec2 front = path->line.point_at(along + half.x() + way);
  const Vec2 rear = path->line.point_at(std::max(along - half.x() + way, 0.0));
  const Vec2 chord = front - rear;
  const double length = chord.norm();
  const Vec2 forward = length > 0.1 ? Vec2(chord / length) : heading;
  return {front - half.x() * forward, forward, half};
}

}  // namespace

bool leaves_room(const Scene& scene, std::size_t row, const OrientedBox& body, double speed,
                 const BodyMargins& margins) {
  const Vec2 left = left_of(body.forward);
  const Vec2 way = scene.position[row] - body.center;
  const double across = std::abs(way.dot(left)) - half_extent(scene, row, left) - body.half.y();
  if (across > margins.beside) return true;
  const double ahead = way.dot(body.forward);
  const double gap = std::abs(ahead) - half_extent(scene, row, body.forward) - body.half.x();
  const double theirs = scene.velocity[row].dot(body.forward);
  const double closing = std::max(ahead > 0.0 ? speed - theirs : theirs - speed, 0.0);
  return gap >=
         margins.apart + margins.time * closing + closing * closing / (2.0 * margins.braking);
}

bool has_room_for(const Scene& scene, const SpatialGrid& grid, std::size_t row) {
  return has_room(scene, grid, box_of(scene, row), scene.height[row], scene.speed[row],
                  [&](std::uint32_t other) { return other != row; });
}

bool touches(const Scene& scene, std::size_t row) {
  constexpr double kApart = 0.05, kReach = 20.0;  // [m]
  const OrientedBox own = box_of(scene, row);
  for (std::size_t other = 0; other < scene.size(); ++other)
    if (other != row && (scene.position[other] - own.center).norm() < kReach &&
        separation(own, box_of(scene, other)) < kApart)
      return true;
  return false;
}

bool goes_against(const Lane& lane, const Scene& scene, std::size_t row) {
  const Polyline& line = lane.centerline;
  return line.direction_at(line.project(scene.position[row]).along)
             .dot(direction_of(scene.heading[row])) < 0.0;
}

bool bars_lane_changes(const RoadNetwork& network, const Lane& lane, const Scene& scene,
                       std::size_t row, std::span<const std::uint32_t> ghosts) {
  const auto aside = [&](LaneId other) {
    return other == kNoLane ? 0.0 : 0.5 * (lane.width + network.lane(other).width);
  };
  // the inner lane is the one towards the road's middle
  const double side =
      lane.inner == kNoLane && lane.outer == kNoLane ? 0.0 : inner_side(network, lane);
  const double to[2] = {side * aside(lane.inner), -side * aside(lane.outer)};
  return std::any_of(ghosts.begin(), ghosts.end(), [&](std::uint32_t ghost) {
    return std::any_of(std::begin(to), std::end(to),
                       [&](double by) { return by != 0.0 && bars_change(scene, row, ghost, by); });
  });
}

bool meets_ghosts(const Scene& scene, const SpatialGrid& grid, std::size_t row) {
  constexpr double kTime = 10.0, kLeast = 50.0, kAside = 12.0, kBend = 0.3;  // [s], [m], [m], -
  const Vec2 forward = direction_of(scene.heading[row]);
  bool meets = false;
  grid.visit_within(scene.position[row], kLeast + 2.0 * kTime * scene.speed[row],
                    [&](std::uint32_t other, double) {
                      if (meets || !is_ours(scene.control[other])) return;
                      const Vec2 way = scene.position[other] - scene.position[row];
                      const double comes = -scene.velocity[other].dot(forward);
                      const double ahead = way.dot(forward);
                      meets = ahead > -kAside &&
                              ahead < kLeast + kTime * (scene.speed[row] + std::max(comes, 0.0)) &&
                              std::abs(way.dot(left_of(forward))) < kAside + kBend * ahead;
                    });
  return meets;
}

double speed_behind_ghosts(const Scene& scene, std::size_t row, bool on_foot, const Path* path,
                           std::span<const std::uint32_t> ghosts) {
  constexpr double kStands = 1.0, kSameWay = 0.7;                             // [m/s], cosine
  constexpr double kStep = 0.5, kAside = 0.1, kBefore = 0.5, kDeeper = 0.05;  // [m]
  constexpr double kBraking = 3.0, kReaction = 0.3, kOnFoot = 1.0;            // [m/s^2], [s], [m]
  constexpr double kPasses = 0.8;                                             // [s]
  const double speed = scene.speed[row];
  const double reach =
      on_foot ? kOnFoot : speed * speed / (2.0 * kBraking) + kReaction * speed + 2.0 * kBefore;
  const Vec2 heading = direction_of(scene.heading[row]);
  const OrientedBox own = box_of(scene, row);
  OrientedBox now = own;
  now.half.y() += kAside;
  const OrientedBox next = body_after(scene, row, path, now.half, kStep);
  struct Ahead {
    OrientedBox box;
    double speed;  // along the own way [m/s]
  };
  std::vector<Ahead> ahead;
  for (const std::uint32_t other : ghosts) {
    OrientedBox box = box_of(scene, other);
    const bool same_way = box.forward.dot(heading) > kSameWay;
    // a person lets whoever drives by pass
    const double way = on_foot ? kPasses * scene.speed[other] : 0.0;
    if ((scene.speed[other] > kStands && !same_way && !on_foot) ||
        std::abs(scene.height[other] - scene.height[row]) > kBodiesApart)
      continue;
    box.center += 0.5 * way * box.forward;
    box.half.x() += 0.5 * way;
    // who is close beside it may not get closer; who is in it gets out whichever way it goes
    const double apart = separation(now, box);
    if (apart > 0.0 || (separation(own, box) > 0.0 && separation(next, box) < apart - kDeeper))
      ahead.push_back({box, std::max(scene.velocity[other].dot(heading), 0.0)});
  }
  double most = std::numeric_limits<double>::infinity();
  for (double way = kStep; way <= reach && !ahead.empty(); way += kStep) {
    const OrientedBox body = body_after(scene, row, path, now.half, way);
    std::erase_if(ahead, [&](const Ahead& one) {
      if (separation(body, one.box) > 0.0) return false;
      const double free = std::max(way - kStep - kBefore, 0.0);
      most = std::min(most, std::sqrt(one.speed * one.speed + 2.0 * kBraking * free));
      return true;
    });
  }
  return most;
}

}  // namespace sumogamma
