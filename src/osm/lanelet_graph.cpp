#include "osm/lanelet_graph.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>

#include "base/units.h"

namespace sumogamma::osm {

namespace {

constexpr double kMeets = 2.0;         // of ends of lanelets that share no nodes [m]
constexpr double kOneWay = 45.0;       // of their directions [degrees]
constexpr double kHeading = 5.0;       // a lane goes straight on as its last metres do [m]
constexpr double kBefore = 3.0;        // of what it would cross, it ends [m]
constexpr double kLeastBeyond = 10.0;  // a way over a junction has a lane behind it [m]
constexpr double kInMiddle = 4.0;      // from the ends of a lanelet that is cut [m]
constexpr double kOnLane = 0.5;        // of its width: so near its centre line another joins it
constexpr double kBeside = 5.0;        // a lane that tells how its neighbour goes on [m]
constexpr double kParallel = 20.0;     // likewise [degrees]
constexpr double kOver = 0.65;         // of half their widths: nearer to it one lies over another
constexpr double kApart = 1.0;         // from there to where it is a lane of its own [m]
constexpr double kLeastFree = 4.0;     // a shorter lane isn't worth it [m]
constexpr double kLeastBefore = 25.0;  // nor before a merge, where a stop line may stand [m]
constexpr double kPiece = 2.0;         // of a line that follows another [m]

bool alike(const Vec2& a, const Vec2& b, double most) {
  return std::abs(wrap_angle(heading_of(a) - heading_of(b))) < radians(most);
}

Vec2 start_of(const Lanelet& one) { return one.center.points().front(); }
Vec2 end_of(const Lanelet& one) { return one.center.points().back(); }

bool cross_each_other(const Polyline& a, const Polyline& b) {
  for (std::size_t k = 0; k + 1 < a.points().size(); ++k)
    for (std::size_t m = 0; m + 1 < b.points().size(); ++m) {
      const Vec2 &p = a.points()[k], &q = b.points()[m];
      const auto shares = crossing_shares(p, a.points()[k + 1] - p, q, b.points()[m + 1] - q);
      if (shares && shares->minCoeff() >= 0.0 && shares->maxCoeff() <= 1.0) return true;
    }
  return false;
}

/// The part of a line from one place to another.
Polyline part_of(const Polyline& line, double from, double to) {
  std::vector<Vec2> points{line.point_at(from)};
  for (std::size_t k = 0; k < line.points().size(); ++k)
    if (line.along_of_vertex(k) > from && line.along_of_vertex(k) < to)
      points.push_back(line.points()[k]);
  points.push_back(line.point_at(to));
  return Polyline(points);
}

class Maker {
 public:
  Maker(const LaneletMap& map, double beyond) : beyond_(beyond) {
    for (const Lanelet& one : map.lanelets)
      if (one.use != LaneletUse::Foot) lanelets().push_back(one);
  }

  LaneletGraph make() {
    link();
    cut_where_others_join();
    link();
    find_junctions();
    while (join_rows() || cut_free_parts()) {
      link();
      find_junctions();
    }
    find_beside_junctions();
    prolong();
    return std::move(graph_);
  }

 private:
  std::vector<Lanelet>& lanelets() { return graph_.lanelets; }

  void add_link(std::size_t a, std::size_t b) {
    graph_.next[a].push_back(b);
    graph_.before[b].push_back(a);
  }

  void link() {
    const std::size_t count = lanelets().size();
    graph_.next.assign(count, {});
    graph_.before.assign(count, {});
    const auto each = [&](const auto& follows) {
      std::vector<std::pair<std::size_t, std::size_t>> found;
      for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
          if (a != b && follows(lanelets()[a], lanelets()[b], a, b)) found.emplace_back(a, b);
      for (const auto& [a, b] : found) add_link(a, b);
    };
    each([](const Lanelet& from, const Lanelet& to, std::size_t, std::size_t) {
      return from.left.back() == to.left.front() && from.right.back() == to.right.front();
    });
    const auto next = graph_.next, before = graph_.before;
    each([&](const Lanelet& from, const Lanelet& to, std::size_t a, std::size_t b) {
      return (next[a].empty() || before[b].empty()) && !is_linked(a, b) &&
             (end_of(from) - start_of(to)).norm() < kMeets &&
             alike(from.center.direction_at(from.center.length()), to.center.direction_at(0.0),
                   kOneWay);
    });
  }

  bool is_linked(std::size_t a, std::size_t b) const {
    const auto &next = graph_.next[a], &back = graph_.next[b];
    return std::find(next.begin(), next.end(), b) != next.end() ||
           std::find(back.begin(), back.end(), a) != back.end();
  }

  /// A lanelet in whose middle another begins or ends, and where.
  std::optional<std::pair<std::size_t, double>> joined_at(std::size_t k, bool at_end) const {
    const Polyline& own = graph_.lanelets[k].center;
    const Vec2 place = at_end ? own.points().back() : own.points().front();
    const Vec2 direction = own.direction_at(at_end ? own.length() : 0.0);
    for (std::size_t other = 0; other < graph_.lanelets.size(); ++other) {
      const Lanelet& lane = graph_.lanelets[other];
      const PolylinePosition at = lane.center.project(place);
      if (other == k || at.distance > kOnLane * lane.width || at.along < kInMiddle ||
          at.along > lane.center.length() - kInMiddle)
        continue;
      if (alike(lane.center.direction_at(at.along), direction, kOneWay))
        return std::pair(other, at.along);
    }
    return std::nullopt;
  }

  void cut_where_others_join() {
    const std::size_t count = lanelets().size();
    for (std::size_t k = 0; k < count; ++k)
      for (const bool at_end : {true, false}) {
        if (!(at_end ? graph_.next : graph_.before)[k].empty()) continue;
        const auto joined = joined_at(k, at_end);
        if (!joined) continue;
        const auto [other, along] = *joined;
        const Vec2 place = graph_.lanelets[other].center.point_at(along);
        const std::size_t piece = cut_row(other, place, at_end);
        // the one that joins is bound to the piece by its nodes
        Lanelet &own = lanelets()[k], &lane = lanelets()[piece];
        (at_end ? own.left.back() : own.left.front()) =
            at_end ? lane.left.front() : lane.left.back();
        (at_end ? own.right.back() : own.right.front()) =
            at_end ? lane.right.front() : lane.right.back();
        std::vector<Vec2> points = own.center.points();
        points.insert(at_end ? points.end() : points.begin(), place);
        own.center = Polyline(points);
      }
  }

  /// A lanelet and those between common borders with it, in order of their numbers.
  std::vector<std::size_t> row_of(std::size_t lanelet) const {
    const std::vector<Lanelet>& all = graph_.lanelets;
    std::vector<std::size_t> row{lanelet};
    for (std::size_t k = 0; k < row.size(); ++k)
      for (std::size_t other = 0; other < all.size(); ++other) {
        const bool beside =
            all[other].left == all[row[k]].right || all[other].right == all[row[k]].left;
        if (beside && std::find(row.begin(), row.end(), other) == row.end()) row.push_back(other);
      }
    std::sort(row.begin(), row.end());
    return row;
  }

  /// The row that goes on where a row ends, lane by lane; empty where there is none.
  std::vector<std::size_t> row_behind(const std::vector<std::size_t>& row) const {
    std::vector<std::size_t> behind;
    for (const std::size_t k : row) {
      if (graph_.on_junction[k] || graph_.next[k].size() != 1) return {};
      const std::size_t next = graph_.next[k].front();
      if (graph_.on_junction[next] || graph_.before[next].size() != 1) return {};
      behind.push_back(next);
    }
    std::vector<std::size_t> sorted = behind;
    std::sort(sorted.begin(), sorted.end());
    return sorted == row_of(behind.front()) ? behind : std::vector<std::size_t>{};
  }

  /// Makes one of two rows of which the second goes on where the first ends. False: there are none.
  bool join_rows() {
    for (std::size_t k = 0; k < lanelets().size(); ++k) {
      const std::vector<std::size_t> row = row_of(k), behind = row_behind(row);
      if (behind.empty() || behind.front() == k) continue;
      for (std::size_t lane = 0; lane < row.size(); ++lane) {
        Lanelet& first = lanelets()[row[lane]];
        const Lanelet& second = lanelets()[behind[lane]];
        std::vector<Vec2> points = first.center.points();
        points.insert(points.end(), second.center.points().begin(), second.center.points().end());
        first.center = Polyline(points);
        first.left.insert(first.left.end(), second.left.begin() + 1, second.left.end());
        first.right.insert(first.right.end(), second.right.begin() + 1, second.right.end());
        first.signalled = first.signalled || second.signalled;
        if (second.rule != LaneletRule::None) first.rule = second.rule;
        if (second.center.length() > 0.5 * first.center.length()) first.speed = second.speed;
      }
      std::vector<Lanelet> rest;
      for (std::size_t other = 0; other < lanelets().size(); ++other)
        if (std::find(behind.begin(), behind.end(), other) == behind.end())
          rest.push_back(std::move(lanelets()[other]));
      lanelets() = std::move(rest);
      return true;
    }
    return false;
  }

  /// Cuts a lanelet and the lanes beside it. Returns its piece behind the place, or before it.
  std::size_t cut_row(std::size_t lanelet, const Vec2& place, bool behind) {
    std::map<std::vector<std::int64_t>, std::int64_t> cuts;  // by border
    const auto node_of = [&](const std::vector<std::int64_t>& border) {
      return cuts
          .try_emplace(border, std::numeric_limits<std::int64_t>::max() - made_nodes_ -
                                   static_cast<std::int64_t>(cuts.size()))
          .first->second;
    };
    std::size_t result = lanelet;
    for (const std::size_t k : row_of(lanelet)) {
      Lanelet first = lanelets()[k], second = first;
      const double length = first.center.length();
      const double along = std::clamp(first.center.project(place).along, 0.1, length - 0.1);
      const std::int64_t left = node_of(first.left), right = node_of(first.right);
      first.center = part_of(first.center, 0.0, along);
      second.center = part_of(second.center, along, length);
      second.left = {left, first.left.back()};
      second.right = {right, first.right.back()};
      // stop lines are where lanelets end
      first.signalled = false;
      first.left = {first.left.front(), left};
      first.right = {first.right.front(), right};
      if (k == lanelet && behind) result = lanelets().size();
      lanelets()[k] = std::move(first);
      lanelets().push_back(std::move(second));
      ++graph_.cut;
    }
    made_nodes_ += static_cast<std::int64_t>(cuts.size());
    return result;
  }

  /// Who lies on a junction, and with whom.
  void find_junctions() {
    const std::size_t count = lanelets().size();
    graph_.meetings.clear();
    graph_.on_junction.assign(count, false);
    const auto meet = [&](std::size_t a, std::size_t b) {
      graph_.on_junction[a] = graph_.on_junction[b] = true;
      graph_.meetings.emplace_back(a, b);
    };
    for (const auto* ways : {&graph_.next, &graph_.before})
      for (const std::vector<std::size_t>& several : *ways)
        for (std::size_t k = 1; k < several.size(); ++k) meet(several[0], several[k]);
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b)
        if (!is_linked(a, b) && cross_each_other(lanelets()[a].center, lanelets()[b].center))
          meet(a, b);
  }

  /// Is a node one of a cut?
  bool is_made(std::int64_t node) const {
    return node > std::numeric_limits<std::int64_t>::max() - made_nodes_ - 1;
  }

  bool is_among(const std::vector<std::size_t>& all, std::size_t one) const {
    return std::find(all.begin(), all.end(), one) != all.end();
  }

  /// Where a lanelet lies over others: up to where over those that begin with it, from where over
  /// those that end with it [m] or that it meets in its second half. Nothing where it meets others
  /// before, or begins with nobody.
  std::optional<std::pair<double, double>> overlaps(std::size_t k) const {
    const Lanelet& own = graph_.lanelets[k];
    const std::vector<std::size_t> row = row_of(k);
    double begins_with = 0.0, ends_with = own.center.length();
    bool others = false;
    for (std::size_t other = 0; other < graph_.lanelets.size(); ++other) {
      if (!graph_.on_junction[other] || is_linked(k, other) || is_among(row, other)) continue;
      const Lanelet& lane = graph_.lanelets[other];
      const bool begins = (start_of(own) - start_of(lane)).norm() < kMeets,
                 ends = (end_of(own) - end_of(lane)).norm() < kMeets;
      const double reach = kOver * 0.5 * (own.width + lane.width);
      for (double along = 0.0; along <= own.center.length(); along += 1.0) {
        if (lane.center.project(own.center.point_at(along)).distance > reach) continue;
        others = others || (!begins && !ends);
        if (!begins && !ends && along < 0.5 * own.center.length()) return std::nullopt;
        const bool first = begins && (!ends || along < 0.5 * own.center.length());
        if (first) begins_with = std::max(begins_with, along);
        if (!first) ends_with = std::min(ends_with, along);
      }
    }
    if (others && begins_with <= 0.0 && !is_made(own.left.front())) return std::nullopt;
    return std::pair(begins_with, ends_with);
  }

  /// Cuts off, with the lanes beside it, what of a lanelet on a junction lies over no other: where
  /// lanes part or come together they are lanes before and behind. False: there is nothing.
  bool cut_free_parts() {
    for (std::size_t k = 0; k < lanelets().size(); ++k) {
      if (!graph_.on_junction[k]) continue;
      const auto over = overlaps(k);
      if (!over) continue;
      const double length = lanelets()[k].center.length();
      const double from = over->first > 0.0 ? over->first + kApart : 0.0,
                   to = over->second < length ? over->second - kApart : length;
      // no stop line stands where a lanelet was cut here
      const bool is_piece = is_made(lanelets()[k].left.front());
      const double least = from > 0.0 || is_piece ? kLeastFree : kLeastBefore;
      if (to - from < least || (from <= 0.0 && to >= length)) continue;
      cut_row(k, lanelets()[k].center.point_at(from > 0.0 ? from : to), true);
      return true;
    }
    return false;
  }

  /// Lanes beside which one lies on a junction: what prolongs them is an edge of its own.
  void find_beside_junctions() {
    beside_junction_ = graph_.on_junction;
    for (bool more = true; more;) {
      more = false;
      for (std::size_t a = 0; a < lanelets().size(); ++a)
        for (std::size_t b = 0; b < lanelets().size(); ++b) {
          if (lanelets()[a].left != lanelets()[b].right) continue;
          if (beside_junction_[a] == beside_junction_[b]) continue;
          beside_junction_[a] = beside_junction_[b] = more = true;
        }
    }
  }

  /// The line of a lane beside a place, as far as it goes on from there, brought over the place;
  /// nothing where there is none.
  std::vector<Vec2> beside(const Vec2& place, const Vec2& onward, bool at_end) const {
    std::vector<Vec2> line;
    double nearest = kBeside;
    for (std::size_t k = 0; k < graph_.lanelets.size(); ++k) {
      const Polyline& other = graph_.lanelets[k].center;
      const PolylinePosition at = other.project(place);
      const double room = at_end ? other.length() - at.along : at.along;
      if (graph_.on_junction[k] || at.distance > nearest || room < kLeastBeyond) continue;
      if (!alike((at_end ? 1.0 : -1.0) * other.direction_at(at.along), onward, kParallel)) continue;
      nearest = at.distance;
      line.clear();
      for (double way = 0; way < room; way += kPiece) {
        const double along = at.along + (at_end ? way : -way);
        line.emplace_back(other.point_at(along) + at.offset * left_of(other.direction_at(along)));
      }
    }
    return line;
  }

  /// Points behind (or before) a lanelet at the map's end, in the direction away from it.
  std::vector<Vec2> onward_from(std::size_t k, bool at_end) const {
    const Polyline& line = graph_.lanelets[k].center;
    const double near = std::min(kHeading, line.length());
    const Vec2 place = at_end ? line.points().back() : line.points().front();
    const Vec2 direction =
        (place - line.point_at(at_end ? line.length() - near : near)).normalized();
    std::vector<Vec2> way = beside(place, direction, at_end);
    if (way.empty()) way = {place, place + std::max(beyond_, kLeastBeyond) * direction};
    way.front() = place;
    const double least = graph_.on_junction[k] ? kLeastBeyond : 0.0;
    const double room = std::max(least, std::min(beyond_, room_along(Polyline(way), k)));
    way = part_of(Polyline(way), 0.0, std::max(room, 1e-3)).points();
    if (room <= 0.0) way.clear();
    return way;
  }

  /// How far a way leads before it crosses a lanelet that doesn't begin or end with it [m].
  double room_along(const Polyline& way, std::size_t but) const {
    double room = std::numeric_limits<double>::infinity();
    const Vec2 place = way.points().front();
    for (std::size_t k = 0; k < graph_.lanelets.size(); ++k) {
      const Lanelet& other = graph_.lanelets[k];
      if (k == but || (start_of(other) - place).norm() < kMeets ||
          (end_of(other) - place).norm() < kMeets)
        continue;
      const std::vector<Vec2>& line = other.center.points();
      for (std::size_t n = 0; n + 1 < way.points().size(); ++n)
        for (std::size_t m = 0; m + 1 < line.size(); ++m) {
          const Vec2 piece = way.points()[n + 1] - way.points()[n];
          const auto shares =
              crossing_shares(way.points()[n], piece, line[m], line[m + 1] - line[m]);
          if (shares && shares->minCoeff() >= 0.0 && shares->maxCoeff() <= 1.0)
            room = std::min(room, way.along_of_vertex(n) + shares->x() * piece.norm() - kBefore);
        }
    }
    return room;
  }

  /// Lanes at the map's end go on: first those beside which others may go.
  void prolong() {
    const std::size_t count = lanelets().size();
    for (const bool own : {true, false})
      for (const bool at_end : {true, false})
        for (std::size_t k = 0; k < count; ++k) {
          if (beside_junction_[k] == own || !(at_end ? graph_.next : graph_.before)[k].empty())
            continue;
          const std::vector<Vec2> way = onward_from(k, at_end);
          if (way.size() < 2) continue;
          ++graph_.prolonged;
          if (own)
            set_prolonged(k, at_end, way);
          else if (!link_beyond(k, at_end, way.front(), count))
            append_beyond(k, at_end, way);
        }
  }

  void set_prolonged(std::size_t k, bool at_end, const std::vector<Vec2>& way) {
    std::vector<Vec2> points = lanelets()[k].center.points();
    if (at_end)
      points.insert(points.end(), way.begin(), way.end());
    else
      points.insert(points.begin(), way.rbegin(), way.rend());
    lanelets()[k].center = Polyline(points);
  }

  /// Leads to, or from, a lane that was appended for another lanelet with this end.
  bool link_beyond(std::size_t k, bool at_end, const Vec2& place, std::size_t first) {
    for (std::size_t other = first; other < lanelets().size(); ++other) {
      const Vec2 end = at_end ? start_of(lanelets()[other]) : end_of(lanelets()[other]);
      if ((end - place).norm() > kMeets || !(at_end ? graph_.next : graph_.before)[other].empty())
        continue;
      const std::size_t before = at_end ? k : other, behind = at_end ? other : k;
      for (const std::size_t sibling : at_end ? graph_.before[other] : graph_.next[other]) {
        graph_.on_junction[k] = graph_.on_junction[sibling] = true;
        graph_.meetings.emplace_back(k, sibling);
      }
      add_link(before, behind);
      return true;
    }
    return false;
  }

  /// A lane of its own behind, or before, a lanelet.
  void append_beyond(std::size_t k, bool at_end, const std::vector<Vec2>& way) {
    Lanelet lane = lanelets()[k];
    const auto border = [&](const std::vector<std::int64_t>& nodes) {
      const std::int64_t node = at_end ? nodes.back() : nodes.front();
      const auto known =
          far_nodes_.try_emplace({node, at_end}, std::numeric_limits<std::int64_t>::min() +
                                                     static_cast<std::int64_t>(far_nodes_.size()));
      const std::int64_t far = known.first->second;
      return at_end ? std::vector<std::int64_t>{node, far} : std::vector<std::int64_t>{far, node};
    };
    lane.left = border(lanelets()[k].left);
    lane.right = border(lanelets()[k].right);
    lane.center = Polyline(at_end ? way : std::vector<Vec2>(way.rbegin(), way.rend()));
    const std::size_t added = lanelets().size();
    lanelets().push_back(std::move(lane));
    graph_.on_junction.push_back(false);
    graph_.next.emplace_back();
    graph_.before.emplace_back();
    add_link(at_end ? k : added, at_end ? added : k);
  }

  double beyond_;
  LaneletGraph graph_;
  std::vector<bool> beside_junction_;
  std::int64_t made_nodes_ = 0;
  std::map<std::pair<std::int64_t, bool>, std::int64_t> far_nodes_;
};

}  // namespace

LaneletGraph lanelet_graph_of(const LaneletMap& map, double beyond) {
  return Maker(map, beyond).make();
}

std::size_t right_of(const LaneletGraph& graph, std::size_t lanelet) {
  for (std::size_t other = 0; other < graph.lanelets.size(); ++other)
    if (other != lanelet && !graph.on_junction[other] &&
        graph.lanelets[other].left == graph.lanelets[lanelet].right)
      return other;
  return lanelet;
}

}  // namespace sumogamma::osm
