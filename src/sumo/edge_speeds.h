#pragma once

#include <string>
#include <utility>
#include <vector>

#include "road/road_network.h"
#include "scene/scene.h"

namespace sumogamma {

/// Mean speeds on the edges of the network, as SUMO's rerouting devices smooth them (its page on
/// automatic routing: an average over 180 intervals of a second). SUMO's own know nothing of who
/// drives off its lanes.
class EdgeSpeeds {
 public:
  EdgeSpeeds() = default;
  explicit EdgeSpeeds(const RoadNetwork& network);

  /// Takes the vehicles of a scene into account; once a second.
  void add(const RoadNetwork& network, const Scene& scene);

  /// Edges whose travel time has changed by a twentieth since it was last taken, with that [s], in
  /// order of edge.
  std::vector<std::pair<EdgeId, double>> take_changes(const RoadNetwork& network);

 private:
  struct Sum {
    double speed = 0;
    int count = 0;
  };
  std::vector<double> speeds_, told_;  // by EdgeId [m/s]; 0: nobody has been there
  std::vector<Sum> sums_;
};

}  // namespace sumogamma
