#include "traffic/lateral/gap_acceptance.h"

#include <algorithm>
#include <cmath>

#include "geometry/smooth_step.h"
#include "scene/extent.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/leader.h"

namespace sumogamma {

namespace {

/// How far somebody's middle is beside the middle of the lane [m].
double aside_of(const Scene& scene, const PathUser& user, const LaneBeside& lane) {
  if (lane.middle != nullptr) {
    const PolylinePosition place = lane.middle->project(scene.position[user.row]);
    if (place.along > 0.0 && place.along < lane.middle->length()) return place.offset;
  }
  return user.offset - lane.offset_at(0.5 * (user.rear + user.front));
}

/// Does somebody wait for this row?
bool waits_for_row(const Scene& scene, const PathUser& user, std::size_t row) {
  return scene.context[user.row].foe == static_cast<std::int64_t>(scene.id[row].value);
}

/// Is somebody so far behind that it leaves the way for the agent's nose?
bool leaves_room_for_nose(const Surroundings& around, const PathUser& user) {
  constexpr double kTooFar = 0.3;  // who halts for somebody rolls on by a hand's breadth [m]
  return user.front <
         around.along + around.half_length - nose_room(2.0 * around.half_length) + kTooFar;
}

/// Does somebody come from behind, faster, between the agent and the lane, so that whoever moves
/// over cuts it off?
bool comes_between(const Surroundings& around, const PathUser& user, const LaneBeside& lane) {
  const double side = std::copysign(1.0, lane.shift);
  return user.aligned && user.front < around.along - around.half_length &&
         user.speed > around.speed && side * (lane.shift - user.offset) > 0.0 &&
         side * (user.offset - around.offset) > user.half_width + around.half_width;
}

}  // namespace

double LaneBeside::offset_at(double along) const {
  if (along <= from) return shift;
  return shift * (1.0 - smooth_step(std::min((along - from) / (to - from), 1.0)));
}

bool is_gap(const TrafficView& view, const Surroundings& around, std::size_t row,
            const LaneBeside& lane, double braking) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  constexpr double kLeast = 0.5, kLeastTime = 0.35;  // [m], [s]
  constexpr double kClose = 0.3, kCloseTime = 0.15;  // [m], [s]
  constexpr double kCourtesy = 2.0, kLeft = 0.4;     // [m/s^2], [m]
  constexpr double kHolds = 0.3, kSides = 0.3;       // [m/s], [m]
  const double front = around.along + around.half_length, rear = around.along - around.half_length;
  for (const PathUser& user : around.users) {
    // whom the path comes up to only in that lane is followed anyway
    if (0.5 * (user.rear + user.front) > lane.to) continue;
    // a path that moves over is askew to the lanes
    const double half_width =
        std::min(user.half_width, half_extent(scene, user.row, left_of(around.tangent)));
    const bool there =
        std::abs(aside_of(scene, user, lane)) <= half_width + around.half_width + kSides;
    if (!there && !comes_between(around, user, lane)) continue;
    // who lets us in keeps no headway for it, but brakes no harder than is courteous
    const bool lets_us_in = user.front < front && waits_for_row(scene, user, row);
    // who stands beside our tail or behind it and holds, or has stepped back to let others go
    // first, leaves the way for our nose
    const bool holds = lets_us_in || traffic.gives_way_left[user.row] > 0.0;
    if (user.rear < front && holds && leaves_room_for_nose(around, user) && user.speed < kHolds)
      continue;
    if (user.rear < front && user.front > rear) return false;
    const bool ahead = user.rear >= front;
    const double gap = ahead ? user.rear - front : rear - user.front;
    const Vec2 tangent = around.tangent;
    auto acceleration = [&](std::size_t who) { return scene.acceleration[who].dot(tangent); };
    const double behind_speed = std::max(ahead ? around.speed : user.speed, 0.0);
    const Followed followed{gap - kLeft, ahead ? user.speed : around.speed,
                            acceleration(ahead ? user.row : row)};
    const double needed = braking_behind(behind_speed, followed);
    const double least =
        lets_us_in ? kClose + kCloseTime * behind_speed : kLeast + kLeastTime * behind_speed;
    if (gap < least || needed > (lets_us_in ? kCourtesy : braking)) return false;
  }
  return true;
}

bool is_contested(const TrafficView& view, const Surroundings& around, std::size_t row,
                  LaneId target, const LaneBeside& lane) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  constexpr double kHalts = 2.0, kNear = 2.0;  // [s], [m]
  const double front = around.along + around.half_length, rear = around.along - around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const bool other_side = aside_of(scene, user, lane) * lane.shift > 0.0;
    const bool waits = std::isfinite(traffic.gate[user.row]) ||
                       scene.held[user.row].standing > kHalts || waits_for_row(scene, user, row);
    return other_side && traffic.merge_to[user.row] == target && !waits &&
           user.rear < front + kNear && user.front > rear - kNear &&
           (traffic.merge_to[row] != target || scene.id[user.row] < scene.id[row]);
  });
}

bool is_let_in(const TrafficView& view, const Surroundings& around, std::size_t row,
               const LaneBeside& lane) {
  const Scene& scene = view.scene;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const double aside = std::abs(aside_of(scene, user, lane));
    // who follows in our own lane, be it half in the other, waits for us but leaves no gap there
    return leaves_room_for_nose(around, user) && waits_for_row(scene, user, row) &&
           aside < user.half_width + around.half_width && aside < std::abs(user.offset);
  });
}

bool is_beside(const TrafficView& view, const Surroundings& around, std::size_t row) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  constexpr double kSide = 0.3;   // [m]
  constexpr double kWaits = 1.0;  // [s]
  const double front = around.along + around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    // who waits for a gap itself, or for us, isn't waited for
    const bool waits = scene.held[user.row].standing > kWaits &&
                       (std::isfinite(traffic.gate[user.row]) || waits_for_row(scene, user, row));
    return user.aligned && !waits && user.rear < front && user.front > front &&
           std::abs(user.offset) < user.half_width + around.half_width + kSide &&
           std::abs(user.offset - around.offset) > user.half_width + around.half_width - kSide;
  });
}

}  // namespace sumogamma
