#include "road/lane_crossings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace sumogamma {

namespace {

/// The ends of a line reach a little further: from one lane to the next there may be a gap [m].
constexpr double kGap = 1.0;

/// A box along both axes [m].
struct Box {
  Vec2 lower = Vec2::Constant(std::numeric_limits<double>::infinity());
  Vec2 upper = -lower;

  void add(const Vec2& low, const Vec2& high) {
    lower = lower.cwiseMin(low);
    upper = upper.cwiseMax(high);
  }
  bool meets(const Box& other) const {
    return (lower.array() <= other.upper.array()).all() &&
           (other.lower.array() <= upper.array()).all();
  }
};

/// Successive pieces of a line and a box about them, ends that reach further included. Maps made
/// from other formats have a point every metre: pieces far apart needn't be held against each
/// other.
struct Run {
  std::size_t begin = 0, end = 0;  ///< pieces
  Box box;
};

struct RunsOfLane {
  LaneId lane = kNoLane;
  std::vector<Run> runs;
  Box box;
};

RunsOfLane runs_of(const RoadNetwork& network, LaneId id) {
  constexpr std::size_t kPieces = 16;
  const std::vector<Vec2>& line = network.lane(id).centerline.points();
  RunsOfLane lane{id, {}, {}};
  for (std::size_t begin = 0; begin + 1 < line.size(); begin += kPieces) {
    Run run{begin, std::min(begin + kPieces, line.size() - 1), {}};
    for (std::size_t k = begin; k <= run.end; ++k) run.box.add(line[k], line[k]);
    run.box.lower.array() -= kGap;
    run.box.upper.array() += kGap;
    lane.box.add(run.box.lower, run.box.upper);
    lane.runs.push_back(run);
  }
  return lane;
}

/// Does a share of the piece from point i on lie on the line?
bool lies_on(const std::vector<Vec2>& line, std::size_t i, double share) {
  const double gap = kGap / std::max((line[i + 1] - line[i]).norm(), 1e-3);
  return share >= (i == 0 ? -gap : 0.0) && share <= (i + 2 == line.size() ? 1.0 + gap : 1.0);
}

/// Difference in height where piece i of one lane crosses a run of the other, if it does [m].
std::optional<double> rise_on_piece(const Lane& one, std::size_t i, const Lane& other,
                                    const Run& run) {
  const std::vector<Vec2>&a = one.centerline.points(), &b = other.centerline.points();
  const Vec2 along = a[i + 1] - a[i];
  for (std::size_t j = run.begin; j < run.end; ++j) {
    const Vec2 across = b[j + 1] - b[j];
    const auto share = crossing_shares(a[i], along, b[j], across);
    if (!share || !lies_on(a, i, share->x()) || !lies_on(b, j, share->y())) continue;
    return elevation_at(one, one.centerline.along_of_vertex(i) + share->x() * along.norm()) -
           elevation_at(other, other.centerline.along_of_vertex(j) + share->y() * across.norm());
  }
  return std::nullopt;
}

/// Difference in height where the centerlines of two lanes first cross, if they do [m].
std::optional<double> rise_at_crossing(const RoadNetwork& network, const RunsOfLane& one,
                                       const RunsOfLane& other) {
  const Lane &own = network.lane(one.lane), &their = network.lane(other.lane);
  for (const Run& run : one.runs) {
    if (!run.box.meets(other.box)) continue;
    for (std::size_t i = run.begin; i < run.end; ++i)
      for (const Run& against : other.runs) {
        if (!run.box.meets(against.box)) continue;
        if (const auto rise = rise_on_piece(own, i, their, against)) return rise;
      }
  }
  return std::nullopt;
}

void add_crossing(const RunsOfLane& one, const RunsOfLane& other, RoadNetwork& network) {
  const auto rise = rise_at_crossing(network, one, other);
  if (!rise) return;
  const bool apart = std::abs(*rise) > kLeastStorey || layers_differ(network, one.lane, other.lane);
  network.lanes[index_of(one.lane)].crossings.push_back({other.lane, apart});
}

/// Lanes with their runs, in order of the left sides of their boxes.
std::vector<RunsOfLane> all_runs(const RoadNetwork& network) {
  std::vector<RunsOfLane> lanes;
  for (std::size_t i = 0; i < network.lanes.size(); ++i) {
    RunsOfLane lane = runs_of(network, LaneId(static_cast<int>(i)));
    if (!lane.runs.empty()) lanes.push_back(std::move(lane));
  }
  std::sort(lanes.begin(), lanes.end(), [](const RunsOfLane& a, const RunsOfLane& b) {
    return a.box.lower.x() < b.box.lower.x();
  });
  return lanes;
}

/// By lane of all_runs(): those whose boxes meet its own, itself included.
std::vector<std::vector<std::uint32_t>> lanes_near(const std::vector<RunsOfLane>& lanes) {
  std::vector<std::vector<std::uint32_t>> near(lanes.size());
  for (std::uint32_t one = 0; one < lanes.size(); ++one)
    for (std::uint32_t other = one;
         other < lanes.size() && lanes[other].box.lower.x() <= lanes[one].box.upper.x(); ++other) {
      if (!lanes[one].box.meets(lanes[other].box)) continue;
      near[one].push_back(other);
      if (other != one) near[other].push_back(one);
    }
  return near;
}

void find_crossings(RoadNetwork& network, Workers& workers) {
  const std::vector<RunsOfLane> lanes = all_runs(network);
  const auto near = lanes_near(lanes);
  workers.for_each_range(lanes.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t one = begin; one < end; ++one) {
      for (const std::uint32_t other : near[one]) add_crossing(lanes[one], lanes[other], network);
      auto& crossings = network.lanes[index_of(lanes[one].lane)].crossings;
      std::sort(crossings.begin(), crossings.end(),
                [](const LaneCrossing& a, const LaneCrossing& b) { return a.other < b.other; });
    }
  });
}

/// Adds a neighbour, unless a way to it that isn't longer is known. Whoever searches takes the
/// first that is near enough: of longer ones behind shorter ones there is no need.
void add_neighbour(JunctionId from, JunctionId to, double way,
                   std::vector<JunctionNeighbour>& neighbours) {
  if (to == kNoJunction || to == from || way > kJoined) return;
  if (std::none_of(neighbours.begin(), neighbours.end(), [&](const JunctionNeighbour& known) {
        return known.junction == to && known.way <= way;
      }))
    neighbours.push_back({to, way});
}

void find_neighbours(RoadNetwork& network) {
  for (std::size_t i = 0; i < network.junctions.size(); ++i) {
    Junction& junction = network.junctions[i];
    for (const ConnectionId id : junction.links) {
      if (id == kNoConnection) continue;
      for (const LaneId lane : {network.connection(id).from, network.connection(id).to}) {
        const Edge& edge = network.edge(network.lane(lane).edge);
        for (const JunctionId end : {edge.from, edge.to})
          add_neighbour(JunctionId(static_cast<int>(i)), end,
                        network.lane(lane).centerline.length(), junction.neighbours);
      }
    }
  }
}

}  // namespace

bool has_storeys(const RoadNetwork& network) {
  return network.has_layers || !network.overpasses.empty() ||
         std::any_of(network.lanes.begin(), network.lanes.end(),
                     [](const Lane& lane) { return !lane.elevation.empty(); });
}

void find_lane_crossings(RoadNetwork& network, Workers& workers) {
  for (Lane& lane : network.lanes) lane.crossings.clear();
  for (Junction& junction : network.junctions) junction.neighbours.clear();
  if (!has_storeys(network)) return;
  find_crossings(network, workers);
  find_neighbours(network);
}

const LaneCrossing* crossing_with(const Lane& lane, LaneId other) {
  const auto found =
      std::lower_bound(lane.crossings.begin(), lane.crossings.end(), other,
                       [](const LaneCrossing& crossing, LaneId id) { return crossing.other < id; });
  return found != lane.crossings.end() && found->other == other ? &*found : nullptr;
}

}  // namespace sumogamma
