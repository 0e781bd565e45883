#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ego/ego_settings.h"
#include "traffic/traffic_view.h"

namespace sumogamma {

struct PlanTrace;

/// Where the ego wants to: a place on its way, and the direction of its road there.
struct EgoGoal {
  Vec2 position = Vec2::Zero();
  Vec2 direction = Vec2(1, 0);
  double way = 0;  ///< from the start [m]
};

/// Is the ego there? Within kGoalRadius before it along the road's direction or beyond it, on
/// whatever lane of that road, and not on another one that passes near it.
bool has_reached(const EgoGoal& goal, const Scene& scene, std::size_t row);

/// What a planner that is built in sees: the frozen scene after look_about, with everything that
/// the model knows. One that joins by a socket sees no more than observe() makes of it.
struct EgoView {
  const TrafficView& world;
  Workers& workers;
  std::size_t row;
  const EgoSettings& settings;
  const EgoGoal& goal;
  std::uint64_t seed;
  std::int64_t plan;           ///< number of this plan in its episode, from 0
  double since;                ///< the episode's begin [s]
  double progress;             ///< made along the way so far [m]
  bool rules;                  ///< does the world keep the rules of the road?
  PlanTrace* trace = nullptr;  ///< where to note what it thinks; null: nobody looks on
};

/// Rows about a row: those nearer than `reach` [m] on its storey, the nearest `most` of them,
/// nearest first; of equally near ones the smaller id. The row itself isn't among them.
std::vector<std::size_t> rows_about(const Model& model, const Scene& scene, std::size_t row,
                                    double reach, std::size_t most);

/// How far planners see [m], and how many of the nearest who joins is shown: as the reference's
/// planner.
inline constexpr double kSeen = 50.0;
inline constexpr std::size_t kAgentsSeen = 20;

/// Rows of those whom a planner in the box reckons with ([ego] agents_seen), nearest first.
std::vector<std::size_t> rows_seen(const EgoView& view);

/// An agent as it can be seen: no path, no intention.
struct VisibleAgent {
  std::uint32_t id = 0;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();
  double heading = 0;
  Vec2 velocity = Vec2::Zero();
  double length = 0, width = 0;  ///< [m]
};

/// A place of the ego's way.
struct WayPoint {
  Vec2 position = Vec2::Zero();
  double along = 0;                      ///< from the ego's centre [m]
  double room_left = 0, room_right = 0;  ///< to the carriageway's edges [m]
  double limit = 0;                      ///< that signs and bends leave [m/s]
};

struct EgoObservation {
  double time = 0;  ///< since the episode's begin [s]
  VisibleAgent ego;
  double speed = 0, steering = 0;    ///< along its heading [m/s], front wheels [rad]
  std::vector<VisibleAgent> agents;  ///< the nearest, nearest first
  std::vector<WayPoint> way;         ///< every 2 m, over 50 m or up to its end
  Light light = Light::None;         ///< of the next link of its way that has a signal
  double to_light = 0;  ///< from its front to that stop line [m]; 0 where there is none
  double to_goal = 0;   ///< straight [m]
};

EgoObservation observe_ego(const Model& model, const RoadState& road, const Scene& scene,
                           std::size_t row, const EgoGoal& goal, double since);

}  // namespace sumogamma
