#include "scene/storey.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <memory_resource>
#include <utility>
#include <vector>

namespace sumogamma {

namespace {

/// A vector on the stack, unless it gets long: these functions are asked for each pair of agents.
template <typename Value>
class OnStack {
 public:
  OnStack() { values_.reserve(kUsual); }
  std::pmr::vector<Value>& values() { return values_; }

 private:
  static constexpr std::size_t kUsual = 48;
  alignas(Value) std::array<std::byte, kUsual * sizeof(Value)> bytes_;
  std::pmr::monotonic_buffer_resource memory_{bytes_.data(), bytes_.size()};
  std::pmr::vector<Value> values_{&memory_};
};

/// A junction and how far along the road it is from where the search began [m].
struct Reached {
  JunctionId junction;
  double way;
};

void reach(JunctionId junction, double way, std::pmr::vector<Reached>& reached) {
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
  OnStack<Reached> searched;
  std::pmr::vector<Reached>& reached = searched.values();
  for (const Reached& end : ends_of(network, a)) reach(end.junction, end.way, reached);
  // in the order in which they are come upon, near enough to the order of their ways
  for (std::size_t k = 0; k < reached.size(); ++k) {
    const Reached here = reached[k];
    for (const Reached& end : ends)
      if (end.junction == here.junction && here.way + end.way <= kJoined)
        shortest = std::min(shortest, here.way + end.way);
    for (const JunctionNeighbour& next : network.junction(here.junction).neighbours)
      reach(next.junction, here.way + next.way, reached);
  }
  return shortest;
}

/// Where a place's lane begins or ends nearby the crossing may be on the one before or behind [m].
constexpr double kSeam = 12.0;

/// Adds a lane and those that it leads into over the next `left` [m].
void go_on(const RoadNetwork& network, LaneId id, double left, std::pmr::vector<LaneId>& lanes) {
  if (left < 0.0 || std::find(lanes.begin(), lanes.end(), id) != lanes.end()) return;
  lanes.push_back(id);
  left -= network.lane(id).centerline.length();
  for (const ConnectionId next : network.lane(id).outgoing) {
    const Connection& link = network.connection(next);
    go_on(network, link.via != kNoLane ? link.via : link.to, left, lanes);
  }
}

/// Adds those that lead into a lane over the last `left` [m] before its begin.
void go_back(const RoadNetwork& network, LaneId id, double left, std::pmr::vector<LaneId>& lanes) {
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

/// Adds the lane of a place and those that it leads into or comes from within kSeam.
void add_lanes_about(const RoadNetwork& network, const Ground& place,
                     std::pmr::vector<LaneId>& lanes) {
  go_on(network, place.lane, kSeam + place.along, lanes);
  go_back(network, place.lane, kSeam - place.along, lanes);
}

/// Does the road of one place, with what it leads into and comes from, cross that of the other
/// above or below?
bool crosses_nearby(const RoadNetwork& network, const Ground& a, const Ground& b) {
  OnStack<LaneId> about_a, about_b;
  add_lanes_about(network, a, about_a.values());
  for (const LaneId one : about_a.values())
    for (const LaneCrossing& crossing : network.lane(one).crossings) {
      if (!crossing.apart) continue;
      if (about_b.values().empty()) add_lanes_about(network, b, about_b.values());
      const auto& others = about_b.values();
      if (std::find(others.begin(), others.end(), crossing.other) != others.end()) return true;
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

bool lies_above_or_below(const RoadNetwork& network, const Ground& a, const Ground& b) {
  const double rise = std::abs(a.height - b.height);
  const bool layers = layers_differ(network, a.lane, b.lane);
  const double over_crossing = way_over_crossing(network, a, b);
  if (std::isfinite(over_crossing)) return over_crossing < way_between(network, a, b);
  if (rise <= kLeastStorey && !layers) return false;
  if (a.lane == b.lane && a.lane != kNoLane) return false;
  if (a.lane == kNoLane || b.lane == kNoLane) return rise > kStorey;
  if (std::isfinite(way_between(network, a, b))) return false;
  if (const LaneCrossing* crossing = crossing_with(network.lane(a.lane), b.lane))
    return crossing->apart;
  return rise > kStorey || crosses_nearby(network, a, b);
}

}  // namespace sumogamma
