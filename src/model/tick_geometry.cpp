#include "model/tick_geometry.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/rotation.h"

namespace sumogamma {

namespace {

// what a driver needs before the brakes bite [s]
constexpr double kReactionTime = 0.25;

double square(double x) { return x * x; }

Margins margins_of(const ModelOptions& options, bool on_wheels) {
  if (on_wheels) return {options.front_margin, options.rear_margin, options.side_margin};
  return {options.walker_margin, options.walker_margin, options.walker_margin};
}

/// The octagon around the circumscribed disc: the ablation without polygons.
ConvexPolygon disc_polygon(double radius) {
  std::array<Vec2, 8> vertices;
  const double corner = radius / std::cos(kPi / 8);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    vertices[k] = corner * direction_of(kPi / 8 + static_cast<double>(k) * (kPi / 4));
  return place_polygon(vertices, Vec2(1, 0));
}

void fill_outline(const ModelOptions& options, const Footprint& footprint, AgentGeometry& agent) {
  const std::optional<OrientedBox> box =
      options.use_polygons ? as_box(footprint.outline()) : std::nullopt;
  const Margins margins = margins_of(options, agent.on_wheels);
  agent.is_box = box && std::abs(box->center.y()) == 0.0;
  if (!agent.is_box) {
    const double widest = std::max({margins.front, margins.rear, margins.side});
    agent.radius = (options.use_polygons ? footprint.radius + 1.5 * widest
                                         : footprint.radius / std::cos(kPi / 8));
    return;
  }
  agent.half = box->half;
  agent.shift = box->center.x();
  agent.guarded_half = box->half + Vec2(0.5 * (margins.front + margins.rear), margins.side);
  agent.guarded_shift = agent.shift + 0.5 * (margins.front - margins.rear);
  agent.radius =
      Vec2(agent.guarded_half.x() + std::abs(agent.guarded_shift), agent.guarded_half.y()).norm();
}

AgentGeometry describe(const Model& model, const Scene& scene, std::size_t row) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  AgentGeometry agent;
  agent.position = scene.position[row];
  agent.velocity = scene.velocity[row];
  agent.forward = rotation(scene.heading[row]);
  agent.on_wheels = type.kinematics != Kinematics::Holonomic;
  agent.ground = ground_of(scene, row);
  agent.speed = agent.on_wheels ? scene.speed[row] : agent.velocity.norm();
  agent.curvature = agent.on_wheels ? tangent(scene.steering[row]) / type.wheelbase : 0.0;
  agent.type = scene.type[row];
  agent.attention = scene.behavior[row].attention;
  fill_outline(model.options, scene.footprint[row], agent);
  agent.yields = scene.control[row] == Control::Gamma ||
                 (scene.control[row] == Control::Planned && model.options.trust_planned);
  agent.stopping =
      kReactionTime * agent.speed + square(agent.speed) / (2.0 * type.comfortable_deceleration);
  const double step = model.options.step;
  const double wish = std::max(agent.speed, std::min(scene.preferred_speed[row], type.max_speed));
  const double faster = std::min(agent.speed + type.max_acceleration * step, wish);
  const double way = square(agent.speed) / (2.0 * type.max_deceleration);
  agent.throttle_way =
      step * faster + (square(faster) - square(agent.speed)) / (2.0 * type.max_deceleration);
  agent.next_reach = agent.radius + way + agent.throttle_way + model.options.guard_margin;
  agent.far = std::max(agent.stopping + agent.radius, agent.next_reach);
  const Vec2 direction =
      agent.on_wheels ? agent.forward : Vec2(agent.velocity / std::max(agent.speed, 1e-9));
  if (agent.is_box)
    agent.braking = swept_box(agent, agent.position, agent.forward, direction, way, agent.curvature,
                              type.rear_axle_to_center);
  return agent;
}

}  // namespace

void prepare_tick(const Model& model, const Scene& scene, Workers& workers,
                  TickGeometry& geometry) {
  const std::size_t rows = scene.size();
  geometry.grid.rebuild(scene.position);
  geometry.agent.resize(rows);
  workers.for_each_range(rows, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      geometry.agent[row] = describe(model, scene, row);
  });
  const std::span<const SpatialGrid::Entry> entries = geometry.grid.entries();
  for (std::vector<double>* column : {&geometry.x, &geometry.y, &geometry.far})
    column->resize(rows + 1);
  geometry.largest_far = 0;
  for (std::size_t k = 0; k < rows; ++k) {
    geometry.x[k] = entries[k].position.x();
    geometry.y[k] = entries[k].position.y();
    geometry.far[k] = geometry.agent[entries[k].row].far;
    geometry.largest_far = std::max(geometry.largest_far, geometry.far[k]);
  }
}

bool comes_from_behind(const AgentGeometry& own, const AgentGeometry& their) {
  return own.on_wheels && their.on_wheels && their.forward.dot(own.forward) > 0.7 &&
         (their.position - own.position).dot(own.forward) < -own.half.x() - their.half.x();
}

Vec2 way_on_arc(const Vec2& turned, double curvature, double axle) {
  // the arc of the rear axle, and the position's swing about it
  const double radius = 1.0 / curvature;
  return {radius * turned.y() + axle * (turned.x() - 1.0),
          radius * (1.0 - turned.x()) + axle * turned.y()};
}

OrientedBox swept_box(const AgentGeometry& agent, const Vec2& position, const Vec2& forward,
                      const Vec2& direction, double way, double curvature, double axle) {
  // the box of all poses on the way: forward by the way, aside by the arc and by what the turned
  // ends swing out
  const double turn = std::abs(curvature) * way;
  const double along = way * direction.dot(forward), aside = way * cross(forward, direction);
  const double arc = 0.5 * turn * way,
               swing = turn * (agent.half.x() + std::abs(agent.shift) + axle);
  const double bulge = arc + swing, lean = turn * agent.half.y();
  OrientedBox box;
  box.forward = forward;
  box.half = agent.half + Vec2(0.5 * std::abs(along) + lean, 0.5 * std::abs(aside) + bulge);
  box.center = position + (agent.shift + 0.5 * along) * forward + (0.5 * aside) * left_of(forward);
  return box;
}

ConvexPolygon guarded_polygon(const Model& model, const Scene& scene, const TickGeometry& geometry,
                              std::size_t row) {
  const AgentGeometry& agent = geometry.agent[row];
  const Footprint& footprint = scene.footprint[row];
  if (!model.options.use_polygons) return disc_polygon(footprint.radius);
  return place_polygon(footprint.outline(), agent.forward,
                       margins_of(model.options, agent.on_wheels));
}

double overlap_depth(const Scene& scene, const TickGeometry& geometry, std::size_t row,
                     std::size_t other) {
  const AgentGeometry &a = geometry.agent[row], &b = geometry.agent[other];
  if (a.is_box && b.is_box) return -separation(a.box(), b.box());
  return overlap_depth(place_polygon(scene.footprint[row].outline(), a.forward),
                       place_polygon(scene.footprint[other].outline(), b.forward),
                       b.position - a.position);
}

}  // namespace sumogamma
