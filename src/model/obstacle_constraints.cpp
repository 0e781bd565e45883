#include "model/obstacle_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sumogamma {

namespace {

// kept from walls [m]: what the corners of a rolling body swing out between two ticks
constexpr double kWallMargin = 0.1;
constexpr double kLittle = 0.02;  // [m]
// share of the emergency braking that approaching a wall counts on
constexpr double kBrakingShare = 0.6;

Vec2 nearest_on(const Vec2& from, const Vec2& to, const Vec2& point) {
  const Vec2 along = to - from;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((point - from).dot(along) / square, 0.0, 1.0) : 0.0;
  return from + t * along;
}

/// Way out for an outline that a segment crosses: over the side that the outline's reference point
/// is on.
Vec2 way_out(const Vec2& from, const Vec2& to) {
  const Vec2 along = to - from;
  const Vec2 away = -nearest_on(from, to, Vec2::Zero());
  if (along.norm() > 1e-9) {
    const Vec2 normal = left_of(along) / along.norm();
    return normal.dot(-from) >= 0 ? normal : Vec2(-normal);
  }
  return away.norm() > 1e-9 ? Vec2(away / away.norm()) : Vec2(1, 0);
}

/// Room kept from walls [m]. People turn on the spot: their shoulders swing out all they can.
double wall_margin(const AgentGeometry& agent, const Footprint& footprint) {
  if (agent.on_wheels) return kWallMargin;
  return footprint.radius - (agent.is_box ? agent.half.minCoeff() : 0.0) + kLittle;
}

/// Fastest approach from which `distance` suffices to stop, a tick of reaction included [m/s].
double approach_speed(double distance, double deceleration, double step) {
  const double lost = deceleration * step;
  return std::sqrt(lost * lost + 2.0 * deceleration * distance) - lost;
}

}  // namespace

Clearance clearance(const ConvexPolygon& outline, const Vec2& from, const Vec2& to) {
  double least = std::numeric_limits<double>::infinity();
  Vec2 between = Vec2::Zero();
  auto consider = [&](const Vec2& on_outline, const Vec2& on_segment) {
    const double square = (on_outline - on_segment).squaredNorm();
    if (square >= least) return;
    least = square;
    between = on_outline - on_segment;
  };
  // the segment within the outline: clipped by every edge something is left of it
  double enter = 0, leave = 1;
  bool crosses = outline.count > 2;
  for (std::uint32_t k = 0; k < outline.count; ++k) {
    const Vec2& a = outline.vertices[k];
    const Vec2& b = outline.vertices[k + 1 < outline.count ? k + 1 : 0];
    consider(a, nearest_on(from, to, a));
    consider(nearest_on(a, b, from), from);
    consider(nearest_on(a, b, to), to);
    if (outline.count < 3) continue;
    const double height = outline.normals[k].dot(from - a),
                 rise = outline.normals[k].dot(to - from);
    if (rise > 0)
      leave = std::min(leave, -height / rise);
    else if (rise < 0)
      enter = std::max(enter, -height / rise);
    else if (height > 0)
      crosses = false;
  }
  Clearance result;
  if ((crosses && enter <= leave) || least < 1e-18) {
    result.outward = way_out(from, to);
    return result;
  }
  result.distance = std::sqrt(least);
  result.outward = between / result.distance;
  return result;
}

void append_obstacle_constraints(const Model& model, const Scene& scene,
                                 const TickGeometry& geometry, std::size_t row,
                                 std::vector<std::uint32_t>& found, ConstraintSet& constraints) {
  if (model.obstacles.empty()) return;
  const AgentGeometry& agent = geometry.agent[row];
  // on the carriageway the boundaries of the lanes hold, and nothing solid stands within them
  if (scene.context[row].active && agent.on_wheels) return;
  const AgentType& type = type_of(model.types, agent.type);
  const double deceleration = kBrakingShare * type.max_deceleration;
  // as fast as it can be within half a second: what lies beyond that way to a stop is met later
  const double soon = agent.speed + 0.5 * type.max_acceleration;
  const double speed =
      std::max(agent.speed, std::min({soon, scene.preferred_speed[row], type.max_speed}));
  const double margin = wall_margin(agent, scene.footprint[row]);
  const double reach =
      agent.radius + margin + speed * model.options.step + speed * speed / (2.0 * deceleration);
  model.obstacles.find_near(agent.position, reach, found);
  if (found.empty()) return;
  const ConvexPolygon outline = place_polygon(scene.footprint[row].outline(), agent.forward);
  for (const std::uint32_t index : found) {
    const ObstacleIndex::Side& side = model.obstacles.side(index);
    const Clearance clear =
        clearance(outline, side.from - agent.position, side.to - agent.position);
    const double most =
        approach_speed(std::max(clear.distance - margin, 0.0), deceleration, model.options.step);
    constraints.append({-most * clear.outward, clear.outward},
                       {ConstraintKind::Obstacle, side.obstacle});
  }
}

}  // namespace sumogamma
