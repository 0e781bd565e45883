#pragma once

#include <array>
#include <optional>
#include <span>

#include "road/lane_locator.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Ways on that a road offers: straightest, leftmost and rightmost at the next junction.
inline constexpr std::size_t kRoadWays = 3;

/// Where lanes, sidewalks and crossings lead somebody who is seen at a pose: the contextual
/// intention of III-D, guessed from outside, without anybody's route. The network must outlive it.
class RoadGuess {
 public:
  RoadGuess() = default;
  explicit RoadGuess(const RoadNetwork& network) : network_(&network), locator_(network) {}

  /// Ways on from `position` [m], at least `length` [m] where the network goes that far, else
  /// prolonged straight. A lane counts that is within 2 m and runs within 60 degrees of `heading`
  /// [rad] (for people on foot either way along it). Where the lane doesn't branch within reach the
  /// ways are the same. nullopt off the road.
  std::optional<std::array<Polyline, kRoadWays>> ways(const AgentType& type, const Vec2& position,
                                                      double heading, double length) const;

 private:
  /// Connections that a class may take from a lane, straightest, leftmost and rightmost.
  std::array<ConnectionId, kRoadWays> branches(LaneId lane, VehicleClassMask mask) const;
  Polyline follow(LaneId lane, double along, bool reversed, std::size_t way, VehicleClassMask mask,
                  double length) const;

  const RoadNetwork* network_ = nullptr;
  LaneLocator locator_;
};

/// Displacements of somebody who goes along `line` from its projection on, keeping its distance to
/// the line, by `progress` [m] after each step.
void follow_line(const Polyline& line, const Vec2& position, std::span<const double> progress,
                 std::span<Vec2> displacement);

}  // namespace sumogamma
