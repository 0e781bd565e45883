#pragma once

#include <string>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// The vehicle that a planner drives, its start, its goal and what its planner may ask: [ego] of
/// scenario.toml and the options of `sumo-gamma drive`.
struct EgoSettings {
  std::string vehicle;         ///< id of the demand; empty: one more, whose start is drawn
  std::string type = "car";    ///< agent type of one that is drawn
  std::vector<double> window;  ///< X0, Y0, X1, Y1 in which it starts [m]; empty: anywhere
  std::string goal_edge;       ///< where it wants to; empty: the end of its route
  double goal_at = -1;         ///< along that edge [m]; negative: its end
  double goal_way = 50;        ///< length of a drawn route [m], where no edge is named
  double max_speed = 6;        ///< of the ego [m/s]
  std::vector<double> accelerations{0, 3, -3};  ///< among which planners choose [m/s^2]
  double rate = 3;                              ///< plans a second
  std::string planner = "gamma";                ///< one of planners()
  int agents_seen = 20;    ///< of those within kSeen the nearest: who planners reckon with
  int scenarios = 5;       ///< K of a search
  int depth = 12;          ///< D of a search [steps of 1/3 s]
  int trees = 1;           ///< 2: over half of the scenarios each, in two threads
  int scene_steps = 3000;  ///< of a search, counted: the same plan anywhere
  double deadline = 0;     ///< of a search [s] on the clock; 0: none, else plans can't be repeated
  bool trusted = true;     ///< others count on it to do its share
  bool emergency_brake = false;  ///< brakes fully, whatever it plans, where it would hit somebody
  double warm_up = 30;           ///< of the world before the ego comes [s]
  double clearance = 9;          ///< free around its start [m]
  double limit = 120;            ///< an episode's longest time [s]
};

/// Ends of an episode at the goal from so far along the way [m].
inline constexpr double kGoalRadius = 2.0;

/// Throws Error naming the key, `[ego] NAME`, and what to do: a rate over the tick's or not above
/// 0, accelerations without a braking one, a box that is none, a planner's unknown name (with the
/// nearest known one), a goal nearer than kGoalRadius. `step`: of the world [s]; `external`: the
/// ego is driven through a socket.
void check_settings(const EgoSettings& settings, double step, bool external);

}  // namespace sumogamma
