#include "scene/storey.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

namespace sumogamma {

namespace {

// no road climbs a storey within this [m]
constexpr double kJoined = 40.0;

/// A junction and how far along the road it is from where the search began [m].
struct Reached {
  JunctionId junction;
  double way;
};

void reach(JunctionId junction, double way, std::vector<Reached>& reached) {
  if (junction == kNoJunction || way > kJoined) return;
  const auto known = std::find_if(reached.begin(), reached.end(),
                                  [&](const Reached& r) { return r.junction == junction; });
  if (known == reached.end()) reached.push_back({junction, way});
}

/// The ends of the lane of a place.
std::array<Reached, 2> ends_of(const RoadNetwork& network, const Ground& place) {
  const Lane& lane = network.lane(place.lane);
  if (lane.kind != LaneKind::Normal) return {{{lane.junction, 0.0}, {lane.junction, 0.0}}};
  const Edge& edge = network.edge(lane.edge);
  return {
      {{edge.from, place.along}, {edge.to, std::max(lane.centerline.length() - place.along, 0.0)}}};
}

/// Do at most kJoined metres of road lead from one place to the other, in whatever direction?
bool joined(const RoadNetwork& network, const Ground& a, const Ground& b) {
  const EdgeId edge = network.lane(a.lane).edge;
  if (edge == network.lane(b.lane).edge) return std::abs(a.along - b.along) <= kJoined;
  const std::array<Reached, 2> ends = ends_of(network, b);
  std::vector<Reached> reached;
  for (const Reached& end : ends_of(network, a)) reach(end.junction, end.way, reached);
  // in the order in which they are come upon, near enough to the order of their ways
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Reached here = reached[k];
    for (const Reached& end : ends)
      if (end.junction == here.junction && here.way + end.way <= kJoined) return true;
    for (const ConnectionId id : network.junction(here.junction).links) {
      if (id == kNoConnection) continue;
      const Connection& link = network.connection(id);
      for (const LaneId lane : {link.from, link.to}) {
        const Edge& next = network.edge(network.lane(lane).edge);
        const double way = here.way + network.lane(lane).centerline.length();
        reach(next.from, way, reached);
        reach(next.to, way, reached);
      }
    }
  }
  return false;
}

/// Difference in height where the centerlines of two lanes cross, if they do [m].
std::optional<double> rise_at_crossing(const Lane& one, const Lane& other) {
  const std::vector<Vec2>&a = one.centerline.points(), &b = other.centerline.points();
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    const Vec2 along = a[i + 1] - a[i];
    for (std::size_t j = 0; j + 1 < b.size(); ++j) {
      const Vec2 across = b[j + 1] - b[j], between = b[j] - a[i];
      const double area = cross(along, across);
      if (area == 0.0) continue;
      const double s = cross(between, across) / area, t = cross(between, along) / area;
      if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) continue;
      return elevation_at(one, one.centerline.along_of_vertex(i) + s * along.norm()) -
             elevation_at(other, other.centerline.along_of_vertex(j) + t * across.norm());
    }
  }
  return std::nullopt;
}

}  // namespace

bool lies_above_or_below(const RoadNetwork& network, const Ground& a, const Ground& b) {
  const double rise = std::abs(a.height - b.height);
  if (rise <= kLeastStorey || (a.lane == b.lane && a.lane != kNoLane)) return false;
  if (a.lane == kNoLane || b.lane == kNoLane) return rise > kStorey;
  if (joined(network, a, b)) return false;
  const auto at_crossing = rise_at_crossing(network.lane(a.lane), network.lane(b.lane));
  return at_crossing ? std::abs(*at_crossing) > kLeastStorey : rise > kStorey;
}

}  // namespace sumogamma
