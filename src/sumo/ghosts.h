#pragma once

#include <cmath>
#include <span>

#include "geometry/spatial_grid.h"
#include "road/path.h"
#include "road/road_network.h"
#include "scene/extent.h"
#include "scene/scene.h"

namespace sumogamma {

/// Bodies further apart in height don't meet [m].
inline constexpr double kBodiesApart = 2.5;

/// What a body needs about it.
struct BodyMargins {
  double beside, apart;  ///< to its sides, and to whoever is ahead or behind [m]
  double time,
      braking;  ///< of whoever closes in on the other, before and when it brakes [s, m/s^2]
};

/// Does a row leave a body at `speed` [m/s] room: is it beside its lane, or far enough ahead or
/// behind for the one who closes in on the other?
bool leaves_room(const Scene& scene, std::size_t row, const OrientedBox& body, double speed,
                 const BodyMargins& margins);

/// Would a body at `speed` [m/s] and `height` [m] be in nobody's way there, and nobody in its? Who
/// doesn't count by `counts` is left out.
template <typename Counts>
bool has_room(const Scene& scene, const SpatialGrid& grid, const OrientedBox& body, double height,
              double speed, Counts&& counts) {
  constexpr double kAround = 60.0;  // [m]
  constexpr BodyMargins kMargins{0.2, 1.0, 0.4, 3.5};
  bool room = true;
  grid.visit_within(body.center, kAround, [&](std::uint32_t row, double) {
    room = room && (!counts(row) || std::abs(scene.height[row] - height) > kBodiesApart ||
                    leaves_room(scene, row, body, speed, kMargins));
  });
  return room;
}

/// Has a vehicle room about it, at its speed?
bool has_room_for(const Scene& scene, const SpatialGrid& grid, std::size_t row);

/// Does a row's body touch another? SUMO inserts and parks vehicles over one another, and drives
/// them apart; we couldn't.
bool touches(const Scene& scene, std::size_t row);

/// Does a row go against a lane, as one that overtakes there?
bool goes_against(const Lane& lane, const Scene& scene, std::size_t row);

/// Would a lane change from `lane` that SUMO may make now, to either side, lead into one of
/// `ghosts`?
bool bars_lane_changes(const RoadNetwork& network, const Lane& lane, const Scene& scene,
                       std::size_t row, std::span<const std::uint32_t> ghosts);

/// Is a ghost, which SUMO leaves out of its reckoning, on the stretch of road that overtaking on
/// the opposite lane would take, either way?
bool meets_ghosts(const Scene& scene, const SpatialGrid& grid, std::size_t row);

/// The speed at which somebody whom SUMO moves can still brake for one of `ghosts` that its body,
/// as that follows `path`, would reach, one that stands, or nearly, or goes the same way: infinite
/// where none is in the way [m/s]. Straight on where `path` is null. The road's rules know lanes;
/// bodies reach over them, and SUMO may mean to pass whoever binds it by those.
double speed_behind_ghosts(const Scene& scene, std::size_t row, bool on_foot, const Path* path,
                           std::span<const std::uint32_t> ghosts);

}  // namespace sumogamma
