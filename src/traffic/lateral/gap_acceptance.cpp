#include "traffic/lateral/gap_acceptance.h"

#include <algorithm>
#include <cmath>

#include "geometry/smooth_step.h"
#include "scene/extent.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/longitudinal/leader.h"
#include "traffic/patience.h"

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
bool leaves_room_for_nose(const TrafficParameters& parameters, const Surroundings& around,
                          const PathUser& user) {
  return user.front < around.along + around.half_length -
                          nose_room(parameters, 2.0 * around.half_length) +
                          parameters.line_tolerance;
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
  const double front = around.along + around.half_length, rear = around.along - around.half_length;
  for (const PathUser& user : around.users) {
    // whom the path comes up to only in that lane is followed anyway
    if (0.5 * (user.rear + user.front) > lane.to) continue;
    // a path that moves over is askew to the lanes
    const double half_width =
        std::min(user.half_width, half_extent(scene, user.row, left_of(around.tangent)));
    const bool there = std::abs(aside_of(scene, user, lane)) <=
                       half_width + around.half_width + view.parameters.side_clearance;
    if (!there && !comes_between(around, user, lane)) continue;
    // who lets us in keeps no headway for it, but brakes no harder than is courteous
    const bool lets_us_in = user.front < front && waits_for_row(scene, user, row);
    // who stands beside our tail or behind it and holds, or has stepped back to let others go
    // first, leaves the way for our nose
    const bool holds = lets_us_in || traffic.gives_way_left[user.row] > 0.0;
    if (user.rear < front && holds && leaves_room_for_nose(view.parameters, around, user) &&
        user.speed < view.parameters.standing_speed)
      continue;
    if (user.rear < front && user.front > rear) return false;
    const bool ahead = user.rear >= front;
    const double gap = ahead ? user.rear - front : rear - user.front;
    const Vec2 tangent = around.tangent;
    auto acceleration = [&](std::size_t who) { return scene.acceleration[who].dot(tangent); };
    const double behind_speed = std::max(ahead ? around.speed : user.speed, 0.0);
    const Followed followed{gap - view.parameters.least_gap, ahead ? user.speed : around.speed,
                            acceleration(ahead ? user.row : row)};
    const double needed = braking_behind(behind_speed, followed);
    const double least =
        lets_us_in
            ? 0.5 * view.parameters.least_gap + 0.5 * view.parameters.reaction_time * behind_speed
            : view.parameters.least_gap + view.parameters.reaction_time * behind_speed;
    if (gap < least || needed > (lets_us_in ? view.parameters.courtesy_braking : braking))
      return false;
  }
  return true;
}

bool is_contested(const TrafficView& view, const Surroundings& around, std::size_t row,
                  LaneId target, const LaneBeside& lane) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const double front = around.along + around.half_length, rear = around.along - around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const bool other_side = aside_of(scene, user, lane) * lane.shift > 0.0;
    const bool waits = std::isfinite(traffic.gate[user.row]) ||
                       stood(view, user.row) >= Patience::Waiting ||
                       waits_for_row(scene, user, row);
    return other_side && traffic.merge_to[user.row] == target && !waits &&
           user.rear < front + view.parameters.near_line &&
           user.front > rear - view.parameters.near_line &&
           (traffic.merge_to[row] != target || scene.id[user.row] < scene.id[row]);
  });
}

bool is_let_in(const TrafficView& view, const Surroundings& around, std::size_t row,
               const LaneBeside& lane) {
  const Scene& scene = view.scene;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const double aside = std::abs(aside_of(scene, user, lane));
    // who follows in our own lane, be it half in the other, waits for us but leaves no gap there
    return leaves_room_for_nose(view.parameters, around, user) && waits_for_row(scene, user, row) &&
           aside < user.half_width + around.half_width && aside < std::abs(user.offset);
  });
}

bool is_beside(const TrafficView& view, const Surroundings& around, std::size_t row) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const double front = around.along + around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    // who waits for a gap itself, or for us, isn't waited for
    const bool waits = stood(view, user.row) >= Patience::Waiting &&
                       (std::isfinite(traffic.gate[user.row]) || waits_for_row(scene, user, row));
    return user.aligned && !waits && user.rear < front && user.front > front &&
           std::abs(user.offset) <
               user.half_width + around.half_width + view.parameters.side_clearance &&
           std::abs(user.offset - around.offset) >
               user.half_width + around.half_width - view.parameters.side_clearance;
  });
}

}  // namespace sumogamma
