#include "osm/obstacles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <pugixml.hpp>

#include "base/error.h"
#include "base/units.h"
#include "osm/clipping.h"
#include "osm/lane_clearing.h"

namespace sumogamma::osm {
namespace {

using Ring = std::vector<Vec2>;

constexpr double kLeastWall = 0.5;  // [m]: shorter remains of a cut wall are left out
constexpr double kLeastArea = 1.0;  // [m^2]: smaller remains of a cut building are left out
constexpr std::string_view kWalls[] = {"wall",           "fence",        "hedge",
                                       "retaining_wall", "guard_rail",   "city_wall",
                                       "jersey_barrier", "cable_barrier"};

double leading_number(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool off_street_level(const Tags& tags) {
  return leading_number(tag(tags, "layer")) != 0 || leading_number(tag(tags, "min_level")) > 0 ||
         leading_number(tag(tags, "building:min_level")) > 0 ||
         leading_number(tag(tags, "min_height")) > 2.2 ||
         tag_is(tags, "building", {"roof", "no", "canopy"}) ||
         tag_is(tags, "location", {"underground", "roof", "indoor"}) ||
         tag_is(tags, "tunnel", {"yes"}) ||
         tag_is(tags, "indoor", {"yes", "room", "corridor", "area"});
}

/// Collects polygons and writes them in the end.
class PolygonFile {
 public:
  PolygonFile() : root_(document_.append_child("additional")) {}
  void add(const std::string& id, const char* type, const char* color, bool closed,
           const Ring& points) {
    std::string shape;
    char text[64];
    for (const Vec2& p : points) {
      std::snprintf(text, sizeof text, "%s%.2f,%.2f", shape.empty() ? "" : " ", p.x(), p.y());
      shape += text;
    }
    if (closed) {
      std::snprintf(text, sizeof text, " %.2f,%.2f", points[0].x(), points[0].y());
      shape += text;
    }
    pugi::xml_node poly = root_.append_child("poly");
    poly.append_attribute("id") = id.c_str();
    poly.append_attribute("type") = type;
    poly.append_attribute("color") = color;
    poly.append_attribute("fill") = closed ? "1" : "0";
    poly.append_attribute("layer") = "-1";
    if (!closed) poly.append_attribute("lineWidth") = "0.3";
    poly.append_attribute("shape") = shape.c_str();
  }
  void save(const std::filesystem::path& file) const {
    if (!document_.save_file(file.c_str(), "  "))
      throw Error(file.string(), "cannot be written: is the disk full?");
  }

 private:
  pugi::xml_document document_;
  pugi::xml_node root_;
};

double chain_length(const Ring& chain) {
  double length = 0;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) length += (chain[i + 1] - chain[i]).norm();
  return length;
}

/// The parts of a chain that are off all lanes. `whole` tells whether nothing was cut.
std::vector<Ring> off_lanes(const LaneClearing& clearing, const Ring& chain, bool& whole) {
  std::vector<Ring> parts;
  Ring part = {chain[0]};
  whole = true;
  auto finish = [&] {
    if (chain_length(part) >= kLeastWall) parts.push_back(part);
    part.clear();
  };
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    const Vec2 &a = chain[i], &b = chain[i + 1];
    double at = 0;
    for (const Stretch& cut : clearing.stretches_on_lanes(a, b)) {
      whole = false;
      if (cut.from > at) {
        if (part.empty()) part.push_back(a + at * (b - a));
        part.push_back(a + cut.from * (b - a));
        finish();
      } else {
        finish();
      }
      at = cut.to;
    }
    if (at >= 1) continue;
    if (part.empty()) part.push_back(a + at * (b - a));
    part.push_back(b);
  }
  finish();
  // a ring that was cut begins in the middle of a wall: join its last part to its first
  if (!whole && parts.size() > 1 && parts.front().front() == chain.front() &&
      parts.back().back() == chain.back() && chain.front() == chain.back()) {
    parts.back().insert(parts.back().end(), parts.front().begin() + 1, parts.front().end());
    parts.erase(parts.begin());
  }
  return parts;
}

/// What remains of a polygon (outer ring, then courtyards) off all lanes: polygons of the same
/// form. `whole` tells whether nothing was cut.
std::vector<std::vector<Ring>> cut_out_lanes(const LaneClearing& clearing,
                                             const std::vector<Ring>& rings, bool& whole) {
  Vec2 low = rings[0][0], high = low;
  ClipperLib::Paths building;
  double area_before = 0;
  for (const Ring& ring : rings) {
    const ClipperLib::Path path = to_clipper(ring);
    area_before += (&ring == &rings.front() ? 1.0 : -1.0) * std::abs(ClipperLib::Area(path));
    building.push_back(path);
    for (const Vec2& p : ring) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  std::vector<ClipperLib::Paths> lanes;
  for (const Ring& ring : clearing.polygons_near(low, high)) {
    ClipperLib::Path path = to_clipper(ring);
    if (!ClipperLib::Orientation(path))
      ClipperLib::ReversePath(path);  // filled by winding: all must turn one way
    lanes.push_back({std::move(path)});
  }
  ClipperLib::Clipper clipper;
  clipper.AddPaths(without(std::move(building), lanes), ClipperLib::ptSubject, true);
  ClipperLib::PolyTree tree;
  clipper.Execute(ClipperLib::ctUnion, tree, ClipperLib::pftEvenOdd, ClipperLib::pftNonZero);

  std::vector<std::vector<Ring>> polygons;
  double area_after = 0;
  for (const ClipperLib::PolyNode* node = tree.GetFirst(); node != nullptr;
       node = node->GetNext()) {
    if (node->IsHole()) continue;
    const double area = std::abs(ClipperLib::Area(node->Contour));
    area_after += area;
    std::vector<Ring> polygon = {from_clipper(node->Contour)};
    for (const ClipperLib::PolyNode* hole : node->Childs) {
      area_after -= std::abs(ClipperLib::Area(hole->Contour));
      polygon.push_back(from_clipper(hole->Contour));
    }
    if (area > kLeastArea * kClipperScale * kClipperScale && polygon[0].size() >= 3)
      polygons.push_back(std::move(polygon));
  }
  whole = area_before - area_after < 0.1 * kClipperScale * kClipperScale;
  if (whole) return {rings};
  return polygons;
}

bool turns_left(const Ring& ring) {
  double twice_area = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
    twice_area += ring[j].x() * ring[i].y() - ring[i].x() * ring[j].y();
  return twice_area > 0;
}

/// Outer ring and courtyards as one ring: each courtyard is reached through a slit of no width.
Ring join_courtyards(Ring outer, std::vector<Ring> courtyards) {
  for (Ring& inner : courtyards) {
    // against the outer ring's sense, so that the courtyard is a hole by either fill rule
    if (turns_left(inner) == turns_left(outer)) std::reverse(inner.begin(), inner.end());
    std::size_t from = 0, to = 0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < outer.size(); ++i)
      for (std::size_t j = 0; j < inner.size(); ++j)
        if (const double distance = (outer[i] - inner[j]).squaredNorm(); distance < nearest) {
          nearest = distance;
          from = i;
          to = j;
        }
    std::rotate(inner.begin(), inner.begin() + static_cast<std::ptrdiff_t>(to), inner.end());
    inner.push_back(inner[0]);
    inner.push_back(outer[from]);
    outer.insert(outer.begin() + static_cast<std::ptrdiff_t>(from) + 1, inner.begin(), inner.end());
  }
  return outer;
}

/// One import's obstacles while they are made.
class ObstacleWriter {
 public:
  ObstacleWriter(const OsmMap& map, const GeoProjection& projection, const RoadNetwork& road,
                 const GeoBox& box, IssueLog& log)
      : map_(map), projection_(projection), clearing_(road), box_(box), log_(log) {
    for (const char* name : {"buildings", "buildings_cut", "barriers", "furniture",
                             "left_out_level", "left_out_on_lane"})
      counts_[name] = 0;
  }

  void add_buildings() {
    for (const MapArea& area : map_.areas) {
      if (!area.tags.contains("building")) continue;
      if (off_street_level(area.tags)) {
        ++counts_["left_out_level"];
        continue;
      }
      int index = 0;
      for (const MapArea::Part& part : area.parts) add_building(area, part, index++);
    }
  }

  void add_walls() {
    for (const MapWay& way : map_.ways) {
      if (!tag_is(way.tags, "barrier", kWalls) || way.tags.contains("highway")) continue;
      if (off_street_level(way.tags)) {
        ++counts_["left_out_level"];
        continue;
      }
      std::vector<GeoPoint> places;
      for (const std::int64_t node : way.nodes) places.push_back(map_.nodes.at(node).place);
      if (!reaches_box(places)) continue;
      Ring chain;
      for (const GeoPoint place : places) chain.push_back(projection_.to_plane(place));
      bool whole = true;
      int index = 0;
      for (const Ring& part : off_lanes(clearing_, chain, whole))
        file_.add("barrier_w" + std::to_string(way.id) + "_" + std::to_string(index++), "barrier",
                  "120,90,60", false, part);
      ++counts_[index > 0 ? "barriers" : "left_out_on_lane"];
      if (!whole)
        log_.add(Severity::Note, "barrier_cut", "walls and fences cut where lanes pass",
                 "way/" + std::to_string(way.id));
    }
  }

  void add_furniture() {
    for (const auto& [id, node] : map_.nodes) {
      const double radius = radius_of(node.tags);
      if (radius <= 0 || !box_.contains(node.place)) continue;
      if (off_street_level(node.tags)) {
        ++counts_["left_out_level"];
        continue;
      }
      const Vec2 center = projection_.to_plane(node.place);
      if (clearing_.touches_lane(center, radius)) {
        ++counts_["left_out_on_lane"];
        continue;
      }
      constexpr int kCorners = 8;
      Ring ring;
      for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * kPi * i / kCorners;
        ring.push_back(center + radius * Vec2(std::cos(angle), std::sin(angle)));
      }
      file_.add("furniture_n" + std::to_string(id), "furniture", "60,130,60", true, ring);
      ++counts_["furniture"];
    }
  }

  std::map<std::string, long> save(const std::filesystem::path& file) {
    file_.save(file);
    return counts_;
  }

 private:
  bool reaches_box(const std::vector<GeoPoint>& places) const {
    return std::any_of(places.begin(), places.end(), [&](GeoPoint p) { return box_.contains(p); });
  }

  /// Trunk or post [m]; 0 for a node that is none.
  static double radius_of(const Tags& tags) {
    if (tag_is(tags, "natural", {"tree"})) return 0.3;
    if (tag_is(tags, "barrier", {"bollard"})) return 0.15;
    if (tag_is(tags, "barrier", {"block"})) return 0.4;
    if (tag_is(tags, "highway", {"street_lamp"})) return 0.12;
    return 0;
  }

  void add_building(const MapArea& area, const MapArea::Part& part, int index) {
    if (!reaches_box(part.outer)) return;
    std::vector<Ring> rings;
    auto project = [&](const MapArea::Ring& ring) {
      Ring points;
      for (const GeoPoint place : ring) points.push_back(projection_.to_plane(place));
      return points;
    };
    rings.push_back(project(part.outer));
    for (const MapArea::Ring& inner : part.inner)
      if (inner.size() >= 3) rings.push_back(project(inner));

    std::string id = area.id;
    std::replace(id.begin(), id.end(), '/', '_');
    id += "_" + std::to_string(index);
    bool whole = true;
    int piece = 0;
    for (const std::vector<Ring>& polygon : cut_out_lanes(clearing_, rings, whole))
      file_.add("building_" + id + (piece++ == 0 ? "" : "_" + std::to_string(piece)), "building",
                "179,168,154", true,
                join_courtyards(polygon[0], {polygon.begin() + 1, polygon.end()}));
    ++counts_[piece == 0 ? "left_out_on_lane" : whole ? "buildings" : "buildings_cut"];
    if (!whole)
      log_.add(Severity::Note, "building_cut",
               "buildings over or into lanes: the ground of the lanes was cut out", area.id);
  }

  const OsmMap& map_;
  const GeoProjection& projection_;
  LaneClearing clearing_;
  GeoBox box_;
  IssueLog& log_;
  PolygonFile file_;
  std::map<std::string, long> counts_;
};

}  // namespace

ClearedObstacles clear_lanes(RoadNetwork& road) {
  const LaneClearing clearing(road);
  ClearedObstacles counts;
  std::vector<Obstacle> cleared;
  for (Obstacle& obstacle : road.obstacles) {
    bool whole = true;
    std::vector<Ring> remains;
    if (obstacle.kind == ObstacleKind::Barrier) {
      remains = off_lanes(clearing, obstacle.outline, whole);
    } else {
      for (const std::vector<Ring>& polygon : cut_out_lanes(clearing, {obstacle.outline}, whole))
        remains.push_back(join_courtyards(polygon[0], {polygon.begin() + 1, polygon.end()}));
      if (obstacle.kind == ObstacleKind::Furniture && !whole) remains.clear();
    }
    if (whole) {
      cleared.push_back(std::move(obstacle));
      continue;
    }
    ++(remains.empty() ? counts.left_out : counts.cut);
    for (Ring& ring : remains) cleared.push_back({obstacle.kind, std::move(ring)});
  }
  road.obstacles = std::move(cleared);
  return counts;
}

std::map<std::string, long> write_obstacles(const OsmMap& map, const GeoProjection& projection,
                                            const RoadNetwork& road, const GeoBox& box,
                                            const std::filesystem::path& file, IssueLog& log) {
  ObstacleWriter writer(map, projection, road, box, log);
  writer.add_buildings();
  writer.add_walls();
  writer.add_furniture();
  return writer.save(file);
}

}  // namespace sumogamma::osm
