#pragma once

#include <optional>
#include <vector>

#include "base/parallel.h"
#include "geometry/convex_polygon.h"
#include "geometry/oriented_box.h"
#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "scene/scene.h"
#include "scene/storey.h"

namespace sumogamma {

/// From a body's position to its farthest corner, of the longest bodies there are [m].
inline constexpr double kFarthestCorner = 12.0;

/// What every pair needs to know of an agent, together in memory.
struct AgentGeometry {
  Vec2 position, velocity;
  Vec2 forward;              ///< unit heading
  Vec2 half, guarded_half;   ///< half extents of the box, bare and with the margins that avoidance
                             ///< keeps [m]
  double shift = 0;          ///< the bare box's centre lies this far ahead of the position [m]
  double guarded_shift = 0;  ///< likewise the guarded one's
  double radius = 0;         ///< about the position, holds the guarded outline [m]
  double stopping = 0;       ///< way of reacting and braking comfortably [m]
  double next_reach =
      0;  ///< radius and the shortest way to a stop after one more tick at full throttle [m]
  double far = 0;           ///< from farther than this it matters to nobody on its own account [m]
  double throttle_way = 0;  ///< what that tick adds to the way [m]
  double speed = 0;         ///< [m/s]
  Ground ground;            ///< under it
  double curvature = 0;     ///< of the rear axle's way, positive left [1/m]
  AttentionRange attention;
  AgentTypeId type{};
  bool is_box = true;
  bool on_wheels = true;
  bool yields = true;  ///< driven by the model, or trusted to do as well: brakes where it must

  OrientedBox braking;  ///< holds the bare outline until it stands if it brakes now (boxes only)

  OrientedBox box() const { return {position + shift * forward, forward, half}; }
  OrientedBox guarded_box() const {
    return {position + guarded_shift * forward, forward, guarded_half};
  }
};

/// Computed once a tick from the frozen scene and only read afterwards.
struct TickGeometry {
  SpatialGrid grid;
  std::vector<AgentGeometry> agent;
  /// Positions of the agents and from how far they matter, in the grid's order, with one more
  /// entry at the end, so that they can be read in pairs [m].
  std::vector<double> x, y, far;
  double largest_far = 0;  ///< largest of these [m]
};

/// Fills `geometry` for the scene. No allocation while the number of agents stays within what was
/// seen before.
void prepare_tick(const Model& model, const Scene& scene, Workers& workers, TickGeometry& geometry);

/// Is `their` body all behind the own one, and goes the same way? On a road it is its business to
/// keep apart then. On wheels only.
bool comes_from_behind(const AgentGeometry& own, const AgentGeometry& their);

/// The row's outline about its position in world axes, with the margins that avoidance keeps.
ConvexPolygon guarded_polygon(const Model& model, const Scene& scene, const TickGeometry& geometry,
                              std::size_t row);

/// Way of a body's position, in its axes at the begin [m], while its rear axle, `axle` [m] behind
/// it, rolls on an arc of `curvature` (positive left, not null [1/m]) through the angle of which
/// `turned` is the rotation.
Vec2 way_on_arc(const Vec2& turned, double curvature, double axle);

/// A box that holds the outline of a body at every point of a `way` [m] along `direction` (unit)
/// that begins with `forward` and bends with `curvature` [1/m] about a rear axle `axle` [m] behind
/// its position. Boxes only.
OrientedBox swept_box(const AgentGeometry& agent, const Vec2& position, const Vec2& forward,
                      const Vec2& direction, double way, double curvature, double axle);

/// Depth of the overlap of two rows' bare outlines [m]; <= 0 where they are apart.
double overlap_depth(const Scene& scene, const TickGeometry& geometry, std::size_t row,
                     std::size_t other);

}  // namespace sumogamma
