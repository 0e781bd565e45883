#include "road/mid_block.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

/// Do two straight pieces have a point in common? Ends included, parallel ones don't.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return cross(b - a, c - a) * cross(b - a, d - a) <= 0.0 &&
         cross(d - c, a - c) * cross(d - c, b - c) < 0.0;
}

bool meets_chain(const Vec2& a, const Vec2& b, const std::vector<Vec2>& chain, bool closed) {
  for (std::size_t i = 0; i + 1 < chain.size(); ++i)
    if (meet(a, b, chain[i], chain[i + 1])) return true;
  return closed && chain.size() > 2 && meet(a, b, chain.back(), chain.front());
}

/// Does nothing but the lanes of two edges lie between two places?
bool is_clear(const RoadNetwork& network, EdgeId edge, EdgeId twin, const Vec2& a, const Vec2& b) {
  return std::none_of(network.lanes.begin(), network.lanes.end(),
                      [&](const Lane& lane) {
                        return lane.edge != edge && lane.edge != twin &&
                               meets_chain(a, b, lane.centerline.points(), false);
                      }) &&
         std::none_of(network.obstacles.begin(), network.obstacles.end(), [&](const Obstacle& o) {
           return meets_chain(a, b, o.outline, o.kind != ObstacleKind::Barrier);
         });
}

}  // namespace

LaneId sidewalk_across(const RoadNetwork& network, LaneId sidewalk) {
  const Edge& edge = network.edge(network.lane(sidewalk).edge);
  const Polyline& line = network.lane(sidewalk).centerline;
  const Vec2 middle = line.point_at(0.5 * line.length());
  LaneId nearest = kNoLane;
  double distance = 0.0;
  for (std::size_t i = 0; i < network.edges.size(); ++i) {
    const Edge& other = network.edges[i];
    if (other.from != edge.to || other.to != edge.from || other.kind != LaneKind::Normal) continue;
    const LaneId lane = walking_lane(network, static_cast<EdgeId>(i));
    if (lane == kNoLane || lane == sidewalk) continue;
    const double away = network.lane(lane).centerline.project(middle).distance;
    if (nearest != kNoLane && away >= distance) continue;
    nearest = lane;
    distance = away;
  }
  return nearest;
}

std::optional<MidBlock> find_mid_block(const RoadNetwork& network, LaneId sidewalk, LaneId across,
                                       double from, double to, double draw) {
  constexpr double kFromEnds = 15.0;  // [m]
  constexpr double kFirst = 3.0;      // along the sidewalk at the least [m]
  constexpr double kWidest = 30.0;    // [m]
  constexpr double kAskew = 0.3;      // of the way over, along the sidewalks
  constexpr double kLevel = 1.5;      // [m]
  const Lane &here = network.lane(sidewalk), &there = network.lane(across);
  // only such lanes end at a kerb
  if (!is_without_motors(here) || !is_without_motors(there)) return std::nullopt;
  const double ahead = to < from ? -1.0 : 1.0;
  const double first = from + ahead * kFirst;
  const double low = std::max(std::min(first, to), kFromEnds);
  const double high = std::min(std::max(first, to), here.centerline.length() - kFromEnds);
  if (low > high || std::abs(to - from) < kFirst) return std::nullopt;
  MidBlock over;
  over.across = across;
  over.leave = ahead > 0.0 ? low + draw * (high - low) : high - draw * (high - low);
  const Vec2 kerb = here.centerline.point_at(over.leave);
  over.enter = there.centerline.project(kerb).along;
  if (over.enter < kFromEnds || over.enter > there.centerline.length() - kFromEnds)
    return std::nullopt;
  const Vec2 way = there.centerline.point_at(over.enter) - kerb;
  over.width = way.norm();
  if (over.width > kWidest || over.width < here.width + there.width) return std::nullopt;
  for (const Vec2& direction :
       {here.centerline.direction_at(over.leave), there.centerline.direction_at(over.enter)})
    if (std::abs(direction.dot(way)) > kAskew * over.width) return std::nullopt;
  if (std::abs(elevation_at(here, over.leave) - elevation_at(there, over.enter)) > kLevel)
    return std::nullopt;
  if (!is_clear(network, here.edge, there.edge, kerb, kerb + way)) return std::nullopt;
  return over;
}

}  // namespace sumogamma
