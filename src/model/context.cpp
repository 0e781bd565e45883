#include "model/context.h"

#include <algorithm>

namespace sumogamma {

void append_contextual_constraints(const Model& model, const Scene& scene, std::size_t row, ConstraintSet& constraints) {
  const RoadContext& context = scene.context[row];
  if (!context.active) return;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const Vec2 left = left_of(context.tangent);

  // lane boundaries: lateral speed under d/tau (III-C); beyond a boundary no further, but standing stays allowed
  auto boundary = [&](double room, const Vec2& outward) {
    if (!std::isfinite(room)) return;
    const double limit = std::max(room, 0.0) / type.horizon;
    constraints.append({limit * outward, -outward}, {ConstraintKind::LaneBoundary, -1});
  };
  boundary(context.room_left, left);
  boundary(context.room_right, -left);

  // driving direction: wheeled agents never go against their path
  if (type.kinematics != Kinematics::Holonomic)
    constraints.append({Vec2::Zero(), context.tangent}, {ConstraintKind::Direction, -1});

  // leader, signals, right of way: a cap on the speed along the path
  if (std::isfinite(context.allowed_speed))
    constraints.append({std::max(context.allowed_speed, 0.0) * context.tangent, -context.tangent},
                       {ConstraintKind::RoadLimit, context.foe});
}

}  // namespace sumogamma
