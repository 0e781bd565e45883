#pragma once

#include <cstdint>
#include <vector>

#include "road/replan.h"
#include "scene/storey.h"
#include "traffic/traffic_tick.h"

namespace sumogamma {

/// Somebody on the road near an agent, in the coordinates of the agent's path.
struct PathUser {
  double rear = 0, front = 0;  ///< along the path [m]
  double offset = 0;           ///< of the centre beside the path, positive left [m]
  double half_width = 0;       ///< across the path [m]
  double speed = 0;            ///< along the path; negative against it [m/s]
  bool aligned = false;        ///< heads the same way
  bool on_foot = false;
  std::uint32_t row = 0;
};

/// What there is to the sides of a path, both positive [m].
struct Sides {
  double left = 0, right = 0;
};

/// An agent and whoever is on the road around it.
struct Surroundings : EgoOnPath {
  std::vector<PathUser> users;       ///< in order of row
  std::vector<PathUser> walls;       ///< pieces of what is solid, as somebody who stands there
  std::vector<std::uint32_t> sides;  ///< buffer
};

/// Calls visit(other) for everybody on a row's storey, but itself, within `radius` of `center` [m].
/// Asks the grid, in whose order they come.
template <typename Visit>
void visit_storey(const TrafficView& view, std::size_t row, const Vec2& center, double radius,
                  Visit&& visit) {
  view.grid.visit_within(center, radius, [&](std::size_t other, double) {
    if (other != row && !on_other_storey(view.model.road, view.scene, row, other)) visit(other);
  });
}

/// Likewise for everybody within `radius` [m] of a row, which as a rule is no more than its reach.
template <typename Visit>
void visit_near(const TrafficView& view, std::size_t row, double radius, Visit&& visit) {
  const std::vector<Vec2>& position = view.scene.position;
  if (radius > view.perception.reach[row])
    return visit_storey(view, row, position[row], radius, visit);
  for (const std::size_t other : view.perception.near[row])
    if ((position[other] - position[row]).squaredNorm() <= radius * radius) visit(other);
}

/// Fills the row's own part of `perception`, with who is near within `reach` [m].
void perceive(const TrafficView& view, std::size_t row, double reach, Perception& perception);

/// Is it a row's turn to look at lanes and routes? Once a look_period, whoever has another id at
/// another tick. dt [s].
bool is_its_turn(const TrafficView& view, std::size_t row, double dt);

/// What a row's path is made again from. Precondition: it has one, a vehicle's.
Replan replan(const TrafficTick& tick, std::size_t row);

/// A row goes on by another path, amid a tick (see change_path): those who look at it from here on
/// see it there.
void go_on_by(const TrafficTick& tick, Replanned way, std::size_t row);

/// Fills `around` for a row with a path: everybody whose centre lies within `reach` ahead, or
/// `reach` behind [m], and within `aside` of the path on the same storey.
void look_around(const TrafficView& view, std::size_t row, double reach, double aside,
                 Surroundings& around);

/// Fills around.walls, after look_around, with what is solid within `reach` [m] of a row and within
/// `aside` of its path, in pieces of a sampling_step.
void look_at_walls(const TrafficView& view, const Path& path, std::size_t row, double reach,
                   double aside, Surroundings& around);

/// Adds to around.walls, after look_at_walls, where a row that has been held up for long is about
/// to get onto a red crossing that it doesn't wait for (RoadContext::to_red): who walks along
/// beside the tip of one presses on against it else, for as long as it is red.
void look_at_red_crossings(const TrafficView& view, const Path& path, std::size_t row,
                           Surroundings& around);

/// Speed that can be hoped for over the next seconds with the body's centre at `offset` beside the
/// path: as fast as `free_speed` where nobody is ahead, less the nearer and the slower somebody is,
/// negative where somebody is beside. `margin` [m] is kept to the sides.
double hoped_speed(const TrafficParameters& parameters, const Surroundings& around, double offset,
                   double free_speed, double margin);

}  // namespace sumogamma
