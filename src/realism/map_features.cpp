#include "realism/map_features.h"

#include <algorithm>
#include <limits>

#include "geometry/segment.h"
#include "road/signal_program.h"
#include "scene/road_state.h"

namespace sumogamma {

std::vector<MapFeatures::StopLine> MapFeatures::stop_lines(const MatchedRoute& route) const {
  const RoadNetwork& network = road_.road.network;
  std::vector<StopLine> lines;
  for (std::size_t edge = 0; edge + 1 < route.edges.size(); ++edge)
    for (const LaneId id : network.edge(route.edges[edge]).lanes) {
      const Lane& lane = network.lane(id);
      const auto onward =
          std::find_if(lane.outgoing.begin(), lane.outgoing.end(), [&](ConnectionId link) {
            const Connection& connection = network.connection(link);
            return connection.signal != kNoSignal &&
                   network.lane(connection.to).edge == route.edges[edge + 1];
          });
      if (onward == lane.outgoing.end()) continue;
      const double length = lane.centerline.length();
      const Vec2 end = lane.centerline.point_at(length);
      const Vec2 aside = 0.5 * lane.width * left_of(lane.centerline.direction_at(length));
      lines.push_back({end + aside, end - aside, *onward});
    }
  return lines;
}

bool MapFeatures::runs_red(const std::vector<StopLine>& lines, double time, const Vec2& before,
                           const Vec2& now) const {
  const RoadNetwork& network = road_.road.network;
  return std::any_of(lines.begin(), lines.end(), [&](const StopLine& line) {
    const Vec2 across = line.left - line.right;
    // from behind the line: its right end is then on the right
    if (cross(Vec2(now - before), across) <= 0.0 ||
        distance_of_segments(before, now, line.left, line.right) > 0.0)
      return false;
    return is_red(light_by_program(network, network.connection(line.link), time));
  });
}

void MapFeatures::add(const ScoreWindow& window, int first, const Poses& poses,
                      MotionFeatures& features) const {
  features.road_edge.assign(poses.position.size(), std::numeric_limits<double>::quiet_NaN());
  features.ran_red.assign(poses.rows(), 0);
  for (std::size_t row = 0; row < poses.rows(); ++row) {
    const std::vector<StopLine> lines = stop_lines(road_.routes[window.agents[row]]);
    const Vec2 half = 0.5 * window.bodies.size[row];
    Vec2 before = Vec2::Zero();
    for (std::size_t step = 0; step < window.bodies.present[row]; ++step) {
      const std::size_t at = row * Poses::kSteps + step;
      const Vec2 forward = direction_of(poses.heading[at]);
      const Vec2 ahead = half.x() * forward, aside = half.y() * left_of(forward);
      const Vec2& center = poses.position[at];
      double farthest = -std::numeric_limits<double>::infinity();
      for (const Vec2& corner :
           {Vec2(ahead + aside), Vec2(ahead - aside), Vec2(aside - ahead), Vec2(-ahead - aside)})
        farthest = std::max(farthest, area_.signed_distance(center + corner));
      features.road_edge[at] = farthest;
      const Vec2 front = center + ahead;
      const double time = kScoreStep * (window.start + static_cast<int>(step) - first);
      if (step > 0 && runs_red(lines, time, before, front)) features.ran_red[row] = 1;
      before = front;
    }
  }
}

}  // namespace sumogamma
