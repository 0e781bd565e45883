#pragma once

#include "model/model.h"
#include "scene/scene.h"

namespace sumogamma {

/// State of one body: what the low-level controller reads and moves.
struct BodyState {
  Vec2 position = Vec2::Zero();  ///< footprint centre [m]
  double heading = 0;            ///< [rad]
  Vec2 velocity = Vec2::Zero();  ///< of the centre [m/s]
  double speed = 0;              ///< of the rear axle along the heading, >= 0 [m/s]
  double steering = 0;           ///< front wheel angle, positive left [rad]
};

/// One step of a type's low-level controller and body: f_A of Eq. 1 is this, iterated.
/// Holonomic: the velocity moves to the asked one within the limits of acceleration, the heading
/// turns after it. Single track: the steering law points the centre's own velocity along the asked
/// one, within steering angle, steering rate and lateral acceleration; speed follows within
/// acceleration and braking limits; the body rolls about its rear axle on an exact arc, so it never
/// slides sideways, turns on the spot or rolls backwards. Velocity out = displacement / dt. A
/// velocity that is not finite counts as null.
BodyState advance_body(const AgentType& type, const BodyState& body, const Vec2& velocity,
                       double dt);

/// What advance_body computes on its way, for whoever goes on from there.
struct Advanced {
  BodyState body;
  Vec2 forward = Vec2(1, 0);  ///< unit heading of `body`
  double lock = 0;            ///< tangent of its steering angle
};

/// The same from a body whose unit heading `forward` is known.
Advanced advance_body(const AgentType& type, const BodyState& body, const Vec2& forward,
                      const Vec2& velocity, double dt);

/// How far ahead [m] on a circle the direction has to be asked for that keeps a wheeled body on it.
double steering_lead(const AgentType& type, double speed);

/// One step backwards at `speed` [m/s, >= 0] with the front wheels turned towards `lock` (tangent
/// of their angle) within angle and rate: on an exact arc of the rear axle, too. For backing out
/// (see backing) alone; single track only. The forward speed of the result is 0.
BodyState roll_back(const AgentType& type, const BodyState& body, double lock, double speed,
                    double dt);

/// The body of a row as it stands.
BodyState body_of(const Scene& scene, std::size_t row);
/// Puts it there: the row's place, heading, velocity, speed and steering.
void place_body(const BodyState& body, Scene& scene, std::size_t row);

/// advance_body for one row of a scene.
BodyState track_velocity(const Model& model, const Scene& scene, std::size_t row,
                         const Vec2& velocity, double dt);

}  // namespace sumogamma
