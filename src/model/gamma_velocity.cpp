#include "model/gamma_velocity.h"

#include <algorithm>

#include "model/context.h"
#include "model/geometric_constraints.h"
#include "model/kinematic_set.h"
#include "model/preferred_velocity.h"
#include "model/stopping_guard.h"

namespace sumogamma {

Vec2 gamma_velocity(const Model& model, const Scene& scene, const TickGeometry& geometry,
                    std::size_t row, const BehaviorState& behavior, Workspace& work) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  work.preferred = preferred_velocity(model, scene, row, behavior.intention);
  if (!work.preferred.allFinite()) work.preferred = Vec2::Zero();
  find_attended(geometry, row, behavior.attention, work.preferred, type.horizon, work.attended);

  work.constraints.clear();
  append_kinematic_constraints(model, scene, row, work.constraints);   // K, III-A
  append_contextual_constraints(model, scene, row, work.constraints);  // C, III-C
  work.constraints.hard_count = work.constraints.planes.size();
  append_geometric_constraints(model, scene, geometry, row, behavior, work.attended,
                               work.constraints);  // G, III-B

  double fastest =
      std::min(type.max_speed, std::max(scene.preferred_speed[row], work.preferred.norm()));
  // what the road allows holds for a wheeled body whichever way it points
  if (scene.context[row].active && type.kinematics != Kinematics::Holonomic)
    fastest = std::min(fastest, std::max(scene.context[row].allowed_speed, 0.0));
  work.result = closest_point(work.constraints.planes, work.constraints.hard_count, work.preferred,
                              fastest, work.program);
  if (model.options.use_guard)
    work.result.point =
        guarded_velocity(model, scene, geometry, row, work.result.point, work.guard);
  return work.result.point;
}

}  // namespace sumogamma
