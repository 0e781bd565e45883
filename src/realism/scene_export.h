#pragma once

#include <string>
#include <vector>

#include "realism/recorded_scene.h"
#include "road/road_network.h"

namespace sumogamma {

/// A recording as a standalone scene (simulation/scene_file.h) from a step on.
struct OpenScene {
  int start = 0;                          ///< step
  std::size_t present = 0, arriving = 0;  ///< agents in either file
  std::string scene;                      ///< who is there then
  std::string arrivals;                   ///< who comes later: the same columns behind time_s
  std::string obstacles;                  ///< JSON as it stands beside recordings; empty: none
};

/// Given with each agent, from all of its track: its last place as its goal, and as the speed that
/// it prefers the 85th percentile of those it had. Throws Error naming the recording where nobody
/// is there at that step.
OpenScene open_scene_of(const RecordedScene& scene, int start);

/// A recording as SUMO's demand on a network, from its first step on.
struct RoadScene {
  std::string routes;  ///< a route file: types by size, vehicles, people
  std::size_t vehicles = 0, people = 0;
  std::size_t no_route = 0;          ///< motor vehicles left out
  std::size_t beside_lanes = 0;      ///< bicycles left out: fewer than 95 % of their points near it
  std::size_t no_sidewalk = 0;       ///< people left out
  std::size_t points = 0, near = 0;  ///< of all motor vehicles, see MatchedRoute
  std::vector<std::uint32_t> worst;  ///< ids of those with fewer than 95 % of their points near it
};

/// The share of all motor vehicles' points that has to lie by their routes.
inline constexpr double kLeastOnRoutes = 0.95;

RoadScene road_scene_of(const RecordedScene& scene, const RoadNetwork& network);

/// A route as SUMO's files have it.
std::string edge_names(const RoadNetwork& network, const std::vector<EdgeId>& edges);

}  // namespace sumogamma
