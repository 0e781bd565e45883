#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ego/ego_view.h"
#include "road/path.h"
#include "scene/road_state.h"

namespace sumogamma {

/// A place where an ego may begin, and its route from there.
struct EgoStart {
  LaneId lane = kNoLane;
  double front = 0;  ///< of its front along that lane [m]
  std::vector<EdgeId> route;
  Vec2 position = Vec2::Zero();  ///< of its centre
  double heading = 0;            ///< [rad]
};

/// Draws starts: every metre of lanes for the ego's class in the window is as likely.
class StartDraw {
 public:
  /// Throws Error where the window has no such lane, or [ego] goal_edge is none that the class may
  /// use or that could be reached from there. `network` must outlive it.
  StartDraw(const RoadNetwork& network, const AgentType& type, const EgoSettings& settings);

  /// The `attempt`-th draw of a seed: a pure function of both. Nothing where no way of the length
  /// wanted, or to the edge wanted, leads on from there.
  std::optional<EgoStart> draw(std::uint64_t seed, std::uint64_t attempt) const;

 private:
  bool is_goal_reachable() const;
  std::vector<EdgeId> random_route(LaneId from, double front, std::uint64_t key) const;

  const RoadNetwork& network_;
  VehicleClassMask class_;
  double length_, way_;
  EdgeId goal_ = kNoEdge;
  std::vector<double> travel_times_;
  std::vector<std::pair<LaneId, double>> places_;
};

/// Is nobody within `clearance` [m] of an ego that would stand there, nor on a way over it that is
/// too short to brake on?
bool is_free(const Scene& scene, const RoadState& road, const EgoStart& start,
             const AgentType& type, double clearance);

/// The goal of an ego that is `along` its path: so many metres on, the place on the edge wanted, or
/// where its trip ends. `drawn`: its route was made for it. Throws Error where that is behind it or
/// nearer than kGoalRadius.
EgoGoal goal_on(const RoadNetwork& network, const Path& path, double along, double length,
                const EgoSettings& settings, bool drawn);

}  // namespace sumogamma
