#include "scene/storey.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
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

/// Way by road from one place to the other, in whatever direction; infinite over kJoined [m].
double way_between(const RoadNetwork& network, const Ground& a, const Ground& b) {
  double shortest = std::numeric_limits<double>::infinity();
  if (network.lane(a.lane).edge == network.lane(b.lane).edge) {
    const double way = std::abs(a.along - b.along);
    return way <= kJoined ? way : shortest;
  }
  const std::array<Reached, 2> ends = ends_of(network, b);
  std::vector<Reached> reached;
  for (const Reached& end : ends_of(network, a)) reach(end.junction, end.way, reached);
  // in the order in which they are come upon, near enough to the order of their ways
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Reached here = reached[k];
    for (const Reached& end : ends)
      if (end.junction == here.junction && here.way + end.way <= kJoined)
        shortest = std::min(shortest, here.way + end.way);
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
  return shortest;
}

/// The ends of a line reach a little further: from one lane to the next there may be a gap [m].
constexpr double kGap = 1.0;

/// Does a share of the piece from point i on lie on the line?
bool lies_on(const std::vector<Vec2>& line, std::size_t i, double share) {
  const double gap = kGap / std::max((line[i + 1] - line[i]).norm(), 1e-3);
  return share >= (i == 0 ? -gap : 0.0) && share <= (i + 2 == line.size() ? 1.0 + gap : 1.0);
}

/// Successive pieces of a line and a box about them, ends that reach further included. Maps made
/// from other formats have a point every metre: pieces far apart needn't be held against each
/// other.
struct Run {
  std::size_t begin = 0, end = 0;  ///< pieces
  Vec2 lower = Vec2::Zero(), upper = Vec2::Zero();

  bool meets(const Run& other) const {
    return (lower.array() <= other.upper.array()).all() &&
           (other.lower.array() <= upper.array()).all();
  }
};

std::vector<Run> runs_of(const std::vector<Vec2>& line) {
  constexpr std::size_t kPieces = 16;
  std::vector<Run> runs;
  for (std::size_t begin = 0; begin + 1 < line.size(); begin += kPieces) {
    Run run{begin, std::min(begin + kPieces, line.size() - 1), line[begin], line[begin]};
    for (std::size_t k = begin; k <= run.end; ++k) {
      run.lower = run.lower.cwiseMin(line[k]);
      run.upper = run.upper.cwiseMax(line[k]);
    }
    run.lower.array() -= kGap;
    run.upper.array() += kGap;
    runs.push_back(run);
  }
  return runs;
}

/// Difference in height where the centerlines of two lanes cross, if they do [m].
std::optional<double> rise_at_crossing(const Lane& one, const Lane& other) {
  const std::vector<Vec2>&a = one.centerline.points(), &b = other.centerline.points();
  const std::vector<Run> others = runs_of(b);
  std::vector<Run> near;
  for (const Run& run : runs_of(a)) {
    near.clear();
    std::copy_if(others.begin(), others.end(), std::back_inserter(near),
                 [&](const Run& their) { return run.meets(their); });
    for (std::size_t i = run.begin; !near.empty() && i < run.end; ++i) {
      const Vec2 along = a[i + 1] - a[i];
      for (const Run& their : near)
        for (std::size_t j = their.begin; j < their.end; ++j) {
          const Vec2 across = b[j + 1] - b[j];
          const auto share = crossing_shares(a[i], along, b[j], across);
          if (!share || !lies_on(a, i, share->x()) || !lies_on(b, j, share->y())) continue;
          return elevation_at(one, one.centerline.along_of_vertex(i) + share->x() * along.norm()) -
                 elevation_at(other,
                              other.centerline.along_of_vertex(j) + share->y() * across.norm());
        }
    }
  }
  return std::nullopt;
}

/// Where a place's lane begins or ends nearby the crossing may be on the one before or behind [m].
constexpr double kSeam = 12.0;

/// Adds a lane and those that it leads into over the next `left` [m].
void go_on(const RoadNetwork& network, LaneId id, double left, std::vector<LaneId>& lanes) {
  if (left < 0.0 || std::find(lanes.begin(), lanes.end(), id) != lanes.end()) return;
  lanes.push_back(id);
  left -= network.lane(id).centerline.length();
  for (const ConnectionId next : network.lane(id).outgoing) {
    const Connection& link = network.connection(next);
    go_on(network, link.via != kNoLane ? link.via : link.to, left, lanes);
  }
}

/// Adds those that lead into a lane over the last `left` [m] before its begin.
void go_back(const RoadNetwork& network, LaneId id, double left, std::vector<LaneId>& lanes) {
  if (left < 0.0) return;
  auto add = [&](LaneId before) {
    if (std::find(lanes.begin(), lanes.end(), before) != lanes.end()) return;
    lanes.push_back(before);
    go_back(network, before, left - network.lane(before).centerline.length(), lanes);
  };
  const Lane& lane = network.lane(id);
  for (const ConnectionId before : lane.incoming) {
    const Connection& link = network.connection(before);
    add(link.via != kNoLane ? link.via : link.from);
  }
  if (lane.kind != LaneKind::Internal || lane.junction == kNoJunction) return;
  for (const ConnectionId link : network.junction(lane.junction).links)
    if (link != kNoConnection && network.connection(link).via == id)
      add(network.connection(link).from);
}

/// The lane of a place and those that it leads into or comes from within kSeam.
std::vector<LaneId> lanes_about(const RoadNetwork& network, const Ground& place) {
  std::vector<LaneId> lanes;
  go_on(network, place.lane, kSeam + place.along, lanes);
  go_back(network, place.lane, kSeam - place.along, lanes);
  return lanes;
}

/// Does the road of one place, with what it leads into and comes from, cross that of the other
/// above or below?
bool crosses_nearby(const RoadNetwork& network, const Ground& a, const Ground& b) {
  const std::vector<LaneId> others = lanes_about(network, b);
  for (const LaneId one : lanes_about(network, a))
    for (const LaneId other : others) {
      const auto rise = rise_at_crossing(network.lane(one), network.lane(other));
      if (rise && (std::abs(*rise) > kLeastStorey || layers_differ(network, one, other)))
        return true;
    }
  return false;
}

/// Way from one place to where its road crosses that of the other, and on to that; infinite where
/// either has more than kNear, or they don't cross [m].
double way_over_crossing(const RoadNetwork& network, const Ground& a, const Ground& b) {
  constexpr double kNear = 40.0;  // [m]
  double shortest = std::numeric_limits<double>::infinity();
  const auto& all = network.overpasses;
  if (all.empty() || a.lane == kNoLane || b.lane == kNoLane) return shortest;
  auto add = [&](double one, double other) {
    one = std::abs(one), other = std::abs(other);
    if (one < kNear && other < kNear) shortest = std::min(shortest, one + other);
  };
  const EdgeId own = network.lane(a.lane).edge, their = network.lane(b.lane).edge;
  const std::pair edges(std::min(own, their), std::max(own, their));
  auto overpass = std::lower_bound(
      all.begin(), all.end(), edges,
      [](const Overpass& one, const auto& pair) { return std::pair(one.one, one.other) < pair; });
  for (; overpass != all.end() && std::pair(overpass->one, overpass->other) == edges; ++overpass) {
    if (own <= their) add(a.along - overpass->along_one, b.along - overpass->along_other);
    if (their <= own) add(b.along - overpass->along_one, a.along - overpass->along_other);
  }
  return shortest;
}

}  // namespace

bool has_storeys(const RoadNetwork& network) {
  return network.has_layers || !network.overpasses.empty() ||
         std::any_of(network.lanes.begin(), network.lanes.end(),
                     [](const Lane& lane) { return !lane.elevation.empty(); });
}

bool lies_above_or_below(const RoadNetwork& network, const Ground& a, const Ground& b) {
  const double rise = std::abs(a.height - b.height);
  const bool layers = layers_differ(network, a.lane, b.lane);
  const double over_crossing = way_over_crossing(network, a, b);
  if (std::isfinite(over_crossing)) return over_crossing < way_between(network, a, b);
  if (rise <= kLeastStorey && !layers) return false;
  if (a.lane == b.lane && a.lane != kNoLane) return false;
  if (a.lane == kNoLane || b.lane == kNoLane) return rise > kStorey;
  if (std::isfinite(way_between(network, a, b))) return false;
  const auto at_crossing = rise_at_crossing(network.lane(a.lane), network.lane(b.lane));
  if (at_crossing) return layers || std::abs(*at_crossing) > kLeastStorey;
  return rise > kStorey || crosses_nearby(network, a, b);
}

}  // namespace sumogamma
