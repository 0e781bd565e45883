#include "sumo/changing_limits.h"

#include <algorithm>

namespace sumogamma {

ChangingLimits find_changing_limits(const RoadNetwork& network,
                                    const std::vector<std::string>& sign_lanes, bool any) {
  ChangingLimits changing;
  for (const std::string& name : sign_lanes) {
    const auto lane = network.lane_by_name.find(name);
    if (!any && lane != network.lane_by_name.end()) changing.lanes.push_back(lane->second);
  }
  for (std::size_t i = 0; any && i < network.lanes.size(); ++i)
    if (network.lanes[i].kind == LaneKind::Normal) changing.lanes.push_back(static_cast<LaneId>(i));
  if (changing.lanes.empty()) return changing;
  changing.limits = std::make_shared<std::vector<double>>();
  for (const Lane& lane : network.lanes) changing.limits->push_back(lane.speed_limit);
  return changing;
}

std::vector<bool> read_limits(const RoadNetwork& network, double now, SumoBackend& backend,
                              ChangingLimits& changing) {
  constexpr double kInterval = 1.0;  // [s]
  if (!changing.limits || now < changing.next_look) return {};
  changing.next_look = now + kInterval;
  std::vector<std::string> names;
  for (const LaneId lane : changing.lanes) names.push_back(network.lane(lane).name);
  const std::vector<double> speeds = backend.lane_speeds(names);
  std::vector<bool> changed;
  for (std::size_t i = 0; i < changing.lanes.size(); ++i) {
    const std::size_t lane = index_of(changing.lanes[i]);
    double& limit = (*changing.limits)[lane];
    if (speeds[i] < 0.0 || speeds[i] == limit) continue;
    limit = speeds[i];
    changed.resize(network.lanes.size(), false);
    changed[lane] = true;
  }
  return changed;
}

bool uses_lanes(const Path& path, const std::vector<bool>& lanes) {
  return path.trip &&
         std::any_of(path.stretches.begin(), path.stretches.end(), [&](const PathStretch& stretch) {
           return stretch.lane != kNoLane && lanes[index_of(stretch.lane)];
         });
}

}  // namespace sumogamma
