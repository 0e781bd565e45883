#include "traffic/walking/walking_place.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr double kStep = 0.25;      ///< between the places that are weighed [m]
constexpr double kFarthest = 1.5;   ///< from the path where nothing bounds the way [m]
constexpr double kRound = 4.0;      ///< likewise round a vehicle that stands in it [m]
constexpr double kPatience = 4.0;   ///< before who stands in the way [s]
constexpr double kReach = 1.5;      ///< aside from where the body is [m]
constexpr double kToSides = 0.1;    ///< of the way [m]
constexpr double kMargin = 0.06;    ///< kept to the sides [m]
constexpr double kStepCost = 0.15;  ///< of a place away from the body [m/s a m]
constexpr double kLikeCost = 0.15;  ///< of a place away from the liked one [m/s a m]
constexpr double kShut = 0.3;       ///< share of it with which the way is shut
constexpr double kOpen = 0.6;       ///< likewise with which it is open again
constexpr double kFree = 0.95;      ///< share of the speed it likes that is as good as all of it
constexpr double kKeeps = 0.1;      ///< worth changing one's mind for [m/s]

/// How somebody on the way matters to who is on foot.
enum class Meeting { Counts, StandsInTheWay, IsLeftToAvoidance };

/// People and who drives along the way count; vehicles that drive across it will have passed.
Meeting meeting_with(const Scene& scene, const PathUser& user) {
  constexpr double kDrives = 0.5;  // [m/s]
  if (user.on_foot) return Meeting::Counts;
  const double speed = scene.velocity[user.row].norm();
  if (speed < kDrives) return Meeting::StandsInTheWay;
  return std::abs(user.speed) > 0.7 * speed ? Meeting::Counts : Meeting::IsLeftToAvoidance;
}

/// Speed that can be hoped for at a place: of those ahead there, the slower and the nearer the
/// less. Who comes the other way counts for less than nothing, so that streams part. Close past a
/// vehicle that stands it is half: avoidance keeps more from it than there is between the bodies.
double hoped_pace(const Scene& scene, const Surroundings& around, double place, double free_speed) {
  constexpr double kOutlook = 4.0;     // [s]
  constexpr double kBeside = 0.3;      // [m/s]
  constexpr double kWallMargin = 0.2;  // [m]
  constexpr double kAtEase = 0.3;    // from a vehicle that stands; closer by one squeezes past [m]
  constexpr double kSqueezes = 0.5;  // of the speed
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
    hoped = std::min(hoped, user.speed + (gap > 0.0 ? gap / kOutlook : -kBeside));
  };
  for (const PathUser& user : around.users) {
    meet(user, kMargin);
    if (is_near(user, kAtEase) && meeting_with(scene, user) == Meeting::StandsInTheWay)
      hoped = std::min(hoped, kSqueezes * free_speed);
  }
  for (const PathUser& wall : around.walls) meet(wall, kWallMargin);
  return hoped;
}

/// Who gets to where it may have to wait for a crossing keeps to the side where it is off the ways
/// of those who drive.
void keep_to_waiting_room(const Path& path, double along, double& most_left, double& most_right) {
  constexpr double kBefore = 15.0;  // [m]
  for (const PathLink& link : path.links) {
    if (along > link.halt) continue;
    if (along < link.halt - kBefore) return;
    most_left = std::clamp(link.halt_left, most_right, most_left);
    most_right = std::clamp(link.halt_right, most_right, most_left);
    return;
  }
}

/// How far to either side of its path somebody may be [m].
Sides sides_of_way(const Path& path, const Surroundings& around) {
  const PathStretch& here = path.stretch_at(around.along);
  const double half = around.half_width + kToSides;
  return {std::max(here.room_left - half, 0.0), std::max(here.room_right - half, 0.0)};
}

double free_pace(const Path& path, const Scene& scene, const Surroundings& around,
                 std::size_t row) {
  return std::min(path.profile_at(around.along), scene.preferred_speed[row]);
}

/// The best of the places between two sides, no further than `reach` from the body [m].
double best_place(const TrafficView& view, const Path& path, const Surroundings& around,
                  std::size_t row, const Sides& sides, double reach) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  double most_left = sides.left, most_right = -sides.right;
  keep_to_waiting_room(path, around.along, most_left, most_right);
  const double liked = std::clamp(scene.manners[row].path_offset, most_right, most_left);
  const double free_speed = free_pace(path, scene, around, row);
  if (hoped_pace(scene, around, liked, free_speed) > kFree * free_speed) return liked;
  auto worth = [&](double place) {
    return hoped_pace(scene, around, place, free_speed) -
           kStepCost * std::abs(place - around.offset) - kLikeCost * std::abs(place - liked);
  };
  double best = std::clamp(traffic.passing_offset[row], most_right, most_left);
  double most = worth(best) + kKeeps;
  auto weigh = [&](double place) {
    if (place < most_right || place > most_left || std::abs(place - around.offset) > reach) return;
    const double value = worth(place);
    if (value <= most) return;
    best = place;
    most = value;
  };
  weigh(liked);
  for (double aside = kStep; aside < most_left - most_right; aside += kStep) {
    weigh(liked + aside);
    weigh(liked - aside);
  }
  return best;
}

}  // namespace

double room_off_the_way(const Path& path, const Surroundings& around, double place) {
  constexpr double kBeyond = 1.0;  // the place itself, so that nobody slows down towards it [m]
  const Sides way = sides_of_way(path, around);
  const double off = std::max({place - way.left, -place - way.right, 0.0});
  return off > 0.0 ? off + kBeyond : 0.0;
}

double walking_place(const TrafficView& view, const Path& path, Surroundings& around,
                     std::size_t row) {
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  // those left to avoidance are not weighed
  std::erase_if(around.users, [&](const PathUser& user) {
    return meeting_with(scene, user) == Meeting::IsLeftToAvoidance;
  });
  const bool stands =
      std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
        return user.front > around.along && meeting_with(scene, user) == Meeting::StandsInTheWay;
      });
  const double farthest = stands ? kRound : kFarthest, reach = stands ? 2.0 * kRound : kReach;
  const Sides way = sides_of_way(path, around);
  const double on_it =
      best_place(view, path, around, row,
                 {std::min(way.left, farthest), std::min(way.right, farthest)}, reach);
  // who has waited for long before a vehicle that shuts its way steps off that, until it is past
  const bool is_off = traffic.overtaking_room[row] > 0.0;
  if (!stands || (!is_off && traffic.waiting_time[row] <= kPatience)) return on_it;
  const double free_speed = free_pace(path, scene, around, row);
  if (hoped_pace(scene, around, on_it, free_speed) > (is_off ? kOpen : kShut) * free_speed)
    return on_it;
  return best_place(view, path, around, row, {kRound, kRound}, reach);
}

}  // namespace sumogamma
