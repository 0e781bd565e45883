#include "model/context.h"

#include <algorithm>

#include "base/units.h"
#include "model/stopping_guard.h"

namespace sumogamma {

namespace {
constexpr double kCreep = 1.0;        // [m/s]
constexpr double kReturn = 1.5;       // to the place aimed at, at the least [s]
constexpr double kRoundOthers = 2.2;  // beyond the boundary, of the own width
constexpr double kToRed = 0.5;        // onto a red crossing, at the least [s]
}  // namespace

void append_contextual_constraints(const Model& model, const Scene& scene, std::size_t row,
                                   ConstraintSet& constraints) {
  const RoadContext& context = scene.context[row];
  if (!context.active) return;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const Vec2 left = left_of(context.tangent);
  const Vec2 forward = direction_of(scene.heading[row]);
  const bool on_wheels = type.kinematics != Kinematics::Holonomic;
  const KinematicSet trackable = model.kinematics[static_cast<std::size_t>(scene.type[row])].at(
      std::min(scene.speed[row], kCreep), scene.steering[row]);

  // lane boundaries: lateral speed under d/tau (III-C); beyond a boundary no further, but standing
  // stays allowed
  auto boundary = [&](double room, double edge, const Vec2& outward) {
    if (!std::isfinite(room)) return;
    double limit = std::max(room, 0.0) / type.horizon;
    // differs from the paper: a wheeled body that points outward can only come back by rolling on
    // while it turns, so it may creep along the inmost direction that it can track, and beyond the
    // boundary no further out than that; and the boundary beyond the place that it aims at slows
    // nobody who comes back to its lane from the other side
    if (on_wheels) {
      const bool back_is_right = sumogamma::cross(forward, context.tangent) < 0.0;
      const double turn =
          0.9 * std::abs(heading_of(back_is_right ? trackable.right : trackable.left));
      const double away = std::asin(std::clamp(forward.dot(outward), -1.0, 1.0));
      // who is wedged may find its way round whoever it is wedged against, on its own carriageway
      const bool may_leave_lane = is_wedged(scene, row) && edge > 0.0;
      const double farthest = may_leave_lane ? -kRoundOthers * type.width : 0.0;
      if (room < farthest && away > turn) {
        const Vec2 inmost = from_body(direction_of(back_is_right ? -turn : turn), forward);
        constraints.append({Vec2::Zero(), back_is_right ? Vec2(-left_of(inmost)) : left_of(inmost)},
                           {ConstraintKind::LaneBoundary, -1});
        return;
      }
      const double back = std::min(room, outward.dot(context.sub_goal - scene.position[row]));
      limit = std::max(
          {limit, kCreep * std::sin(std::clamp(away - turn, 0.0, 0.5 * kPi)), back / kReturn});
    }
    constraints.append({limit * outward, -outward}, {ConstraintKind::LaneBoundary, -1});
  };
  boundary(context.room_left, context.edge_left, left);
  boundary(context.room_right, context.edge_right, -left);
  for (const Vec2& way : context.to_red) {
    if (way.isZero()) continue;
    constraints.append({way / kToRed, -way.normalized()}, {ConstraintKind::RoadLimit, -1});
  }

  // driving direction: wheeled agents never go against their path; one that was turned away from it
  // has to turn back first
  if (on_wheels && forward.dot(context.tangent) > 0.3)
    constraints.append({Vec2::Zero(), context.tangent}, {ConstraintKind::Direction, -1});

  // leader, signals, right of way: a cap on the speed along the path, on wheels on that along the
  // heading
  const Vec2& along = on_wheels ? forward : context.tangent;
  if (std::isfinite(context.allowed_speed))
    constraints.append({std::max(context.allowed_speed, 0.0) * along, -along},
                       {ConstraintKind::RoadLimit, context.foe});
}

}  // namespace sumogamma
