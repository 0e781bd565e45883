#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "planning/wheeled_pose.h"
#include "road/path.h"

namespace sumogamma {

/// A side of something solid.
struct Wall {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
};

/// Where a body may be.
struct DrivableSpace {
  const Path* lanes = nullptr;  ///< the route's lane path: its room is the carriageway's;
                                ///< null: an open plane
  std::span<const OrientedBox> bodies = {};  ///< that stand, and will
  std::span<const Wall> walls = {};          ///< sides of solid things
  /// The piece of the lane path that may be near [m].
  double lanes_from = 0, lanes_to = std::numeric_limits<double>::infinity();
};

struct HybridAStarParameters {
  int steering_steps = 7;               ///< odd: angles from lock to lock
  double arc = 1.0, short_arc = 0.5;    ///< [m]; the short one within `near_goal`
  double near_goal = 5.0;               ///< [m]
  double cell = 0.5;                    ///< [m]
  int headings = 72;                    ///< cells of a full turn
  double steering_cost = 0.3;           ///< a metre and radian
  double turning_cost = 1.0;            ///< a radian that the front wheels are turned
  double off_middle_cost = 0.5;         ///< a metre, by metres beyond off_middle_free
  double off_middle_free = 0.5;         ///< from the lane's middle [m]
  double heuristic_weight = 2.0;        ///< the way found costs at most so many times the least one
  double margin = 0.3;                  ///< kept to bodies and walls [m]
  double spacing = 0.25;                ///< of the poses found, and of those looked at [m]
  int shot_every = 10;                  ///< expansions between two tries to get there at once
  double reach = 20.0;                  ///< around start and goal that is looked at [m]
  std::int64_t most_expansions = 2000;  ///< nodes: counted, so that the same way is found anywhere
};

enum class WaySearch : std::uint8_t {
  Found,
  Unreachable,     ///< no way that the body could drive
  GivenUp,         ///< most_expansions
  StartInContact,  ///< with something solid, before anybody moves
};

struct FoundWay {
  WaySearch result = WaySearch::Unreachable;
  std::vector<AxlePose> poses;  ///< from start to goal, `spacing` apart at the most; else empty
  double length = 0;            ///< [m]
  std::int64_t expansions = 0;
};

/// A way from a pose to another that the body can drive forwards, its steering within limits, on
/// the carriageway, off everything that stands: Hybrid A* (Dolgov, Thrun, Montemerlo, Diebel,
/// 2008), arcs of single-track motion over cells of place and heading, led by the larger of the
/// Dubins way and the way round what stands. Where the start is nearer to something than the
/// margin, or off the carriageway, it may stay so, but never come into contact or get farther off.
/// Deterministic.
FoundWay find_way(const WheeledShape& shape, const AxlePose& start, const AxlePose& goal,
                  const DrivableSpace& space, const HybridAStarParameters& parameters = {});

}  // namespace sumogamma
