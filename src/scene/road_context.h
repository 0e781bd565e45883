#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "geometry/vec2.h"
#include "road/road_network.h"

namespace sumogamma {

enum class PathId : std::int32_t {};
inline constexpr PathId kNoPath{-1};

/// Why an agent may go no faster along its path.
enum class LimitReason : std::uint8_t {
  None,
  Signal,
  Yield,
  Crossing,
  BlockedJunction,
  Leader,
  Stop,
  Merge,
  GivesWay,     ///< after backing out of a deadlock
  TurningRoom,  ///< that a long body needs where it turns
  LetsIn        ///< somebody into a full road
};

/// Over which RoadContext::bend is taken: as far as avoidance between vehicles on a road looks [s].
inline constexpr double kBendTime = 1.5;

/// What the road says about one agent at one instant, computed from the frozen scene before anyone
/// moves and turned into half-planes by append_contextual_constraints (III-C). Everything along
/// `tangent`, the path's direction here.
struct RoadContext {
  bool active = false;           ///< false: off any road, no contextual constraint
  Vec2 tangent = Vec2(1, 0);     ///< unit direction of the path at the agent
  Vec2 sub_goal = Vec2::Zero();  ///< look-ahead point on the path [m] (III-D)
  Vec2 bend = Vec2(1, 0);  ///< the mean velocity on its path over the next kBendTime is the present
                           ///< one turned and shortened by this (a product of complex numbers)
  double speed_limit = 0;  ///< road, bend and type [m/s]; the preferred speed
  double room_left = std::numeric_limits<double>::infinity();   ///< footprint's side to the left
                                                                ///< boundary [m], < 0 beyond it
  double room_right = std::numeric_limits<double>::infinity();  ///< likewise to the right [m]
  /// To the left edge of its carriageway [m], from as far out as its middle gets if it turns back
  /// to `tangent` as tightly as it can; < 0 beyond it, infinite on foot and amid a junction.
  double edge_left = std::numeric_limits<double>::infinity();
  double edge_right = std::numeric_limits<double>::infinity();  ///< likewise to the right [m]
  /// On foot: the ways from the outline to the nearest red crossings that it isn't on [m], and the
  /// last one on over its own while it steps back from that; zero where there is none.
  std::array<Vec2, 3> to_red = {Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
  double allowed_speed =
      std::numeric_limits<double>::infinity();  ///< most speed along `tangent` that leader, signals
                                                ///< and rules leave [m/s]
  double to_halt =
      std::numeric_limits<double>::infinity();  ///< way to where the front comes to rest before a
                                                ///< link, as things are [m]
  LaneId merge_to = kNoLane;  ///< lane into which it has to change soon, kNoLane: none
  double aside = 0;     ///< how far aside of where it likes to be it means to pass others [m, left]
  bool at_red = false;  ///< waits before a red light, if not as the first: others there do, too
  LimitReason reason = LimitReason::None;
  std::int64_t foe = -1;  ///< id of the agent that binds, -1 where none does
};

}  // namespace sumogamma
