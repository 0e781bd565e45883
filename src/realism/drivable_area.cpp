#include "realism/drivable_area.h"

// its own headers still include what it calls deprecated
#define BOOST_ALLOW_DEPRECATED_HEADERS
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <clipper.hpp>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace sumogamma {

namespace {

namespace bg = boost::geometry;
using Point = bg::model::d2::point_xy<double>;
using Segment = bg::model::segment<Point>;

constexpr double kScale = 1000.0;  // Clipper works on whole numbers: millimetres
constexpr double kGap = 0.1;       // half of the widest gap that is none [m]

ClipperLib::Path scaled(const std::vector<Vec2>& points) {
  ClipperLib::Path path;
  for (const Vec2& point : points)
    path.emplace_back(std::llround(kScale * point.x()), std::llround(kScale * point.y()));
  return path;
}

ClipperLib::Paths offset(const ClipperLib::Paths& paths, ClipperLib::EndType ends, double by) {
  ClipperLib::ClipperOffset offset(2.0, 0.01 * kScale);
  offset.AddPaths(paths, ends == ClipperLib::etOpenButt ? ClipperLib::jtRound : ClipperLib::jtMiter,
                  ends);
  ClipperLib::Paths result;
  offset.Execute(result, by * kScale);
  return result;
}

/// The outlines of the area, holes among them.
ClipperLib::Paths outlines_of(const RoadNetwork& network) {
  ClipperLib::Clipper all;
  std::vector<bool> driven(network.junctions.size());
  for (const Lane& lane : network.lanes) {
    const bool drives = lane.kind == LaneKind::Normal || lane.kind == LaneKind::Internal;
    if (!drives || (lane.allowed & vehicle_class::kMotor) == 0 || lane.centerline.empty()) continue;
    all.AddPaths(
        offset({scaled(lane.centerline.points())}, ClipperLib::etOpenButt, 0.5 * lane.width),
        ClipperLib::ptSubject, true);
    if (lane.junction != kNoJunction) driven[index_of(lane.junction)] = true;
  }
  for (std::size_t k = 0; k < network.junctions.size(); ++k) {
    ClipperLib::Path outline = scaled(network.junctions[k].outline);
    if (!driven[k] || outline.size() < 3) continue;
    if (!ClipperLib::Orientation(outline)) ClipperLib::ReversePath(outline);
    all.AddPath(outline, ClipperLib::ptSubject, true);
  }
  ClipperLib::Paths joined;
  all.Execute(ClipperLib::ctUnion, joined, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
  joined = offset(joined, ClipperLib::etClosedPolygon, kGap);
  return offset(joined, ClipperLib::etClosedPolygon, -kGap);
}

Point point_of(const ClipperLib::IntPoint& point) {
  return {static_cast<double>(point.X) / kScale, static_cast<double>(point.Y) / kScale};
}

}  // namespace

struct DrivableArea::Border {
  bg::index::rtree<Segment, bg::index::quadratic<16>> segments;
  double right = 0;  ///< beyond everything [m]
};

DrivableArea::DrivableArea(const RoadNetwork& network) : border_(std::make_unique<Border>()) {
  std::vector<Segment> segments;
  for (const ClipperLib::Path& ring : outlines_of(network))
    for (std::size_t k = 0; k < ring.size(); ++k) {
      segments.emplace_back(point_of(ring[k]), point_of(ring[(k + 1) % ring.size()]));
      border_->right = std::max(border_->right, segments.back().first.x());
    }
  border_->right += 1.0;
  border_->segments = decltype(border_->segments)(segments);
}

DrivableArea::~DrivableArea() = default;
DrivableArea::DrivableArea(DrivableArea&&) noexcept = default;
DrivableArea& DrivableArea::operator=(DrivableArea&&) noexcept = default;

double DrivableArea::signed_distance(const Vec2& point) const {
  namespace index = bg::index;
  const Point at(point.x(), point.y());
  const auto nearest = border_->segments.qbegin(index::nearest(at, 1));
  if (nearest == border_->segments.qend()) return std::numeric_limits<double>::infinity();
  const double distance = bg::distance(at, *nearest);
  // inside is where a ray crosses the border an odd number of times
  const bg::model::box<Point> ray(at, Point(std::max(border_->right, at.x()), at.y()));
  bool inside = false;
  for (auto found = border_->segments.qbegin(index::intersects(ray));
       found != border_->segments.qend(); ++found) {
    const Point &a = found->first, &b = found->second;
    if ((a.y() > at.y()) == (b.y() > at.y())) continue;
    const double x = a.x() + (at.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > at.x()) inside = !inside;
  }
  return inside ? -distance : distance;
}

}  // namespace sumogamma
