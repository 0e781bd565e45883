#include "osm/repairs/walking_ground.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

#include "geometry/box_grid.h"
#include "geometry/segment.h"
#include "osm/clipping.h"
#include "osm/lane_clearing.h"
#include "osm/lane_overlap.h"
#include "road/conflict_zones.h"
#include "road/lane_locator.h"

namespace sumogamma::osm {
namespace {

constexpr double kBeside = 10.0;      // [m] of the lanes before and behind a junction
constexpr double kRoundness = 0.05;   // [m] that the ends of a strip may be off a circle
constexpr double kSliver = 0.1;       // [m] half the width of what is no ground to walk on
constexpr double kAtEnd = 0.3;        // [m] from an outline that a lane's end may lie
constexpr double kWorthIt = 0.02;     // [m^2] of a walking area
constexpr double kOtherStorey = 2.5;  // [m]
constexpr double kRounding = 0.005;   // [m] that Clipper's whole numbers may be off
constexpr double kCell = 20.0;        // [m]

struct Turner {
  VehicleClassMask vehicle_class;
  Cornering cornering;
  double half_width;  ///< [m] that it needs to either side of its middle
};
constexpr Turner kTurners[] = {{vehicle_class::kMotorcycle, {1.84}, 0.6},
                               {vehicle_class::kPassenger, {3.8}, 1.2},
                               {vehicle_class::kDelivery, {4.4}, 1.2},
                               {vehicle_class::kTruck, {4.4, 7.5, 2.4}, 0.6},
                               {vehicle_class::kBus, {6.6, 12.0, 2.5}, 0.6}};

ClipperLib::Paths grown(const ClipperLib::Paths& polygons, double margin) {
  ClipperLib::ClipperOffset offset(2.0, kRoundness * kClipperScale);
  offset.AddPaths(polygons, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
  ClipperLib::Paths result;
  offset.Execute(result, margin * kClipperScale);
  return result;
}

/// A box [m].
struct Box {
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;

  void extend(const Vec2& point) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Box box_about(const ClipperLib::Paths& paths) {
  Box box;
  for (const ClipperLib::Path& path : paths)
    for (const Vec2& point : from_clipper(path)) box.extend(point);
  return box;
}

using Rings = std::vector<std::vector<Vec2>>;

Rings rings_of(const ClipperLib::Paths& paths) {
  Rings rings;
  for (const ClipperLib::Path& path : paths) rings.push_back(from_clipper(path));
  return rings;
}

/// The ground within a distance of a line. Most of it lies on the lanes, near nobody's sidewalk: it
/// is made where it is asked for alone.
class Strip {
 public:
  Strip(const Polyline& line, double height, double half_width, ClipperLib::EndType ends)
      : points_(line.points()), height_(height), half_width_(half_width), ends_(ends) {
    const Vec2 reach = Vec2::Constant(half_width);
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
      Box box;
      for (const Vec2& point : {points_[i], points_[i + 1]}) {
        box.extend(point - reach);
        box.extend(point + reach);
      }
      boxes_.push_back(box);
      whole_.extend(box.low);
      whole_.extend(box.high);
    }
  }

  const Box& box() const { return whole_; }
  bool is_at_height(double height) const { return std::abs(height_ - height) <= kOtherStorey; }

  /// Does its ground come onto what the rings enclose? Holes count as if they were none.
  bool reaches(const Rings& rings) const {
    return std::any_of(rings.begin(), rings.end(), [&](const std::vector<Vec2>& ring) {
      Box about;
      for (const Vec2& point : ring) about.extend(point);
      for (std::size_t i = 0; i < boxes_.size(); ++i)
        if (boxes_[i].meets(about) && piece_reaches(i, ring)) return true;
      return false;
    });
  }

  /// Its ground within a box, and some of it beyond.
  ClipperLib::Paths ground_in(const Box& box) const {
    ClipperLib::ClipperOffset offset(2.0, kRoundness * kClipperScale);
    for (std::size_t first = 0; first < boxes_.size();) {
      std::size_t last = first;
      while (last < boxes_.size() && boxes_[last].meets(box)) ++last;
      if (last > first)
        offset.AddPath(to_clipper({points_.begin() + static_cast<std::ptrdiff_t>(first),
                                   points_.begin() + static_cast<std::ptrdiff_t>(last) + 1}),
                       ClipperLib::jtRound, ends_);
      first = last + 1;
    }
    ClipperLib::Paths ground;
    offset.Execute(ground, half_width_ * kClipperScale);
    return ground;
  }

 private:
  bool piece_reaches(std::size_t piece, const std::vector<Vec2>& ring) const {
    const Vec2 &a = points_[piece], &b = points_[piece + 1];
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
      if (distance_of_segments(a, b, ring[j], ring[i]) <= half_width_ + kRounding) return true;
    return ring_contains(ring, a);
  }

  std::vector<Vec2> points_;
  double height_, half_width_;  // [m]
  ClipperLib::EndType ends_;
  Box whole_;               // about it
  std::vector<Box> boxes_;  // about each piece of the line and its ground
};

/// Strips, found by where they are.
class Strips {
 public:
  explicit Strips(std::vector<Strip> strips) : strips_(std::move(strips)), grid_(kCell) {
    for (std::size_t i = 0; i < strips_.size(); ++i)
      grid_.add(static_cast<std::uint32_t>(i), strips_[i].box().low, strips_[i].box().high);
  }

  /// Those whose ground comes onto what the rings enclose, at a height.
  std::vector<const Strip*> onto(const Rings& rings, double height) const {
    Box about;
    for (const std::vector<Vec2>& ring : rings)
      for (const Vec2& point : ring) about.extend(point);
    std::vector<const Strip*> found;
    if (rings.empty()) return found;
    for (const std::uint32_t index : grid_.near(about.low, about.high)) {
      const Strip& strip = strips_[index];
      if (strip.box().meets(about) && strip.is_at_height(height) && strip.reaches(rings))
        found.push_back(&strip);
    }
    return found;
  }

 private:
  std::vector<Strip> strips_;
  BoxGrid grid_;
};

/// Links that follow each other, and how far a way goes on the lane behind the last [m].
struct Chain {
  std::vector<ConnectionId> links;
  double after = 0;
};

/// The chains of links that a vehicle may take from the end of one on: over the junctions that
/// follow where the road between them is too short.
void follow(const RoadNetwork& road, Chain chain, std::vector<Chain>& chains) {
  constexpr std::size_t kMostLinks = 3;
  const Lane& next = road.lane(road.connection(chain.links.back()).to);
  const double length = next.centerline.length();
  bool ends = true;
  if (length < chain.after && chain.links.size() < kMostLinks) {
    for (const ConnectionId on : next.outgoing) {
      if (!is_driven(road, on) || lane_use(road.lane(road.connection(on).to)) != LaneUse::Driving)
        continue;
      Chain longer{chain.links, chain.after - length};
      longer.links.push_back(on);
      follow(road, std::move(longer), chains);
      ends = false;
    }
  }
  if (ends) chains.push_back(std::move(chain));
}

/// Adds what motor vehicles drive over a link and on, corners rounded.
void add_driven(const RoadNetwork& road, ConnectionId id, std::vector<Strip>& strips) {
  const Connection& link = road.connection(id);
  const Lane& from = road.lane(link.from);
  const double height = elevation_at(from, from.centerline.length());
  std::vector<Chain> chains;
  follow(road, {{id}, kBeside}, chains);
  for (const Turner& turner : kTurners) {
    if ((from.allowed & road.lane(link.to).allowed & turner.vehicle_class) == 0) continue;
    Cornering cornering = turner.cornering;
    cornering.keep_left = road.left_hand;
    for (const Chain& chain : chains) {
      const Path way = rounded_way(road, chain.links, kBeside, chain.after, cornering);
      if (!way.line.empty())
        strips.emplace_back(way.line, height, turner.half_width, ClipperLib::etOpenRound);
    }
  }
}

/// What motor vehicles drive over the junctions.
std::vector<Strip> driven_ways(const RoadNetwork& road) {
  std::vector<Strip> strips;
  for (const Junction& junction : road.junctions)
    for (const ConnectionId id : driven_links(road, junction)) add_driven(road, id, strips);
  return strips;
}

/// The lanes of motor vehicles, on junctions and off them.
std::vector<Strip> motor_lanes(const RoadNetwork& road) {
  std::vector<Strip> strips;
  for (const Lane& lane : road.lanes) {
    const bool drives = lane.kind == LaneKind::Normal || lane.kind == LaneKind::Internal;
    if (drives && lane_use(lane) == LaneUse::Driving)
      strips.emplace_back(lane.centerline, elevation_at(lane, 0.0), 0.5 * lane.width,
                          ClipperLib::etOpenButt);
  }
  return strips;
}

/// The straight ways between where people come onto an area and leave it, as wide as the narrower
/// of the two lanes.
std::vector<Strip> walked_ways(const std::vector<WalkingEnd>& ends, double height) {
  std::vector<Strip> strips;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t k = i + 1; k < ends.size(); ++k)
      if (ends[i].place != ends[k].place)
        strips.emplace_back(Polyline({ends[i].place, ends[k].place}), height,
                            0.5 * std::min(ends[i].width, ends[k].width), ClipperLib::etOpenButt);
  return strips;
}

/// The outline, which may cross itself, as polygons that don't.
ClipperLib::Paths outline_of(const Lane& area) {
  ClipperLib::Paths outline;
  ClipperLib::SimplifyPolygon(to_clipper(area.outline), outline, ClipperLib::pftNonZero);
  return outline;
}

/// The polygons without the ground of those of the strips that come onto them.
ClipperLib::Paths without_ground(const ClipperLib::Paths& polygons, const Strips& strips,
                                 double height) {
  const Box box = box_about(polygons);
  std::vector<ClipperLib::Paths> ground;
  for (const Strip* strip : strips.onto(rings_of(polygons), height))
    ground.push_back(strip->ground_in(box));
  return without(polygons, ground);
}

/// What of an area vehicles need beside the lanes. Little of it lies on their ways, so that each
/// step leaves little for the next.
ClipperLib::Paths needed_of(const Lane& area, const std::vector<WalkingEnd>& ends,
                            const Strips& ways, const Strips& lanes) {
  const double height = elevation_at(area, 0.0);
  const ClipperLib::Paths outline = outline_of(area);
  if (ways.onto(rings_of(outline), height).empty()) return {};
  const ClipperLib::Paths beside = without_ground(outline, lanes, height);
  const ClipperLib::Paths untouched = without_ground(beside, ways, height);
  const ClipperLib::Paths needed = without(beside, {untouched});
  if (needed.empty()) return {};
  return without_ground(needed, Strips(walked_ways(ends, height)), height);
}

/// What is left of an area; nothing where it is the same, or falls apart.
std::optional<std::vector<Vec2>> cut(const RoadNetwork& road, const Lane& area, const Strips& ways,
                                     const Strips& lanes) {
  const std::vector<WalkingEnd> ends = walking_ends(road, area);
  const ClipperLib::Paths needed = needed_of(area, ends, ways, lanes);
  if (needed.empty()) return std::nullopt;
  const ClipperLib::Paths outline = outline_of(area);
  ClipperLib::Paths pieces = without(outline, {needed});
  double taken = 0;
  for (const ClipperLib::Path& whole : outline) taken += ClipperLib::Area(whole);
  for (const ClipperLib::Path& piece : pieces) taken -= ClipperLib::Area(piece);
  if (taken < kWorthIt * kClipperScale * kClipperScale) return std::nullopt;
  pieces = grown(grown(pieces, -kSliver), kSliver);
  if (pieces.empty()) return std::nullopt;
  const auto largest = std::max_element(pieces.begin(), pieces.end(),
                                        [](const ClipperLib::Path& a, const ClipperLib::Path& b) {
                                          return ClipperLib::Area(a) < ClipperLib::Area(b);
                                        });
  std::vector<Vec2> left = from_clipper(*largest);
  for (const WalkingEnd& end : ends)
    if (distance_to_area(left, end.place) > distance_to_area(area.outline, end.place) + kAtEnd)
      return std::nullopt;
  return left;
}

/// Height of an area's outline where it is nearest [m].
double height_near(const Lane& area, const Vec2& point) {
  const std::vector<Vec2>& points = area.centerline.points();
  const auto nearest =
      std::min_element(points.begin(), points.end(), [&](const Vec2& a, const Vec2& b) {
        return (a - point).squaredNorm() < (b - point).squaredNorm();
      });
  return area.elevation[static_cast<std::size_t>(nearest - points.begin())];
}

}  // namespace

std::map<std::string, std::vector<Vec2>> walking_areas_off_the_road(const RoadNetwork& road) {
  const Strips ways(driven_ways(road)), lanes(motor_lanes(road));
  std::map<std::string, std::vector<Vec2>> outlines;
  for (const Lane& lane : road.lanes) {
    if (lane.kind != LaneKind::WalkingArea || lane.outline.size() < 3) continue;
    if (auto left = cut(road, lane, ways, lanes)) outlines[lane.name] = std::move(*left);
  }
  return outlines;
}

void set_walking_areas(pugi::xml_node net, const RoadNetwork& road,
                       const std::map<std::string, std::vector<Vec2>>& outlines) {
  for (const pugi::xml_node edge : net.children("edge")) {
    for (pugi::xml_node lane : edge.children("lane")) {
      const auto outline = outlines.find(lane.attribute("id").value());
      if (outline == outlines.end()) continue;
      const Lane& before = road.lane(road.lane_by_name.at(outline->first));
      std::ostringstream shape;
      shape << std::fixed << std::setprecision(2);
      for (const Vec2& point : outline->second) {
        shape << (shape.tellp() > 0 ? " " : "") << point.x() << ',' << point.y();
        if (!before.elevation.empty()) shape << ',' << height_near(before, point);
      }
      lane.attribute("shape") = shape.str().c_str();
    }
  }
}

}  // namespace sumogamma::osm
