#include "osm/repairs/road_bodies.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>

namespace sumogamma::osm {
namespace {

constexpr double kSwallowed = 2.0;  // [m] length of a lane that is hardly there
constexpr double kSpacing = 5.0;    // [m] between the points of a line, at most

struct Line {
  std::vector<Vec2> points;
  std::vector<double> heights;
};

Line parse_line(const std::string& text) {
  Line line;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(word.c_str(), "%lf,%lf,%lf", &x, &y, &z) < 2) continue;
    if (!line.points.empty() && (Vec2(x, y) - line.points.back()).norm() < 0.01) continue;
    line.points.emplace_back(x, y);
    line.heights.push_back(z);
  }
  return line;
}

/// The lines along which netconvert lays lanes: an edge's shape, or else from node to node.
std::map<std::string, Line> read_lines(const pugi::xml_node& net) {
  std::map<std::string, std::string> nodes;
  for (const pugi::xml_node junction : net.children("junction")) {
    const char* z = junction.attribute("z").value();
    nodes[junction.attribute("id").value()] = std::string(junction.attribute("x").value()) + "," +
                                              junction.attribute("y").value() + "," +
                                              (*z == '\0' ? "0" : z);
  }
  std::map<std::string, Line> lines;
  for (const pugi::xml_node edge : net.children("edge")) {
    if (edge.attribute("function")) continue;
    std::string shape = edge.attribute("shape").value();
    if (shape.empty())
      shape = nodes[edge.attribute("from").value()] + " " + nodes[edge.attribute("to").value()];
    Line line = parse_line(shape);
    if (line.points.size() >= 2) lines[edge.attribute("id").value()] = std::move(line);
  }
  return lines;
}

bool same_line_reversed(const Line& a, const Line& b) {
  if (a.points.size() != b.points.size()) return false;
  for (std::size_t i = 0; i < a.points.size(); ++i)
    if ((a.points[i] - b.points[b.points.size() - 1 - i]).norm() > 0.1) return false;
  return true;
}

/// The line with points between its own, so that none are farther apart than kSpacing.
void resample(const Line& line, RoadBody& body) {
  body.points = {line.points[0]};
  body.heights = {line.heights[0]};
  body.along = {0.0};
  for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
    const Vec2 step = line.points[i + 1] - line.points[i];
    const int parts = std::max(1, static_cast<int>(std::ceil(step.norm() / kSpacing)));
    for (int k = 1; k <= parts; ++k) {
      const double share = static_cast<double>(k) / parts;
      body.points.push_back(line.points[i] + share * step);
      body.heights.push_back(line.heights[i] + share * (line.heights[i + 1] - line.heights[i]));
      body.along.push_back(body.along.back() + step.norm() / parts);
    }
  }
  const std::size_t n = body.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    Vec2 direction = Vec2::Zero();
    if (i > 0) direction += (body.points[i] - body.points[i - 1]).normalized();
    if (i + 1 < n) direction += (body.points[i + 1] - body.points[i]).normalized();
    if (direction.norm() < 1e-6) direction = (body.points[i] - body.points[i - 1]).normalized();
    body.normals.push_back(left_of(direction.normalized()));
  }
  body.shift.assign(n, 0.0);
}

void add_lanes(const RoadNetwork& road, EdgeId id, const Polyline& line, RoadBody& body) {
  for (const LaneId lane_id : road.edge(id).lanes) {
    const Lane& lane = road.lane(lane_id);
    BodyLane strip;
    strip.lane = lane_id;
    strip.half_width = lane.width / 2;
    strip.use = lane_use(lane);
    const double length = lane.centerline.length();
    strip.from = line.project(lane.centerline.point_at(0)).along;
    strip.to = line.project(lane.centerline.point_at(length)).along;
    if (strip.from > strip.to) std::swap(strip.from, strip.to);
    // a junction swallowed it because of the overlap: once apart, all of it comes back
    if (length < kSwallowed) {
      strip.from = 0;
      strip.to = line.length();
    }
    constexpr int kLooks = 9;
    std::vector<double> offsets;
    for (int k = 1; k <= kLooks; ++k)
      offsets.push_back(line.project(lane.centerline.point_at(length * k / (kLooks + 1))).offset);
    std::sort(offsets.begin(), offsets.end());
    strip.offset = offsets[kLooks / 2];
    body.drives = body.drives || strip.use == LaneUse::Driving;
    body.lanes.push_back(strip);
  }
}

void measure(RoadBody& body) {
  body.from = body.along.back();
  body.to = 0;
  body.reach = 0;
  for (const BodyLane& lane : body.lanes) {
    body.from = std::min(body.from, lane.from);
    body.to = std::max(body.to, lane.to);
    body.reach = std::max(body.reach, std::abs(lane.offset) + lane.half_width);
  }
}

}  // namespace

std::vector<RoadBody> make_road_bodies(const NetworkFile& network) {
  const RoadNetwork& road = network.road;
  const std::map<std::string, Line> lines = read_lines(network.net());
  std::map<std::pair<JunctionId, JunctionId>, std::vector<EdgeId>> by_ends;
  for (std::size_t i = 0; i < road.edges.size(); ++i)
    if (road.edges[i].kind == LaneKind::Normal)
      by_ends[{road.edges[i].from, road.edges[i].to}].push_back(static_cast<EdgeId>(i));
  std::vector<bool> done(road.edges.size(), false);
  std::vector<RoadBody> bodies;
  for (std::size_t i = 0; i < road.edges.size(); ++i) {
    const Edge& edge = road.edges[i];
    const auto line = lines.find(edge.name);
    if (done[i] || edge.kind != LaneKind::Normal || line == lines.end()) continue;
    RoadBody body;
    body.edge = static_cast<EdgeId>(i);
    const auto back = by_ends.find({edge.to, edge.from});
    if (back != by_ends.end())
      for (const EdgeId other : back->second) {
        const auto other_line = lines.find(road.edge(other).name);
        if (body.twin != kNoEdge || done[index_of(other)] || other == body.edge ||
            other_line == lines.end() || !same_line_reversed(line->second, other_line->second))
          continue;
        body.twin = other;
        done[index_of(other)] = true;
      }
    resample(line->second, body);
    const Polyline middle(line->second.points);
    add_lanes(road, body.edge, middle, body);
    if (body.twin != kNoEdge) add_lanes(road, body.twin, middle, body);
    measure(body);
    bodies.push_back(std::move(body));
  }
  return bodies;
}

std::vector<BodyLink> make_body_links(const RoadNetwork& road,
                                      const std::vector<RoadBody>& bodies) {
  struct Owner {
    std::size_t body = 0;
    bool reversed = false;
  };
  std::map<EdgeId, Owner> owners;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    owners[bodies[i].edge] = {i, false};
    if (bodies[i].twin != kNoEdge) owners[bodies[i].twin] = {i, true};
  }
  std::map<std::pair<EdgeId, EdgeId>, double> straight;
  for (const Connection& connection : road.connections) {
    const Lane &from = road.lane(connection.from), &to = road.lane(connection.to);
    if (connection.direction != TurnDirection::Straight || from.kind != LaneKind::Normal ||
        to.kind != LaneKind::Normal || lane_use(from) != LaneUse::Driving)
      continue;
    const double distance =
        (from.centerline.points().back() - to.centerline.points().front()).norm();
    const auto [entry, added] = straight.insert({{from.edge, to.edge}, distance});
    if (!added) entry->second = std::min(entry->second, distance);
  }
  std::vector<BodyLink> links;
  for (const auto& [edges, distance] : straight) {
    const auto from = owners.find(edges.first), to = owners.find(edges.second);
    if (from == owners.end() || to == owners.end() || from->second.body == to->second.body)
      continue;
    const auto end_of = [&](const Owner& owner, bool end) {
      return end != owner.reversed ? bodies[owner.body].points.size() - 1 : std::size_t{0};
    };
    links.push_back({from->second.body, to->second.body, end_of(from->second, true),
                     end_of(to->second, false), distance,
                     from->second.reversed == to->second.reversed ? 1.0 : -1.0});
  }
  return links;
}

void fade_out(const std::vector<double>& along, double slope, std::vector<double>& moves) {
  for (std::size_t i = 1; i < moves.size(); ++i)
    moves[i] = std::max(moves[i], moves[i - 1] - slope * (along[i] - along[i - 1]));
  for (std::size_t i = moves.size() - 1; i-- > 0;)
    moves[i] = std::max(moves[i], moves[i + 1] - slope * (along[i + 1] - along[i]));
}

void lay_lanes_again(const RoadNetwork& road, EdgeId edge, const std::vector<double>& old_widths,
                     RoadBody& body) {
  std::vector<std::size_t> order;
  double low = std::numeric_limits<double>::infinity(), high = -low, total = 0;
  for (std::size_t i = 0; i < body.lanes.size(); ++i) {
    const BodyLane& lane = body.lanes[i];
    if (road.lane(lane.lane).edge != edge) continue;
    order.push_back(i);
    low = std::min(low, lane.offset - old_widths[i] / 2);
    high = std::max(high, lane.offset + old_widths[i] / 2);
    total += 2 * lane.half_width;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return body.lanes[a].offset < body.lanes[b].offset;
  });
  constexpr double kAtLine = 0.3;  // [m]
  double at = std::abs(low) < kAtLine    ? low
              : std::abs(high) < kAtLine ? high - total
                                         : (low + high - total) / 2;
  for (const std::size_t i : order) {
    body.lanes[i].offset = at + body.lanes[i].half_width;
    at += 2 * body.lanes[i].half_width;
  }
  measure(body);
}

}  // namespace sumogamma::osm
