#include "ego/episode.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

void GridlockWatch::add(const AgentTypeTable& types, const Scene& scene, std::size_t ego) {
  constexpr double kStands = 0.2, kFor = 30.0, kApart = 15.0;  // [m/s], [s], [m]
  std::size_t all = 0, standing = 0;
  Vec2 middle = Vec2::Zero();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Vec2& place = scene.position[row];
    const bool inside = window_.empty() || (place.x() >= window_[0] && place.x() <= window_[2] &&
                                            place.y() >= window_[1] && place.y() <= window_[3]);
    if (row == ego || !inside || scene.control[row] == Control::Parked ||
        type_of(types, scene.type[row]).kinematics == Kinematics::Holonomic)
      continue;
    ++all;
    if (scene.velocity[row].norm() >= kStands) continue;
    ++standing;
    middle += place;
  }
  const bool away = ego >= scene.size() || standing == 0 ||
                    (scene.position[ego] - middle / static_cast<double>(standing)).norm() > kApart;
  locked_ = 2 * standing > all && away ? locked_ + step_ : 0.0;
  found_ = found_ || locked_ >= kFor;
}

ShareInterval wilson_interval(std::size_t count, std::size_t n) {
  constexpr double z = 1.959963984540054;
  if (n == 0) return {};
  const double total = static_cast<double>(n), share = static_cast<double>(count) / total;
  const double middle = share + z * z / (2.0 * total);
  const double half = z * std::sqrt(share * (1.0 - share) / total + z * z / (4.0 * total * total));
  const double scale = 1.0 + z * z / total;
  // at the ends exactly, whatever rounding leaves
  return {count == 0 ? 0.0 : (middle - half) / scale, count == n ? 1.0 : (middle + half) / scale};
}

}  // namespace sumogamma
