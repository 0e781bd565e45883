#include <algorithm>
#include <limits>
#include <map>
#include <queue>

#include "road/mid_block.h"
#include "road/path.h"
#include "road/path_pieces.h"
#include "road/speed_profile.h"
#include "road/stop_lines.h"
#include "road/walking_room.h"

namespace sumogamma {

namespace {

/// Two who meet on a path too narrow for them step on the verge: each has so much room at least
/// [m].
constexpr double kLeastRoom = 0.75;
/// Beside crossings, and beside lanes that others use, too: who meets a van on a parking aisle of
/// 3.2 m, or bicycles on a path, steps off it [m].
constexpr double kBesideCrossing = 0.5, kVerge = 1.0;

/// Lanes reached from one lane on foot: connections count in both directions.
void for_each_walking_neighbour(const RoadNetwork& network, LaneId id, auto&& visit) {
  for (const ConnectionId c : network.lane(id).outgoing) visit(network.connection(c).to);
  for (const ConnectionId c : network.lane(id).incoming) visit(network.connection(c).from);
}

Vec2 middle_of(const std::vector<Vec2>& outline) {
  Vec2 sum = Vec2::Zero();
  for (const Vec2& point : outline) sum += point;
  return outline.empty() ? sum : Vec2(sum / static_cast<double>(outline.size()));
}

/// A representative place of a walking area or crossing, for distances in the search.
Vec2 middle_of(const Lane& lane) {
  return lane.kind == LaneKind::WalkingArea
             ? middle_of(lane.outline)
             : lane.centerline.point_at(0.5 * lane.centerline.length());
}

/// Walking areas and crossings between two sidewalk ends, by least distance; empty where there is
/// none and they don't touch.
std::vector<LaneId> find_junction_walk(const RoadNetwork& network, LaneId from, LaneId to,
                                       const Vec2& start, const Vec2& end, double& cost) {
  struct Reached {
    double cost;
    LaneId lane;
    bool operator<(const Reached& other) const {
      return cost > other.cost || (cost == other.cost && lane > other.lane);
    }
  };
  std::map<LaneId, std::pair<double, LaneId>> best;  // cost and predecessor
  std::priority_queue<Reached> open;
  open.push({0.0, from});
  best[from] = {0.0, kNoLane};
  while (!open.empty()) {
    const Reached here = open.top();
    open.pop();
    if (here.cost > best[here.lane].first) continue;
    if (here.lane == to) {
      std::vector<LaneId> lanes;
      for (LaneId lane = best[to].second; lane != from && lane != kNoLane; lane = best[lane].second)
        lanes.push_back(lane);
      std::reverse(lanes.begin(), lanes.end());
      cost = here.cost;
      return lanes;
    }
    const Vec2 place = here.lane == from ? start : middle_of(network.lane(here.lane));
    for_each_walking_neighbour(network, here.lane, [&](LaneId next) {
      const Lane& lane = network.lane(next);
      const bool inside = lane.kind == LaneKind::WalkingArea || lane.kind == LaneKind::Crossing;
      if (next != to && !inside) return;
      const double step = ((next == to ? end : middle_of(lane)) - place).norm() +
                          (lane.kind == LaneKind::Crossing ? 4.0 : 0.1);
      const double total = here.cost + step;
      const auto known = best.find(next);
      if (known != best.end() && known->second.first <= total) return;
      best[next] = {total, here.lane};
      open.push({total, next});
    });
  }
  cost = std::numeric_limits<double>::infinity();
  return {};
}

/// Connection by which a crossing is entered: the one that carries its signal and right-of-way
/// index.
ConnectionId crossing_link(const RoadNetwork& network, LaneId crossing) {
  ConnectionId found = kNoConnection;
  for (const auto* list : {&network.lane(crossing).incoming, &network.lane(crossing).outgoing})
    for (const ConnectionId id : *list) {
      const Connection& connection = network.connection(id);
      if (connection.signal != kNoSignal || connection.junction_link >= 0) return id;
      if (found == kNoConnection) found = id;
    }
  return found;
}

/// Takes the first fold out of a path: where the line turns back on itself, as between the ends of
/// lanes that overlap, nobody walks to the tip and back. Places along the path are carried over.
/// False where there was none.
bool cut_fold(Path& path) {
  constexpr double kReversal = -0.7;  // cosine of the turn
  const std::vector<Vec2>& points = path.line.points();
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Vec2 before = points[i - 1] - points[i], after = points[i + 1] - points[i];
    const double in = before.norm(), out = after.norm();
    if (-before.dot(after) > kReversal * in * out) continue;
    const double cut = std::min(in, out), tip = path.line.along_of_vertex(i);
    std::vector<Vec2> shorter(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(i));
    const Vec2 left = points[i] + before * (cut / in), taken = points[i] + after * (cut / out);
    shorter.push_back(left);
    shorter.push_back(taken);
    shorter.insert(shorter.end(), points.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                   points.end());
    const double bridge = (taken - left).norm();
    carry_places(path, [&](double& along) {
      if (along >= tip + cut)
        along += bridge - 2.0 * cut;
      else if (along > tip - cut)
        along = tip - cut + bridge * (along - tip + cut) / (2.0 * cut);
    });
    path.line = Polyline(shorter);
    return true;
  }
  return false;
}

class Walk {
 public:
  explicit Walk(const RoadNetwork& network) : network_(network) { path_.walking = true; }

  void along_lane(LaneId id, double from, double to) {
    const Lane& lane = network_.lane(id);
    PathStretch stretch;
    stretch.lane = id;
    stretch.from = connect_to(lane.centerline.point_at(from));
    stretch.lane_from = from;
    stretch.reversed = to < from;
    stretch.speed_limit = std::max(lane.speed_limit, 1.0);
    const bool shared = (lane.allowed & ~vehicle_class::kPedestrian) != 0;
    const double verge = lane.kind == LaneKind::Crossing ? kBesideCrossing : shared ? kVerge : 0.0;
    stretch.room_left = stretch.room_right = std::max(0.5 * lane.width + verge, kLeastRoom);
    PathLink link{kNoConnection, stretch.from, 0.0, stretch.from};
    path_.stretches.push_back(stretch);
    append_span(lane.centerline, from, to, points_);
    path_.stretches.back().to = length();
    if (lane.kind == LaneKind::Crossing) {
      link.connection = crossing_link(network_, id);
      link.end = length();
      if (link.connection != kNoConnection) path_.links.push_back(link);
    }
  }

  /// Along a sidewalk to where the road is crossed, and straight over to the next one.
  void over_road(LaneId sidewalk, double from, const MidBlock& over) {
    along_lane(sidewalk, from, over.leave);
    const Lane &here = network_.lane(sidewalk), &there = network_.lane(over.across);
    const Vec2 kerb = here.centerline.point_at(over.leave);
    const Vec2 way = there.centerline.point_at(over.enter) - kerb;
    const double begin = length(), gap = way.norm();
    // lanes for who is on the road are those of the sidewalks, half of the way each
    PathStretch half;
    half.speed_limit = std::max(here.speed_limit, 1.0);
    half.room_left = half.room_right = std::numeric_limits<double>::infinity();
    half.lane = sidewalk;
    half.from = begin;
    half.lane_from = over.leave;
    path_.stretches.push_back(half);
    half.lane = over.across;
    half.from = connect_to(kerb + 0.5 * way);
    half.lane_from = over.enter - 0.5 * gap;
    path_.stretches.push_back(half);
    path_.over_road.push_back({begin + 0.5 * here.width, begin + gap - 0.5 * there.width});
  }

  /// Free walking over an area to where the next lane begins: the stretch is closed by the next
  /// along_lane.
  void over_area(LaneId id) {
    PathStretch stretch;
    stretch.lane = id;
    stretch.from = length();
    stretch.speed_limit = 50.0 / 3.6;
    stretch.room_left = stretch.room_right = std::numeric_limits<double>::infinity();
    path_.stretches.push_back(stretch);
  }

  Path finish(const PathRequest& request) {
    path_.line = Polyline(points_);
    while (cut_fold(path_)) {
    }
    path_.arrival = path_.line.length();
    path_.stretches.back().to = path_.arrival;
    bound_walking_areas(network_, kLeastRoom, path_);
    halt_off_the_road(network_, path_);
    compute_speed_profile(request, path_);
    return std::move(path_);
  }

 private:
  double connect_to(const Vec2& point) {
    if (!points_.empty()) points_.push_back(point);
    const double here = length();
    if (!path_.stretches.empty()) path_.stretches.back().to = here;
    return here;
  }
  double length() {
    while (measured_ < points_.size()) {
      if (measured_ > 0) length_ += (points_[measured_] - points_[measured_ - 1]).norm();
      ++measured_;
    }
    return length_;
  }

  const RoadNetwork& network_;
  Path path_;
  std::vector<Vec2> points_;
  std::size_t measured_ = 0;
  double length_ = 0.0;
};

/// How a crossing or sidewalk is walked so that the way from `here` on is shortest: from its nearer
/// end.
bool starts_at_end(const Polyline& line, const Vec2& here, const Vec2& next) {
  const auto& points = line.points();
  return (points.back() - here).norm() + (points.front() - next).norm() <
         (points.front() - here).norm() + (points.back() - next).norm();
}

/// How to get from one sidewalk of a walk to the next.
struct Passage {
  double cost = std::numeric_limits<double>::infinity();  ///< whole way considered [m]
  double leave = 0, enter = 0;  ///< along the sidewalk that is left and the one that is entered [m]
  std::vector<LaneId> lanes;    ///< walking areas and crossings between them
};

/// Shortest way from the place `enter` on sidewalk i on, as far as it is known: to the arrival, or
/// to the junction with the sidewalk after it [m].
double way_onwards(const RoadNetwork& network, const PathRequest& request,
                   const std::vector<LaneId>& sidewalks, std::size_t i, double enter) {
  const Lane& lane = network.lane(sidewalks[i]);
  const double length = lane.centerline.length();
  if (i + 1 == sidewalks.size())
    return request.arrival_position >= 0.0
               ? std::abs(enter - std::min(request.arrival_position, length))
               : 0.0;
  const Edge& edge = network.edge(lane.edge);
  const Edge& after = network.edge(network.lane(sidewalks[i + 1]).edge);
  double way = length;
  if (edge.from == after.from || edge.from == after.to) way = std::min(way, enter);
  if (edge.to == after.from || edge.to == after.to) way = std::min(way, length - enter);
  return way;
}

/// The ends at which sidewalk i is left and the next one entered that together make the shortest
/// way from `from` on. Infinite cost where there is none.
Passage find_passage(const RoadNetwork& network, const PathRequest& request,
                     const std::vector<LaneId>& sidewalks, std::size_t i, double from) {
  const Polyline& line = network.lane(sidewalks[i]).centerline;
  const Polyline& next_line = network.lane(sidewalks[i + 1]).centerline;
  const Edge& edge = network.edge(network.lane(sidewalks[i]).edge);
  const Edge& next_edge = network.edge(network.lane(sidewalks[i + 1]).edge);
  Passage best;
  for (const bool leave_at_end : {true, false})
    for (const bool enter_at_start : {true, false}) {
      const JunctionId junction = leave_at_end ? edge.to : edge.from;
      if (junction != (enter_at_start ? next_edge.from : next_edge.to)) continue;
      Passage passage;
      passage.leave = leave_at_end ? line.length() : 0.0;
      passage.enter = enter_at_start ? 0.0 : next_line.length();
      passage.lanes =
          find_junction_walk(network, sidewalks[i], sidewalks[i + 1], line.point_at(passage.leave),
                             next_line.point_at(passage.enter), passage.cost);
      // the search knows lanes, not ends: check that it stays on this junction
      if (std::any_of(passage.lanes.begin(), passage.lanes.end(),
                      [&](LaneId lane) { return network.lane(lane).junction != junction; }))
        continue;
      passage.cost += std::abs(passage.leave - from) +
                      way_onwards(network, request, sidewalks, i + 1, passage.enter);
      if (passage.cost < best.cost) best = std::move(passage);
    }
  return best;
}

bool crosses_road(const RoadNetwork& network, const std::vector<LaneId>& passage, EdgeId edge) {
  return std::any_of(passage.begin(), passage.end(), [&](LaneId id) {
    const Lane& lane = network.lane(id);
    if (lane.kind != LaneKind::Crossing) return false;
    const auto& crossed = network.edge(lane.edge).crossing_edges;
    return std::find(crossed.begin(), crossed.end(), edge) != crossed.end();
  });
}

/// Where the road beside sidewalk i is crossed between its junctions: because the walk goes on
/// across it, or to save the crossing that `passage`, taken from `from` on, would lead over. The
/// sidewalk across is added to the list after i where it isn't there already. nullopt where that is
/// not possible or saves no crossing.
std::optional<MidBlock> find_shortcut(const RoadNetwork& network, const PathRequest& request,
                                      std::vector<LaneId>& sidewalks, std::size_t i, double from,
                                      const Passage& passage) {
  constexpr double kSoon = 20.0;   // who arrives across and behind crosses within [m]
  constexpr double kDetour = 5.0;  // at most [m]
  const LaneId across = sidewalk_across(network, sidewalks[i]);
  if (across == kNoLane) return std::nullopt;
  const EdgeId edge = network.lane(sidewalks[i]).edge, twin = network.lane(across).edge;
  auto saves = [&](const Passage& other) {
    return crosses_road(network, other.lanes, edge) || crosses_road(network, other.lanes, twin);
  };
  const Polyline& line = network.lane(sidewalks[i]).centerline;
  double to = passage.leave;
  if (sidewalks[i + 1] == across) {
    // nobody walks on beyond where it arrives
    if (i + 2 == sidewalks.size() && request.arrival_position >= 0.0) {
      const Polyline& other = network.lane(across).centerline;
      const double arrival = line.project(other.point_at(request.arrival_position)).along;
      to = to < from ? std::max(to, std::min(arrival, from - kSoon))
                     : std::min(to, std::max(arrival, from + kSoon));
    }
    return find_mid_block(network, sidewalks[i], across, from, to, request.mid_block);
  }
  if (!saves(passage)) return std::nullopt;
  const auto over = find_mid_block(network, sidewalks[i], across, from, to, request.mid_block);
  if (!over) return std::nullopt;
  std::vector<LaneId> longer = sidewalks;
  longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(i) + 1, across);
  const Passage after = find_passage(network, request, longer, i + 1, over->enter);
  const double way = std::abs(over->leave - from) + over->width + after.cost;
  if (saves(after) || way > passage.cost + kDetour) return std::nullopt;
  sidewalks = std::move(longer);
  return over;
}

/// The sidewalks of a walk in order; empty with `why` set where an edge has none.
std::vector<LaneId> sidewalks_of(const RoadNetwork& network, std::span<const EdgeId> route,
                                 std::string& why) {
  std::vector<LaneId> sidewalks;
  for (const EdgeId edge : route) {
    // SUMO lists crossings and walking areas of a walk too where it was routed intermodally; they
    // are found anew here
    if (network.edge(edge).kind != LaneKind::Normal) continue;
    const LaneId lane = walking_lane(network, edge);
    if (lane == kNoLane) {
      why = "edge '" + network.edge(edge).name + "' has no lane for pedestrians";
      return {};
    }
    if (sidewalks.empty() || sidewalks.back() != lane) sidewalks.push_back(lane);
  }
  if (sidewalks.empty()) why = "the walk has no edges";
  return sidewalks;
}

}  // namespace

std::optional<Path> build_walking_path(const RoadNetwork& network, const PathRequest& request,
                                       std::string& why) {
  std::vector<LaneId> sidewalks = sidewalks_of(network, request.route, why);
  if (sidewalks.empty()) return std::nullopt;
  auto line_of = [&](std::size_t i) -> const Polyline& {
    return network.lane(sidewalks[i]).centerline;
  };

  Walk walk(network);
  double from = std::clamp(request.start_along, 0.0, line_of(0).length());
  for (std::size_t i = 0; i + 1 < sidewalks.size(); ++i) {
    const Passage passage = find_passage(network, request, sidewalks, i, from);
    if (passage.cost == std::numeric_limits<double>::infinity()) {
      why = "no way on foot from edge '" + network.edge(network.lane(sidewalks[i]).edge).name +
            "' to edge '" + network.edge(network.lane(sidewalks[i + 1]).edge).name + "'";
      return std::nullopt;
    }
    const auto shortcut = request.mid_block < 0.0
                              ? std::nullopt
                              : find_shortcut(network, request, sidewalks, i, from, passage);
    if (shortcut) {
      walk.over_road(sidewalks[i], from, *shortcut);
      from = shortcut->enter;
      continue;
    }
    walk.along_lane(sidewalks[i], from, passage.leave);
    Vec2 here = line_of(i).point_at(passage.leave);
    for (std::size_t k = 0; k < passage.lanes.size(); ++k) {
      const Lane& lane = network.lane(passage.lanes[k]);
      if (lane.kind == LaneKind::WalkingArea) {
        walk.over_area(passage.lanes[k]);
        continue;
      }
      const Vec2 target = k + 2 < passage.lanes.size()
                              ? middle_of(network.lane(passage.lanes[k + 2]))
                              : line_of(i + 1).point_at(passage.enter);
      const bool backwards = starts_at_end(lane.centerline, here, target);
      const double length = lane.centerline.length();
      walk.along_lane(passage.lanes[k], backwards ? length : 0.0, backwards ? 0.0 : length);
      here = lane.centerline.point_at(backwards ? 0.0 : length);
    }
    from = passage.enter;
  }
  const double length = line_of(sidewalks.size() - 1).length();
  const double to = request.arrival_position >= 0.0 ? std::min(request.arrival_position, length)
                    : from > 0.5 * length           ? 0.0
                                                    : length;
  walk.along_lane(sidewalks.back(), from, to);
  return walk.finish(request);
}

}  // namespace sumogamma
