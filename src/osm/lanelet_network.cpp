#include "osm/lanelet_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/units.h"
#include "osm/lanelet_graph.h"
#include "osm/netconvert.h"
#include "osm/network_file.h"

namespace sumogamma::osm {

namespace {

constexpr double kInside = 0.1;  // of a lane that its junction takes [m]
constexpr std::size_t kMostTurns = 10000;
constexpr int kGoesFirst = 4, kAsUsual = 2, kYields = 1;  // SUMO's priorities of edges

/// Sets that are joined.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  std::size_t of(std::size_t one) {
    while (parent_[one] != one) one = parent_[one] = parent_[parent_[one]];
    return one;
  }
  /// The least member names the set.
  void join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

std::string shape_text(const std::vector<Vec2>& points) {
  std::string text;
  for (const Vec2& point : points)
    text += fmt::format("{}{:.3f},{:.3f}", text.empty() ? "" : " ", point.x(), point.y());
  return text;
}

/// Lanelets while roads are made of them.
class Roads {
 public:
  Roads(const LaneletMap& map, double beyond, std::filesystem::path file)
      : file_(std::move(file)), graph_(lanelet_graph_of(map, beyond)) {}

  PlainNetwork make() {
    plain_.prolonged = graph_.prolonged;
    plain_.cut = graph_.cut;
    join_all_ports();
    make_edges();
    if (edges_.empty())
      throw Error(file_.string(), "is one junction without a lane that leads to it");
    find_turns();
    write();
    return std::move(plain_);
  }

 private:
  struct Edge {
    std::string id;
    std::vector<std::size_t> lanes;  ///< lanelets, from the right
    std::size_t from = 0, to = 0;    ///< ports
    int priority = kAsUsual;
  };
  struct LanePlace {
    std::size_t edge = 0, lane = 0;
  };
  struct Turn {
    LanePlace from, to;
    std::vector<std::size_t> over;  ///< lanelets on the junction; none: the lanes meet
  };

  /// Ends of lanelets that are one place: 2k where k begins, 2k + 1 where it ends.
  void join_ports() {
    ports_ = Groups(2 * lanelets_.size());
    for (std::size_t k = 0; k < lanelets_.size(); ++k) {
      for (const std::size_t b : next_[k]) ports_.join(2 * k + 1, 2 * b);
      if (on_junction_[k]) ports_.join(2 * k, 2 * k + 1);
      if (on_junction_[k] || right_of(graph_, k) == k) continue;
      ports_.join(2 * k, 2 * right_of(graph_, k));
      ports_.join(2 * k + 1, 2 * right_of(graph_, k) + 1);
    }
    for (const auto& [a, b] : graph_.meetings) ports_.join(2 * a, 2 * b);
  }

  /// What begins and ends at one junction lies on it.
  void join_all_ports() {
    for (bool more = true; more;) {
      join_ports();
      more = false;
      for (std::size_t k = 0; k < lanelets_.size(); ++k)
        if (!on_junction_[k] && ports_.of(2 * k) == ports_.of(2 * k + 1))
          graph_.on_junction[k] = more = true;
    }
  }

  int priority_of(std::size_t k) const {
    int priority = kAsUsual;
    std::vector<std::size_t> members = next_[k];
    members.push_back(k);
    for (const std::size_t one : members) {
      if (one != k && !on_junction_[one]) continue;
      const LaneletRule rule = lanelets_[one].rule;
      if (rule == LaneletRule::GoesFirst) priority = kGoesFirst;
      if (rule == LaneletRule::Yields || rule == LaneletRule::Stops) priority = kYields;
    }
    return priority;
  }

  void make_edges() {
    std::vector<bool> has_left(lanelets_.size(), false), taken(lanelets_.size(), false);
    for (std::size_t k = 0; k < lanelets_.size(); ++k)
      if (!on_junction_[k] && right_of(graph_, k) != k) has_left[right_of(graph_, k)] = true;
    places_.resize(lanelets_.size());
    std::set<std::string> ids;
    for (std::size_t k = 0; k < lanelets_.size(); ++k) {
      if (on_junction_[k] || has_left[k] || taken[k]) continue;
      Edge edge;
      for (std::size_t lane = k; !taken[lane]; lane = right_of(graph_, lane)) {
        taken[lane] = true;
        edge.lanes.insert(edge.lanes.begin(), lane);
      }
      edge.from = ports_.of(2 * k);
      edge.to = ports_.of(2 * k + 1);
      edge.id = fmt::format("L{}", std::abs(lanelets_[edge.lanes.front()].id));
      while (!ids.insert(edge.id).second) edge.id += "b";
      for (std::size_t lane = 0; lane < edge.lanes.size(); ++lane) {
        places_[edge.lanes[lane]] = {edges_.size(), lane};
        const int priority = priority_of(edge.lanes[lane]);
        if (priority != kAsUsual) edge.priority = priority;
      }
      edges_.push_back(std::move(edge));
    }
  }

  /// All ways from lane to lane over junctions.
  void find_turns() {
    std::set<std::pair<std::size_t, std::size_t>> known;
    for (const Edge& edge : edges_)
      for (const std::size_t from : edge.lanes) {
        std::vector<std::vector<std::size_t>> ways{{from}};
        while (!ways.empty()) {
          const std::vector<std::size_t> way = std::move(ways.back());
          ways.pop_back();
          for (const std::size_t next : next_[way.back()]) {
            if (std::find(way.begin(), way.end(), next) != way.end()) continue;
            if (on_junction_[next]) {
              ways.push_back(way);
              ways.back().push_back(next);
            } else if (known.emplace(from, next).second) {
              turns_.push_back({places_[from], places_[next], {way.begin() + 1, way.end()}});
            }
          }
          if (ways.size() + turns_.size() > kMostTurns)
            throw Error(file_.string(), "has a junction with more ways than can be told apart");
        }
      }
  }

  static std::string node_id(std::size_t port) { return fmt::format("J{}", port); }

  /// Where a lane meets a junction: its middle and both corners.
  struct LaneEnd {
    Vec2 place, left, right;
  };

  static LaneEnd lane_end(const Lanelet& lane, bool at_end) {
    // netconvert fails where a lane only touches the outline
    const double length = lane.center.length(), inside = std::min(kInside, 0.2 * length);
    const double along = at_end ? length - inside : inside;
    const Vec2 place = lane.center.point_at(along);
    const Vec2 aside = 0.5 * lane.width * left_of(lane.center.direction_at(along));
    return {place, place + aside, place - aside};
  }

  /// Round the ends of all lanes, so that netconvert ends each where its lanelet does.
  static std::vector<Vec2> outline_of(std::vector<LaneEnd> ends, const Vec2& middle) {
    const auto angle = [&](const Vec2& point) { return heading_of(point - middle); };
    std::stable_sort(ends.begin(), ends.end(), [&](const LaneEnd& a, const LaneEnd& b) {
      return angle(a.place) < angle(b.place);
    });
    std::vector<Vec2> outline;
    for (const LaneEnd& end : ends) {
      const bool left_last = wrap_angle(angle(end.left) - angle(end.right)) > 0.0;
      outline.push_back(left_last ? end.right : end.left);
      outline.push_back(left_last ? end.left : end.right);
    }
    return outline;
  }

  /// A node of the network, of what meets there.
  struct Node {
    std::vector<LaneEnd> ends;
    int in = 0;
    bool signalled = false, stops = false, all_stop = false, ruled = false, turns = false;
  };

  std::map<std::size_t, Node> nodes() {
    std::map<std::size_t, Node> nodes;
    for (const Edge& edge : edges_)
      for (const std::size_t lane : edge.lanes) {
        Node &from = nodes[edge.from], &to = nodes[edge.to];
        from.ends.push_back(lane_end(lanelets_[lane], false));
        to.ends.push_back(lane_end(lanelets_[lane], true));
        if (lane == edge.lanes.front()) ++to.in;
        add_rules(lanelets_[lane], to);
      }
    for (std::size_t k = 0; k < lanelets_.size(); ++k) {
      if (!on_junction_[k]) continue;
      add_rules(lanelets_[k], nodes[ports_.of(2 * k)]);
      nodes[ports_.of(2 * k)].turns = true;
    }
    return nodes;
  }

  static void add_rules(const Lanelet& lanelet, Node& node) {
    node.signalled = node.signalled || lanelet.signalled;
    node.stops = node.stops || lanelet.rule == LaneletRule::Stops;
    node.all_stop = node.all_stop || lanelet.rule == LaneletRule::StopsOnAllArms;
    node.ruled = node.ruled || lanelet.signalled || lanelet.rule != LaneletRule::None;
  }

  void write_nodes() {
    plain_.nodes = plain_.nodes_with_outlines = "<nodes>\n";
    for (const auto& [port, node] : nodes()) {
      const char* type = node.signalled  ? "traffic_light"
                         : node.all_stop ? "allway_stop"
                         : node.stops    ? "priority_stop"
                                         : "priority";
      Vec2 place = Vec2::Zero();
      for (const LaneEnd& end : node.ends)
        place += end.place / static_cast<double>(node.ends.size());
      const std::string shape =
          node.turns && node.ends.size() > 2
              ? fmt::format(" shape=\"{}\"", shape_text(outline_of(node.ends, place)))
              : "";
      const std::string begin =
          fmt::format("  <node id=\"{}\" x=\"{:.3f}\" y=\"{:.3f}\" type=\"{}\"", node_id(port),
                      place.x(), place.y(), type);
      plain_.nodes += begin + "/>\n";
      plain_.nodes_with_outlines += begin + shape + "/>\n";
      plain_.junction_count += node.in > 1;
      plain_.without_a_rule += node.in > 1 && !node.ruled;
    }
    plain_.nodes += "</nodes>\n";
    plain_.nodes_with_outlines += "</nodes>\n";
  }

  /// The line halfway between an edge's outer lanes.
  std::vector<Vec2> middle_of(const Edge& edge) const {
    const Polyline &right = lanelets_[edge.lanes.front()].center,
                   &left = lanelets_[edge.lanes.back()].center;
    const std::size_t pieces = std::max(right.points().size(), left.points().size());
    std::vector<Vec2> points;
    for (std::size_t k = 0; k <= pieces; ++k) {
      const double share = static_cast<double>(k) / static_cast<double>(pieces);
      points.emplace_back(
          0.5 * (right.point_at(share * right.length()) + left.point_at(share * left.length())));
    }
    return points;
  }

  void write_edges() {
    plain_.edges = "<edges>\n";
    for (const Edge& edge : edges_) {
      const Lanelet& middle = lanelets_[edge.lanes[edge.lanes.size() / 2]];
      plain_.edges += fmt::format(
          "  <edge id=\"{}\" from=\"{}\" to=\"{}\" numLanes=\"{}\" priority=\"{}\" "
          "spreadType=\"center\" speed=\"{:.2f}\" shape=\"{}\">\n",
          edge.id, node_id(edge.from), node_id(edge.to), edge.lanes.size(), edge.priority,
          middle.speed, shape_text(middle_of(edge)));
      for (std::size_t k = 0; k < edge.lanes.size(); ++k) {
        const Lanelet& lane = lanelets_[edge.lanes[k]];
        plain_.lanes[fmt::format("{}_{}", edge.id, k)] = lane.center.points();
        const std::string classes =
            lane.use == LaneletUse::Bicycle
                ? "allow=\"bicycle\""
                : fmt::format(
                      "disallow=\"pedestrian tram rail rail_urban rail_electric rail_fast "
                      "ship{}\"",
                      lane.bicycles ? "" : " bicycle");
        plain_.edges += fmt::format(
            "    <lane index=\"{}\" speed=\"{:.2f}\" width=\"{:.2f}\" {} shape=\"{}\"/>\n", k,
            lane.speed, lane.width, classes, shape_text(lane.center.points()));
      }
      plain_.edges += "  </edge>\n";
      plain_.lane_count += edge.lanes.size();
    }
    plain_.edges += "</edges>\n";
    plain_.edge_count = edges_.size();
  }

  void write_turns() {
    plain_.connections = "<connections>\n";
    for (const Turn& turn : turns_) {
      std::vector<Vec2> points;
      for (const std::size_t k : turn.over)
        points.insert(points.end(), lanelets_[k].center.points().begin(),
                      lanelets_[k].center.points().end());
      const std::string shape =
          points.empty() ? "" : fmt::format(" shape=\"{}\"", shape_text(Polyline(points).points()));
      plain_.connections += fmt::format(
          "  <connection from=\"{}\" to=\"{}\" fromLane=\"{}\" toLane=\"{}\"{}/>\n",
          edges_[turn.from.edge].id, edges_[turn.to.edge].id, turn.from.lane, turn.to.lane, shape);
    }
    plain_.connections += "</connections>\n";
    plain_.turn_count = turns_.size();
  }

  void write() {
    write_nodes();
    write_edges();
    write_turns();
  }

  std::filesystem::path file_;
  LaneletGraph graph_;
  const std::vector<Lanelet>& lanelets_ = graph_.lanelets;
  const std::vector<std::vector<std::size_t>>& next_ = graph_.next;
  const std::vector<bool>& on_junction_ = graph_.on_junction;
  Groups ports_{0};
  std::vector<Edge> edges_;
  std::vector<LanePlace> places_;  ///< by lanelet
  std::vector<Turn> turns_;
  PlainNetwork plain_;
};

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error(file.string(), "cannot be written: is the disk full?");
}

void set_line(pugi::xml_node lane, const Polyline& line) {
  constexpr double kShortest = 0.1;  // of a lane of SUMO's [m]
  lane.attribute("shape").set_value(shape_text(line.points()).c_str());
  lane.attribute("length").set_value(
      fmt::format("{:.2f}", std::max(kShortest, line.length())).c_str());
}

/// Puts the lanes of a network, and the ways over its junctions, where the lanelets are.
void restore_lanes(const PlainNetwork& plain, const std::filesystem::path& file) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str())) throw Error(file.string(), "can't be read");
  pugi::xml_node net = document.child("net");
  std::map<std::string, pugi::xml_node> lanes;
  for (const pugi::xml_node edge : net.children("edge"))
    for (const pugi::xml_node lane : edge.children("lane"))
      lanes[lane.attribute("id").value()] = lane;
  for (const auto& [id, line] : plain.lanes) {
    const auto lane = lanes.find(id);
    if (lane == lanes.end()) continue;
    set_line(lane->second, Polyline(line));
  }
  std::map<std::string, std::string> onward;  // the second half of a way, by the lane of the first
  for (const pugi::xml_node link : net.children("connection"))
    if (link.attribute("from").value()[0] == ':' && link.attribute("via"))
      onward[fmt::format("{}_{}", link.attribute("from").value(),
                         link.attribute("fromLane").value())] = link.attribute("via").value();
  for (const pugi::xml_node link : net.children("connection")) {
    const auto via = lanes.find(link.attribute("via").value());
    if (link.attribute("from").value()[0] == ':' || via == lanes.end()) continue;
    const std::string from = fmt::format("{}_{}", link.attribute("from").value(),
                                         link.attribute("fromLane").value()),
                      to = fmt::format("{}_{}", link.attribute("to").value(),
                                       link.attribute("toLane").value());
    if (!plain.lanes.contains(from) || !plain.lanes.contains(to)) continue;
    const std::vector<Vec2>&before = plain.lanes.at(from), &behind = plain.lanes.at(to);
    std::vector<Vec2> points{before.back()};
    for (const Vec2& point : shape_of(link)) points.push_back(point);
    points.push_back(behind.front());
    const Polyline whole(points);
    const auto second = onward.find(via->first);
    if (second == onward.end()) {
      set_line(via->second, whole);
      continue;
    }
    // netconvert's first half begins where it had the lane end
    const Polyline first(shape_of(via->second));
    const double half = whole.project(first.points().back()).along;
    const double cut = std::clamp(half, 0.5, std::max(0.5, whole.length() - 0.5));
    std::vector<Vec2> one{whole.point_at(0.0)}, other{whole.point_at(cut)};
    for (std::size_t k = 0; k < whole.points().size(); ++k)
      (whole.along_of_vertex(k) < cut ? one : other).push_back(whole.points()[k]);
    one.push_back(whole.point_at(cut));
    set_line(via->second, Polyline(one));
    set_line(lanes.at(second->second), Polyline(other));
  }
  save_xml(document, file);
}

}  // namespace

PlainNetwork plain_network_of(const LaneletMap& map, double beyond,
                              const std::filesystem::path& file) {
  return Roads(map, beyond, file).make();
}

void write_lanelet_network(const PlainNetwork& plain, const std::filesystem::path& folder,
                           const std::string& name) {
  write_text(folder / (name + ".edg.xml"), plain.edges);
  write_text(folder / (name + ".con.xml"), plain.connections);
  NetconvertRequest request;
  request.folder = folder;
  request.network = name + ".net.xml";
  const auto convert = [&](const std::string& nodes) {
    write_text(folder / (name + ".nod.xml"), nodes);
    run_netconvert_on_plain(request, name);
  };
  try {
    convert(plain.nodes);
  } catch (const Error&) {
    // netconvert 1.15 asserts where it finds no outline of some junctions
    convert(plain.nodes_with_outlines);
  }
  restore_lanes(plain, folder / request.network);
}

}  // namespace sumogamma::osm
