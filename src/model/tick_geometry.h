#pragma once

#include <vector>

#include "base/parallel.h"
#include "geometry/convex_polygon.h"
#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/scene.h"

namespace sumogamma {

/// What every pair needs of each agent, computed once a tick from the frozen scene and only read
/// afterwards.
struct TickGeometry {
  SpatialGrid grid;
  std::vector<Vec2> forward;           ///< unit heading
  std::vector<ConvexPolygon> body;     ///< outline in world axes about the centre [m]
  std::vector<ConvexPolygon> guarded;  ///< the same with the margins that avoidance keeps
  std::vector<double> radius;          ///< of the guarded outline's circumscribed disc [m]
  std::vector<double> stopping;        ///< reaction and braking distance [m]
  double longest_stopping = 0;         ///< largest of these
  double largest_radius = 0;
};

/// Fills `geometry` for the scene. No allocation while the number of agents stays within what was
/// seen before.
void prepare_tick(const Model& model, const Scene& scene, Workers& workers, TickGeometry& geometry);

}  // namespace sumogamma
