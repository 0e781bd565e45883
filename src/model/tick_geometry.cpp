#include "model/tick_geometry.h"

#include <algorithm>

namespace sumogamma {

namespace {

// what a driver needs before the brakes bite [s]
constexpr double kReactionTime = 0.5;

Margins margins_of(const ModelOptions& options, const AgentType& type) {
  if (type.kinematics == Kinematics::Holonomic)
    return {options.walker_margin, options.walker_margin, options.walker_margin};
  return {options.front_margin, options.rear_margin, options.side_margin};
}

/// Circumscribed disc as an octagon of the same reach along its normals: the ablation without
/// polygons.
ConvexPolygon disc_outline(double radius) {
  std::array<Vec2, 8> vertices;
  const double corner = radius / std::cos(M_PI / 8);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    vertices[k] = corner * direction_of(M_PI / 8 + static_cast<double>(k) * (M_PI / 4));
  return place_polygon(vertices, Vec2(1, 0));
}

double outline_radius(const ConvexPolygon& polygon) {
  double square = 0;
  for (std::uint32_t k = 0; k < polygon.count; ++k)
    square = std::max(square, polygon.vertices[k].squaredNorm());
  return std::sqrt(square);
}

}  // namespace

void prepare_tick(const Model& model, const Scene& scene, Workers& workers,
                  TickGeometry& geometry) {
  const std::size_t rows = scene.size();
  geometry.grid.rebuild(scene.position);
  geometry.forward.resize(rows);
  geometry.body.resize(rows);
  geometry.guarded.resize(rows);
  geometry.radius.resize(rows);
  geometry.stopping.resize(rows);
  workers.for_each_range(rows, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const AgentType& type = type_of(model.types, scene.type[row]);
      const Footprint& footprint = scene.footprint[row];
      const Vec2 forward = direction_of(scene.heading[row]);
      geometry.forward[row] = forward;
      geometry.body[row] = place_polygon(footprint.outline(), forward);
      geometry.guarded[row] =
          model.options.use_polygons
              ? place_polygon(footprint.outline(), forward, margins_of(model.options, type))
              : disc_outline(footprint.radius);
      geometry.radius[row] = outline_radius(geometry.guarded[row]);
      const double speed = scene.speed[row];
      geometry.stopping[row] =
          kReactionTime * speed + speed * speed / (2.0 * type.comfortable_deceleration);
    }
  });
  geometry.longest_stopping = 0;
  geometry.largest_radius = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    geometry.longest_stopping = std::max(geometry.longest_stopping, geometry.stopping[row]);
    geometry.largest_radius = std::max(geometry.largest_radius, geometry.radius[row]);
  }
}

}  // namespace sumogamma
