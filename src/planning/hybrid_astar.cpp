#include "planning/hybrid_astar.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <queue>
#include <unordered_map>

#include "geometry/segment.h"
#include "planning/dubins.h"

namespace sumogamma {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// a grid's way has corners of 45 degrees: at most so much of it is there really
constexpr double kOctile = 0.92;
// how far a start may be off the carriageway beyond what it was [m]
constexpr double kSlack = 1e-6;

double distance_of(const OrientedBox& box, const Wall& wall) {
  const Vec2 from = to_body(wall.from - box.center, box.forward);
  const Vec2 to = to_body(wall.to - box.center, box.forward);
  if (stretch_in_box(from, to, -box.half, box.half)) return -1;
  const Vec2 corners[] = {{box.half.x(), box.half.y()},
                          {-box.half.x(), box.half.y()},
                          {-box.half.x(), -box.half.y()},
                          {box.half.x(), -box.half.y()}};
  double least = kInfinity;
  for (std::size_t i = 0; i < 4; ++i)
    least = std::min(least, distance_of_segments(corners[i], corners[(i + 1) % 4], from, to));
  return least;
}

/// What a space leaves free for one body.
class FreeSpace {
 public:
  FreeSpace(const WheeledShape& shape, const DrivableSpace& space, const AxlePose& start,
            double margin)
      : shape_(shape), space_(space), start_(start.position), margin_(margin) {
    start_over_ = over_edge(start);
    begin_in_margin_ = in_contact(start, margin);
  }

  bool in_contact(const AxlePose& pose, double margin) const {
    const OrientedBox body = body_at(shape_, pose, margin);
    if (overlaps_any(body, space_.bodies)) return true;
    const double reach = body.half.norm();
    return std::any_of(space_.walls.begin(), space_.walls.end(), [&](const Wall& wall) {
      return distance_to_segment(wall.from, wall.to, body.center) < reach &&
             distance_of(body, wall) <= 0;
    });
  }

  bool admits(const AxlePose& pose) const {
    const bool still_near = begin_in_margin_ && (pose.position - start_).norm() < shape_.length;
    return !in_contact(pose, still_near ? 0.0 : margin_) &&
           over_edge(pose) <= std::max(start_over_, 0.0) + kSlack;
  }

  /// By how much the farthest corner is off the carriageway; <= 0 on it [m].
  double over_edge(const AxlePose& pose) const {
    if (space_.lanes == nullptr) return -kInfinity;
    const OrientedBox body = body_at(shape_, pose);
    double over = -kInfinity;
    for (const double x : {-body.half.x(), body.half.x()})
      for (const double y : {-body.half.y(), body.half.y()})
        over = std::max(over, over_edge(body.center + from_body({x, y}, body.forward)));
    return over;
  }

  /// Of a place, likewise.
  double over_edge(const Vec2& place) const {
    const PolylinePosition at = on_lanes(place);
    const PathStretch& stretch = space_.lanes->stretch_at(at.along);
    const Cut cut = space_.lanes->cut_between(at.along, at.along);
    return std::max(at.offset - (stretch.room_left - cut.left),
                    -at.offset - (stretch.room_right - cut.right));
  }

  double off_middle(const Vec2& place) const {
    return space_.lanes == nullptr ? 0.0 : on_lanes(place).distance;
  }

  PolylinePosition on_lanes(const Vec2& place) const {
    return space_.lanes->line.project(place, space_.lanes_from, space_.lanes_to);
  }

  /// Could the body's middle be there at all, however it points?
  bool admits_middle(const Vec2& place) const {
    const double half = shape_.width / 2;
    if (space_.lanes != nullptr && over_edge(place) > -half + std::max(start_over_, 0.0))
      return false;
    const double inner = half * M_SQRT1_2;  // of a square in the circle
    const OrientedBox core{place, Vec2(1, 0), Vec2(inner, inner)};
    if (overlaps_any(core, space_.bodies)) return false;
    return std::none_of(space_.walls.begin(), space_.walls.end(), [&](const Wall& wall) {
      return distance_to_segment(wall.from, wall.to, place) < inner;
    });
  }

 private:
  WheeledShape shape_;
  DrivableSpace space_;
  Vec2 start_;
  double margin_;
  double start_over_ = 0;         ///< as over_edge
  bool begin_in_margin_ = false;  ///< the start is nearer to something than the margin
};

/// Lengths of ways of a point to the goal round what stands, over cells of a grid.
class WaysRound {
 public:
  WaysRound(const FreeSpace& free, const Vec2& start, const Vec2& goal, double cell, double reach)
      : low_(start.cwiseMin(goal) - Vec2(reach, reach)), cell_(cell) {
    const Vec2 size = start.cwiseMax(goal) + Vec2(reach, reach) - low_;
    columns_ = static_cast<int>(std::ceil(size.x() / cell)) + 1;
    lines_ = static_cast<int>(std::ceil(size.y() / cell)) + 1;
    way_.assign(static_cast<std::size_t>(columns_ * lines_), kInfinity);
    spread(free, cell_of(start), cell_of(goal));
  }

  bool holds(const Vec2& place) const {
    const Vec2 at = (place - low_) / cell_;
    return at.x() >= 0 && at.y() >= 0 && at.x() < columns_ && at.y() < lines_;
  }
  /// Infinite where there is no way.
  double from(const Vec2& place) const { return way_[static_cast<std::size_t>(cell_of(place))]; }

 private:
  int cell_of(const Vec2& place) const {
    const Vec2 at = (place - low_) / cell_;
    return static_cast<int>(std::floor(at.y())) * columns_ + static_cast<int>(std::floor(at.x()));
  }
  Vec2 middle_of(int cell) const {
    return low_ + cell_ * Vec2(cell % columns_ + 0.5, cell / columns_ + 0.5);
  }
  void spread(const FreeSpace& free, int start, int goal);

  Vec2 low_;
  double cell_;
  int columns_ = 0, lines_ = 0;
  std::vector<double> way_;
};

/// From the goal; start and goal themselves are taken for free.
void WaysRound::spread(const FreeSpace& free, int start, int goal) {
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<signed char> admitted(way_.size(), -1);
  admitted[static_cast<std::size_t>(start)] = admitted[static_cast<std::size_t>(goal)] = 1;
  way_[static_cast<std::size_t>(goal)] = 0;
  open.push({0, goal});
  while (!open.empty()) {
    const auto [length, cell] = open.top();
    open.pop();
    if (length > way_[static_cast<std::size_t>(cell)]) continue;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = cell % columns_ + dx, y = cell / columns_ + dy;
        if (x < 0 || y < 0 || x >= columns_ || y >= lines_) continue;
        const int next = y * columns_ + x;
        const double there = length + cell_ * (dx != 0 && dy != 0 ? M_SQRT2 : 1.0);
        if (there >= way_[static_cast<std::size_t>(next)]) continue;
        signed char& may = admitted[static_cast<std::size_t>(next)];
        if (may < 0) may = free.admits_middle(middle_of(next)) ? 1 : 0;
        if (may == 0) continue;
        way_[static_cast<std::size_t>(next)] = there;
        open.push({there, next});
      }
  }
}

/// A way of one search: nodes in the order in which they were reached.
class Search {
 public:
  Search(const WheeledShape& shape, const AxlePose& goal, const FreeSpace& free,
         const WaysRound& round, const HybridAStarParameters& parameters)
      : shape_(shape), goal_(goal), free_(free), round_(round), parameters_(parameters) {}

  FoundWay run(const AxlePose& start);

 private:
  struct Node {
    AxlePose pose;
    double cost = 0, steering = 0;
    std::int32_t parent = -1;
    double rolled = 0;     ///< from there, on an arc [m]
    bool by_shot = false;  ///< from there by the Dubins way
  };
  struct Open {
    double total;
    std::int32_t node;
    friend bool operator>(const Open& a, const Open& b) {
      return a.total != b.total ? a.total > b.total : a.node > b.node;
    }
  };

  double heuristic(const AxlePose& pose) const {
    return parameters_.heuristic_weight *
           std::max(dubins_way(pose, goal_, shape_.turning_radius()).length(),
                    kOctile * round_.from(pose.position));
  }
  std::uint64_t key_of(const AxlePose& pose) const;
  double cost_of_way(const Vec2& at, double length, double steering) const {
    const double off = std::max(free_.off_middle(at) - parameters_.off_middle_free, 0.0);
    return length *
           (1 + parameters_.steering_cost * std::abs(steering) + parameters_.off_middle_cost * off);
  }
  bool rolls_free(AxlePose pose, double distance, double curvature) const;
  void push(const Node& node, double ahead) {
    nodes_.push_back(node);
    open_.push({node.cost + ahead, static_cast<std::int32_t>(nodes_.size() - 1)});
  }
  void shoot(std::int32_t from);
  void expand(std::int32_t from);
  void append_way(const Node& node, std::vector<AxlePose>& poses) const;
  FoundWay way_to(std::int32_t last) const;

  WheeledShape shape_;
  AxlePose goal_;
  const FreeSpace& free_;
  const WaysRound& round_;
  HybridAStarParameters parameters_;
  std::vector<Node> nodes_;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open_;
  std::unordered_map<std::uint64_t, double> reached_;  ///< least cost by cell; never iterated
};

std::uint64_t Search::key_of(const AxlePose& pose) const {
  const auto cell = [&](double value) {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>(std::floor(value / parameters_.cell)) + (1 << 23));
  };
  const double turn = wrapped(pose.heading) / (2 * M_PI) + 0.5;
  const auto heading = static_cast<std::uint64_t>(std::floor(turn * parameters_.headings));
  return cell(pose.position.x()) << 40 | cell(pose.position.y()) << 16 | heading;
}

bool Search::rolls_free(AxlePose pose, double distance, double curvature) const {
  const int steps = static_cast<int>(std::ceil(distance / parameters_.spacing - 1e-9));
  for (int i = 0; i < steps; ++i) {
    pose = rolled(pose, distance / steps, curvature);
    if (!free_.admits(pose) || !round_.holds(pose.position)) return false;
  }
  return true;
}

/// The Dubins way to the goal, where nothing is in it, as a node that the search may end with.
void Search::shoot(std::int32_t from) {
  const Node& node = nodes_[static_cast<std::size_t>(from)];
  const DubinsWay way = dubins_way(node.pose, goal_, shape_.turning_radius());
  AxlePose pose = node.pose;
  double cost = node.cost, steering = node.steering;
  for (const DubinsWay::Piece& piece : way.pieces) {
    if (piece.length <= 0) continue;
    if (!rolls_free(pose, piece.length, piece.curvature)) return;
    const double wheels = std::atan(shape_.wheelbase * piece.curvature);
    cost += parameters_.turning_cost * std::abs(wheels - steering);
    for (double left = piece.length; left > 0; left -= parameters_.arc) {
      const double part = std::min(left, parameters_.arc);
      pose = rolled(pose, part, piece.curvature);
      cost += cost_of_way(pose.position, part, wheels);
    }
    steering = wheels;
  }
  push({goal_, cost, steering, from, 0, true}, 0);
}

void Search::expand(std::int32_t from) {
  const Node node = nodes_[static_cast<std::size_t>(from)];
  const bool near = (node.pose.position - goal_.position).norm() < parameters_.near_goal;
  const double arc = near ? parameters_.short_arc : parameters_.arc;
  const int side = parameters_.steering_steps / 2;
  for (int i = -side; i <= side; ++i) {
    Node next;
    next.steering = shape_.max_steering * i / std::max(side, 1);
    const double curvature = std::tan(next.steering) / shape_.wheelbase;
    next.pose = rolled(node.pose, arc, curvature);
    if (!round_.holds(next.pose.position)) continue;
    next.cost = node.cost + cost_of_way(next.pose.position, arc, next.steering) +
                parameters_.turning_cost * std::abs(next.steering - node.steering);
    const std::uint64_t key = key_of(next.pose);
    const auto known = reached_.find(key);
    if (known != reached_.end() && known->second <= next.cost) continue;
    const double ahead = heuristic(next.pose);
    if (ahead == kInfinity || !rolls_free(node.pose, arc, curvature)) continue;
    reached_[key] = next.cost;
    next.parent = from;
    next.rolled = arc;
    push(next, ahead);
  }
}

FoundWay Search::run(const AxlePose& start) {
  FoundWay found;
  Node first;
  first.pose = start;
  reached_[key_of(start)] = 0;
  push(first, heuristic(start));
  while (!open_.empty()) {
    const std::int32_t index = open_.top().node;
    open_.pop();
    const Node& node = nodes_[static_cast<std::size_t>(index)];
    if (node.by_shot) {
      const std::int64_t expansions = found.expansions;
      found = way_to(index);
      found.expansions = expansions;
      return found;
    }
    if (const auto known = reached_.find(key_of(node.pose)); known->second < node.cost) continue;
    if (found.expansions == parameters_.most_expansions) {
      found.result = WaySearch::GivenUp;
      return found;
    }
    const bool near = (node.pose.position - goal_.position).norm() < parameters_.near_goal;
    if (near || found.expansions % parameters_.shot_every == 0) shoot(index);
    ++found.expansions;
    expand(index);
  }
  return found;
}

/// Poses after the node's parent up to the node.
void Search::append_way(const Node& node, std::vector<AxlePose>& poses) const {
  const auto roll = [&](AxlePose& pose, double distance, double curvature) {
    const int steps = static_cast<int>(std::ceil(distance / parameters_.spacing - 1e-9));
    for (int i = 0; i < steps; ++i) {
      pose = rolled(pose, distance / steps, curvature);
      poses.push_back(pose);
    }
  };
  AxlePose pose = nodes_[static_cast<std::size_t>(node.parent)].pose;
  if (!node.by_shot) return roll(pose, node.rolled, std::tan(node.steering) / shape_.wheelbase);
  for (const auto& piece : dubins_way(pose, goal_, shape_.turning_radius()).pieces)
    roll(pose, piece.length, piece.curvature);
}

FoundWay Search::way_to(std::int32_t last) const {
  std::vector<std::int32_t> chain;
  for (std::int32_t node = last; node >= 0; node = nodes_[static_cast<std::size_t>(node)].parent)
    chain.push_back(node);
  std::reverse(chain.begin(), chain.end());
  FoundWay found;
  found.result = WaySearch::Found;
  found.poses.push_back(nodes_.front().pose);
  for (std::size_t i = 1; i < chain.size(); ++i)
    append_way(nodes_[static_cast<std::size_t>(chain[i])], found.poses);
  for (std::size_t i = 1; i < found.poses.size(); ++i)
    found.length += (found.poses[i].position - found.poses[i - 1].position).norm();
  return found;
}

}  // namespace

FoundWay find_way(const WheeledShape& shape, const AxlePose& start, const AxlePose& goal,
                  const DrivableSpace& space, const HybridAStarParameters& parameters) {
  const FreeSpace free(shape, space, start, parameters.margin);
  FoundWay found;
  if (free.in_contact(start, 0)) {
    found.result = WaySearch::StartInContact;
    return found;
  }
  if (!free.admits(goal)) return found;
  const WaysRound round(free, start.position, goal.position, parameters.cell, parameters.reach);
  if (round.from(start.position) == kInfinity) return found;
  return Search(shape, goal, free, round, parameters).run(start);
}

}  // namespace sumogamma
