#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "geometry/oriented_box.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Where the middle of a rear axle is and where it points.
struct AxlePose {
  Vec2 position = Vec2::Zero();  ///< [m]
  double heading = 0;            ///< [rad]
};

/// A body on wheels as planning sees it.
struct WheeledShape {
  double wheelbase = 0;            ///< [m]
  double rear_axle_to_center = 0;  ///< [m]
  double length = 0, width = 0;    ///< [m]
  double max_steering = 0;         ///< [rad]

  double turning_radius() const { return wheelbase / std::tan(max_steering); }  ///< rear axle's [m]
};

/// A type's body, steered within `most` [rad] though it might turn its wheels further.
inline WheeledShape wheeled_shape(const AgentType& type, double most = 0.6108652381980153) {
  return {type.wheelbase, type.rear_axle_to_center, type.length, type.width,
          std::min(type.max_steering, most)};
}

/// The body at a pose, `margin` [m] larger on all sides.
inline OrientedBox body_at(const WheeledShape& shape, const AxlePose& pose, double margin = 0) {
  const Vec2 forward = direction_of(pose.heading);
  return {pose.position + shape.rear_axle_to_center * forward, forward,
          Vec2(shape.length / 2 + margin, shape.width / 2 + margin)};
}

/// Does a body overlap one of others?
inline bool overlaps_any(const OrientedBox& body, std::span<const OrientedBox> others) {
  const double reach = body.half.norm();
  return std::any_of(others.begin(), others.end(), [&](const OrientedBox& other) {
    return (other.center - body.center).norm() < reach + other.half.norm() &&
           separation(body, other) < 0.0;
  });
}

/// The pose after rolling `distance` [m] on an arc of so much curvature [1/m], positive left.
inline AxlePose rolled(const AxlePose& from, double distance, double curvature) {
  const double turn = distance * curvature;
  // chord over arc, 1 where the arc is straight
  const double share = std::abs(turn) < 1e-6 ? 1.0 : 2 * std::sin(turn / 2) / turn;
  return {from.position + distance * share * direction_of(from.heading + turn / 2),
          from.heading + turn};
}

/// An angle within (-pi, pi].
inline double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

}  // namespace sumogamma
