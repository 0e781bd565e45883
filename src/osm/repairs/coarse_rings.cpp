#include "osm/repairs/coarse_rings.h"

#include <cmath>
#include <map>
#include <set>

#include "base/units.h"
#include "geometry/vec2.h"
#include "osm/repairs/added_nodes.h"
#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr double kOff = 1.0;             // [m] between chord and arc, from which arcs are drawn
constexpr double kStep = radians(15.0);  // between the points of an arc

using Ring = std::vector<std::int64_t>;  // each node once, in the order in which they are drawn

/// Follows pieces of roundabouts from node to node until they close.
std::vector<Ring> find_rings(const OsmMap& map) {
  std::map<std::int64_t, std::int64_t> next;
  std::set<std::int64_t> forks;
  for (const MapWay& way : map.ways) {
    if (!is_car_way(way) || !tag_is(way.tags, "junction", {"roundabout", "circular"})) continue;
    for (std::size_t i = 0; i + 1 < way.nodes.size(); ++i)
      if (!next.emplace(way.nodes[i], way.nodes[i + 1]).second) forks.insert(way.nodes[i]);
  }
  std::vector<Ring> rings;
  std::set<std::int64_t> seen;
  for (const auto& [start, second] : next) {
    Ring ring;
    std::int64_t node = start;
    while (next.contains(node) && !forks.contains(node) && seen.insert(node).second) {
      ring.push_back(node);
      node = next.at(node);
    }
    if (node == start && ring.size() >= 3) rings.push_back(std::move(ring));
  }
  return rings;
}

/// The angle from a to b, between -pi and pi [rad].
double angle_between(const Vec2& a, const Vec2& b) { return std::atan2(cross(a, b), a.dot(b)); }

void append_arcs(const OsmMap& map, const Ring& ring, std::vector<RingArc>& arcs) {
  const LocalMetric metric(map.nodes.at(ring[0]).place);
  std::vector<Vec2> points;
  Vec2 middle = Vec2::Zero();
  for (const std::int64_t node : ring) {
    const GeoPoint place = map.nodes.at(node).place;
    points.emplace_back(metric.east(place), metric.north(place));
    middle += points.back() / static_cast<double>(ring.size());
  }
  std::vector<RingArc> found;
  double round = 0.0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Vec2 a = points[i] - middle, b = points[(i + 1) % ring.size()] - middle;
    const double angle = angle_between(a, b);
    round += angle;
    if (angle * round <= 0.0) return;
    const double radius = 0.5 * (a.norm() + b.norm());
    if (radius * (1.0 - std::cos(0.5 * angle)) < kOff) continue;
    RingArc arc{ring[i], ring[(i + 1) % ring.size()], {}};
    const double pieces = std::ceil(std::abs(angle) / kStep);
    for (double k = 1; k < pieces; ++k) {
      const double share = k / pieces;
      const Vec2 place = middle + ((1.0 - share) * a.norm() + share * b.norm()) *
                                      direction_of(heading_of(a) + share * angle);
      arc.between.push_back(metric.place(place.x(), place.y()));
    }
    found.push_back(std::move(arc));
  }
  if (std::abs(std::abs(round) - 2.0 * kPi) > 0.1) return;
  arcs.insert(arcs.end(), found.begin(), found.end());
}

}  // namespace

std::vector<RingArc> coarse_ring_arcs(const OsmMap& map) {
  std::vector<RingArc> arcs;
  for (const Ring& ring : find_rings(map)) append_arcs(map, ring, arcs);
  return arcs;
}

void round_coarse_rings(OsmMap& map, IssueLog& log) {
  AddedNodes added;
  for (const RingArc& arc : coarse_ring_arcs(map)) {
    std::vector<std::int64_t>& nodes = added[{arc.from, arc.to}];
    for (const GeoPoint place : arc.between) {
      nodes.push_back(map.new_id());
      map.nodes[nodes.back()].place = place;
    }
    log.add(Severity::Note, "rings_rounded", "roundabouts drawn with few points, made round",
            "node/" + std::to_string(arc.from));
  }
  insert_nodes(added, map);
}

}  // namespace sumogamma::osm
