#include "osm/walking_ground.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>

#include "osm/clipping.h"
#include "osm/lane_clearing.h"
#include "osm/lane_overlap.h"
#include "osm/network_file.h"
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

/// The ground within a distance of a line, made when it is asked for: most of it lies on the lanes,
/// near nobody's sidewalk.
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

  bool is_near(const Box& box, double height) const {
    return whole_.meets(box) && std::abs(height_ - height) <= kOtherStorey &&
           std::any_of(boxes_.begin(), boxes_.end(),
                       [&](const Box& piece) { return piece.meets(box); });
  }
  const ClipperLib::Paths& ground() const {
    if (!ground_.empty()) return ground_;
    ClipperLib::ClipperOffset offset(2.0, kRoundness * kClipperScale);
    offset.AddPath(to_clipper(points_), ClipperLib::jtRound, ends_);
    offset.Execute(ground_, half_width_ * kClipperScale);
    return ground_;
  }

 private:
  std::vector<Vec2> points_;
  double height_, half_width_;  // [m]
  ClipperLib::EndType ends_;
  Box whole_;               // about it
  std::vector<Box> boxes_;  // about each piece of the line and its ground
  mutable ClipperLib::Paths ground_;
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

/// The ground of those of the strips that come near a box at a height.
std::vector<ClipperLib::Paths> ground_near(const std::vector<Strip>& strips, const Box& box,
                                           double height) {
  std::vector<ClipperLib::Paths> ground;
  for (const Strip& strip : strips)
    if (strip.is_near(box, height)) ground.push_back(strip.ground());
  return ground;
}

/// What of an area vehicles need beside the lanes. Little of it lies on their ways, so that each
/// step leaves little for the next.
ClipperLib::Paths needed_of(const Lane& area, const std::vector<WalkingEnd>& ends,
                            const std::vector<Strip>& ways, const std::vector<Strip>& lanes) {
  const double height = elevation_at(area, 0.0);
  const ClipperLib::Paths outline = outline_of(area);
  if (ground_near(ways, box_about(outline), height).empty()) return {};
  const ClipperLib::Paths beside = without(outline, ground_near(lanes, box_about(outline), height));
  const ClipperLib::Paths untouched = without(beside, ground_near(ways, box_about(beside), height));
  const ClipperLib::Paths needed = without(beside, {untouched});
  if (needed.empty()) return {};
  return without(needed, ground_near(walked_ways(ends, height), box_about(needed), height));
}

/// What is left of an area; nothing where it is the same, or falls apart.
std::optional<std::vector<Vec2>> cut(const RoadNetwork& road, const Lane& area,
                                     const std::vector<Strip>& ways,
                                     const std::vector<Strip>& lanes) {
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
  const std::vector<Strip> ways = driven_ways(road), lanes = motor_lanes(road);
  std::map<std::string, std::vector<Vec2>> outlines;
  for (const Lane& lane : road.lanes) {
    if (lane.kind != LaneKind::WalkingArea || lane.outline.size() < 3) continue;
    if (auto left = cut(road, lane, ways, lanes)) outlines[lane.name] = std::move(*left);
  }
  return outlines;
}

void set_walking_areas(const std::filesystem::path& network, const RoadNetwork& road,
                       const std::map<std::string, std::vector<Vec2>>& outlines) {
  pugi::xml_document document = load_network(network);
  for (const pugi::xml_node edge : document.child("net").children("edge")) {
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
  save_xml(document, network);
}

}  // namespace sumogamma::osm
