#include "model/passing.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr double kNarrow = 1.2;    ///< vehicles below this width share lanes [m]
constexpr double kFarthest = 2.3;  ///< aside [m]
constexpr double kGain = 1.0;      ///< worth passing for [m/s]

/// What is left between two bodies side by side [m].
double side_gap(bool narrow, double speed) {
  return narrow ? 0.25 + 0.02 * speed : 0.45 + 0.03 * speed;
}

/// Is the body on a junction, or about to be?
bool is_near_junction(const Path& path, const Surroundings& around) {
  const double ahead = around.along + around.half_length + 8.0 + 1.5 * around.speed;
  return std::any_of(path.links.begin(), path.links.end(), [&](const PathLink& link) {
    return link.stop_line < ahead && link.end > around.along - around.half_length;
  });
}

}  // namespace

double passing_offset(const Model& model, const Path& path, const Scene& scene,
                      const Surroundings& around, std::size_t row) {
  const double free_speed = std::min(path.profile_at(around.along), scene.preferred_speed[row]);
  const PathStretch& here = path.stretch_at(around.along);
  const double half = around.half_width;
  const double most_left = here.room_left - half - 0.15, most_right = half + 0.15 - here.room_right;
  const double liked =
      std::clamp(scene.path_offset[row], std::min(most_right, 0.0), std::max(most_left, 0.0));
  const double margin = 0.15;
  double best = liked;
  double most = hoped_speed(around, liked, free_speed, margin);
  // what was begun is gone on with unless something is clearly better
  const double present = scene.passing_offset[row];
  if (std::abs(present - liked) > 0.2 && present <= most_left && present >= most_right) {
    const double hoped = hoped_speed(around, present, free_speed, 0.8 * margin);
    if (hoped > most + 0.3) {
      best = present;
      most = hoped;
    }
  }
  if (most > 0.8 * free_speed) return best;

  const bool narrow = 2.0 * half < kNarrow;
  // wide vehicles keep to their lane where ways cross
  if (!narrow && is_near_junction(path, around)) return liked;
  const double inner_side = model.road.left_hand ? -1.0 : 1.0;
  const double base = most;
  const double gap_wanted = side_gap(narrow, around.speed);
  for (const RoadUser& user : around.users) {
    if ((!user.aligned && !user.on_foot) || user.front < around.along - around.half_length ||
        user.rear > around.along + around.half_length + 10.0 + 3.0 * around.speed)
      continue;
    if (!narrow && user.half_width > 0.5 * kNarrow) continue;
    // only who is in the way is passed, and not by changing lanes
    if (std::abs(user.offset - liked) > user.half_width + half + gap_wanted) continue;
    for (const double side : {inner_side, -inner_side}) {
      if (!narrow && side != inner_side) continue;
      const double offset = user.offset + side * (user.half_width + half + gap_wanted);
      if (offset > most_left || offset < most_right || std::abs(offset - liked) > kFarthest)
        continue;
      const double hoped = hoped_speed(around, offset, free_speed, 0.9 * gap_wanted);
      if (hoped > std::max(most, base + kGain)) {
        best = offset;
        most = hoped;
      }
    }
  }
  return best;
}

}  // namespace sumogamma
