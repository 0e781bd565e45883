#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "model/model.h"
#include "realism/free_run.h"
#include "realism/map_matching.h"
#include "realism/window_cast.h"
#include "road/path.h"
#include "road/road.h"
#include "scene/road_state.h"

namespace sumogamma {

/// A recording on the network of its place: its agents are those that have a route there.
struct RecordedRoad {
  std::filesystem::path file;
  Road road;
  std::vector<MatchedRoute> routes;  ///< by agent of the recording
  std::size_t no_route = 0;          ///< vehicles left out
  std::size_t beside_lanes = 0;      ///< bicycles left out: they ride where the map has no lane
  std::size_t people = 0;            ///< people left out
};

/// Reads a network and matches the recording's routes on it; takes those without one out of the
/// recording. Throws Error naming the network where under 95 % of the motor vehicles' points lie by
/// their routes, or nobody is left.
RecordedRoad put_on_road(const std::filesystem::path& network, Workers& workers,
                         RecordedScene& scene);

/// The factor on speed limits by which somebody wants to go: normal about 1, sd 0.1, as SUMO draws
/// for its vehicles, but no less than what it does now. A pure function of its arguments.
double limit_factor(double speed, double limit, std::uint64_t seed, std::uint32_t id);

/// Where somebody is on its route: the edge, and the lane of it by which it gets on nearest to its
/// place.
struct RoutePlace {
  std::size_t edge = 0;  ///< of the route
  LaneId lane = kNoLane;
  double along = 0;     ///< of the centre along the lane, its end where it is on the junction [m]
  LaneId on = kNoLane;  ///< the lane under it: that one, or one on the junction
};
RoutePlace place_on_route(const RoadNetwork& network, const MatchedRoute& route,
                          const MotionState& state, VehicleClassMask classes);

/// GAMMA in closed loop on a network: what `run` does in a tick (advance_rows), with the rules of
/// the road and the network's own signals, whose programs' time 0 is the recording's first step.
/// Everybody is moved by the model in steps of 0.05 s.
///
/// Given as for ClosedLoop, but for the destination: it is the matched route. Drawn from seed and
/// agent: what a run draws of the types' behavior, and limit_factor.
class RoadLoop {
 public:
  /// `behavior`: how types drive, by name.
  RoadLoop(const RecordedScene& scene, const RecordedRoad& road, const ModelOptions& options,
           const AgentTypeTable& behavior, Workers& workers);

  /// One rollout of a window.
  Rollout drive(const ScoreWindow& window, std::uint64_t seed, EntryCounts& entries) const;
  /// All of the recording; somebody has arrived where its path is nearest to its last place.
  FreeRun drive_freely(std::uint64_t seed) const;

 private:
  RoadState unlit_road() const;
  void complete(const RecordedAgent& who, const MotionState& state, std::uint64_t seed,
                RoadState& road, AgentState& row) const;
  std::shared_ptr<const Path> path_of(const RecordedAgent& who, const MotionState& state,
                                      double factor) const;

  const RecordedScene& scene_;
  const RecordedRoad& road_;
  Workers& workers_;
  Model model_;
};

}  // namespace sumogamma
