#include "traffic/walking/walking_place.h"

#include <algorithm>
#include <cmath>

#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// How somebody on the way matters to who is on foot.
enum class InTheWay { Counts, StandsInTheWay, IsLeftToAvoidance };

/// People and who drives along the way count; vehicles that drive across it will have passed.
InTheWay meeting_with(const TrafficView& view, const PathUser& user) {
  if (user.on_foot) return InTheWay::Counts;
  const double speed = view.scene.velocity[user.row].norm();
  if (speed < view.parameters.halting_speed) return InTheWay::StandsInTheWay;
  return std::abs(user.speed) > 0.7 * speed ? InTheWay::Counts : InTheWay::IsLeftToAvoidance;
}

/// Speed that can be hoped for at a place: of those ahead there, the slower and the nearer the
/// less. Who comes the other way counts for less than nothing, so that streams part. Close past a
/// vehicle that stands it is half: avoidance keeps more from it than there is between the bodies.
double hoped_pace(const TrafficView& view, const Surroundings& around, double place,
                  double free_speed) {
  const TrafficParameters& parameters = view.parameters;
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  double hoped = free_speed;
  auto is_near = [&](const PathUser& user, double margin) {
    return user.front >= rear &&
           std::abs(user.offset - place) <= user.half_width + around.half_width + margin;
  };
  auto meet = [&](const PathUser& user, double margin) {
    if (!is_near(user, margin)) return;
    const double gap = user.rear - front;
    hoped = std::min(
        hoped, user.speed + (gap > 0.0 ? gap / parameters.outlook : -parameters.standing_speed));
  };
  for (const PathUser& user : around.users) {
    meet(user, parameters.touching);
    if (is_near(user, parameters.side_clearance) &&
        meeting_with(view, user) == InTheWay::StandsInTheWay)
      hoped = std::min(hoped, parameters.open_share * free_speed);
  }
  for (const PathUser& wall : around.walls) meet(wall, parameters.tight_side);
  return hoped;
}

/// Who gets to where it may have to wait for a crossing keeps to the side where it is off the ways
/// of those who drive.
void keep_to_waiting_room(const TrafficParameters& parameters, const Path& path, double along,
                          double& most_left, double& most_right) {
  for (const PathLink& link : path.links) {
    if (along > link.halt) continue;
    if (along < link.halt - parameters.nearby) return;
    most_left = std::clamp(link.halt_left, most_right, most_left);
    most_right = std::clamp(link.halt_right, most_right, most_left);
    return;
  }
}

/// How far to either side of its path somebody may be [m].
Sides sides_of_way(const TrafficParameters& parameters, const Path& path,
                   const Surroundings& around) {
  const PathStretch& here = path.stretch_at(around.along);
  const double half = around.half_width + 2.0 * parameters.touching;
  return {std::max(here.room_left - half, 0.0), std::max(here.room_right - half, 0.0)};
}

double free_pace(const TrafficView& view, const Path& path, std::size_t row) {
  return std::min(path.profile_at(view.perception.ego[row].along), view.scene.preferred_speed[row]);
}

/// The best of the places between two sides, no further than `reach` from the body [m].
double best_place(const TrafficView& view, const Path& path, const Surroundings& around,
                  std::size_t row, const Sides& sides, double reach) {
  double most_left = sides.left, most_right = -sides.right;
  keep_to_waiting_room(view.parameters, path, around.along, most_left, most_right);
  const double liked = std::clamp(view.scene.manners[row].path_offset, most_right, most_left);
  const double free_speed = free_pace(view, path, row);
  if (hoped_pace(view, around, liked, free_speed) > view.parameters.free_share * free_speed)
    return liked;
  auto worth = [&](double place) {
    return hoped_pace(view, around, place, free_speed) -
           view.parameters.sidestep_cost * std::abs(place - around.offset) -
           view.parameters.sidestep_cost * std::abs(place - liked);
  };
  double best = std::clamp(view.traffic.passing_offset[row], most_right, most_left);
  double most = worth(best) + view.parameters.moving_speed;
  auto weigh = [&](double place) {
    if (place < most_right || place > most_left || std::abs(place - around.offset) > reach) return;
    const double value = worth(place);
    if (value <= most) return;
    best = place;
    most = value;
  };
  weigh(liked);
  for (double aside = view.parameters.fine_step; aside < most_left - most_right;
       aside += view.parameters.fine_step) {
    weigh(liked + aside);
    weigh(liked - aside);
  }
  return best;
}

}  // namespace

double room_off_the_way(const TrafficParameters& parameters, const Path& path,
                        const Surroundings& around, double place) {
  const Sides way = sides_of_way(parameters, path, around);
  const double off = std::max({place - way.left, -place - way.right, 0.0});
  return off > 0.0 ? off + parameters.closed_up_gap : 0.0;
}

double walking_place(const TrafficView& view, const Path& path, Surroundings& around,
                     std::size_t row) {
  // those left to avoidance are not weighed
  std::erase_if(around.users, [&](const PathUser& user) {
    return meeting_with(view, user) == InTheWay::IsLeftToAvoidance;
  });
  const bool stands =
      std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
        return user.front > around.along && meeting_with(view, user) == InTheWay::StandsInTheWay;
      });
  const double farthest = stands ? view.parameters.near : view.parameters.walking_aside,
               reach = stands ? 2.0 * view.parameters.near : view.parameters.walking_aside;
  const Sides way = sides_of_way(view.parameters, path, around);
  const double on_it =
      best_place(view, path, around, row,
                 {std::min(way.left, farthest), std::min(way.right, farthest)}, reach);
  // who has waited for long before a vehicle that shuts its way steps off that, until it is past
  const bool is_off = view.traffic.overtaking_room[row] > 0.0;
  if (!stands || (!is_off && waited(view, row) < Patience::Impatient)) return on_it;
  const double free_speed = free_pace(view, path, row);
  if (hoped_pace(view, around, on_it, free_speed) >
      (is_off ? view.parameters.open_share : view.parameters.shut_share) * free_speed)
    return on_it;
  return best_place(view, path, around, row, {view.parameters.near, view.parameters.near}, reach);
}

}  // namespace sumogamma
