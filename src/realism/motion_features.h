#pragma once

#include <cstdint>
#include <vector>

#include "realism/window.h"

namespace sumogamma {

/// What the score looks at, by row and step; not a number where there is none (before a difference
/// can be taken, after the body has left).
struct MotionFeatures {
  std::vector<double> speed;             ///< [m/s]
  std::vector<double> acceleration;      ///< change of speed [m/s^2]
  std::vector<double> yaw_rate;          ///< change of heading [rad/s]
  std::vector<double> yaw_acceleration;  ///< [rad/s^2]
  std::vector<double> nearest;           ///< signed distance to the nearest other box, up to 40 [m]
  std::vector<double> time_to_collision;  ///< to who is ahead, up to 5 [s]
  std::vector<double> gap;  ///< to the nearest who is ahead; infinite where nobody is [m]
  // with a map alone (MapFeatures), else empty
  std::vector<double> road_edge;      ///< of the corner that is farthest out, negative inside [m]
  std::vector<std::uint8_t> ran_red;  ///< by row: whether it crossed a stop line at red
};

/// Signed distance of two boxes (length, width): negative where they overlap, then minus the least
/// displacement that separates them [m].
double signed_distance(const MotionState& a, const Vec2& size_a, const MotionState& b,
                       const Vec2& size_b);

/// The features that the Waymo Open Sim Agents Challenge (Montali et al. 2023, arXiv 2305.12032)
/// scores and that need no map; those that do are left empty. Speed and yaw rate are central
/// differences over 0.2 s, the two accelerations central differences of these. Others count within
/// 50 m of the centres. Ahead of somebody is whom its own strip meets: its box laterally overlaps
/// the other's extent across it, with headings within 75 degrees, or 10 where the overlap is under
/// 0.5 m; the time to collision is the gap over the speed at which it closes along the own heading.
MotionFeatures features_of(const Poses& poses, const Bodies& bodies);

/// Does a row's box overlap another at any step?
bool collides(const MotionFeatures& features, std::size_t row);

}  // namespace sumogamma
