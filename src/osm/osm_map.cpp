#include "osm/osm_map.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "road/lane_locator.h"

namespace sumogamma::osm {
namespace {
constexpr double kEarthRadius = 6371008.8;  // mean radius [m], IUGG
}

void GeoBox::extend(GeoPoint p) {
  west = std::min(west, p.lon);
  east = std::max(east, p.lon);
  south = std::min(south, p.lat);
  north = std::max(north, p.lat);
}

GeoBox GeoBox::grown(double meters) const {
  const LocalMetric metric(center());
  const double lon = meters / metric.meters_per_lon, lat = meters / metric.meters_per_lat;
  return {west - lon, south - lat, east + lon, north + lat};
}

bool ring_has(std::span<const GeoPoint> ring, GeoPoint place) {
  std::vector<Vec2> points;
  for (const GeoPoint p : ring) points.emplace_back(p.lon, p.lat);
  return sumogamma::ring_contains(points, Vec2(place.lon, place.lat));
}

const std::string& tag(const Tags& tags, std::string_view key) {
  static const std::string none;
  const auto found = tags.find(key);
  return found == tags.end() ? none : found->second;
}

bool tag_is(const Tags& tags, std::string_view key, std::span<const std::string_view> values) {
  const std::string& value = tag(tags, key);
  return std::find(values.begin(), values.end(), value) != values.end();
}

LocalMetric::LocalMetric(GeoPoint reference)
    : origin(reference),
      // near the poles a degree of longitude has no length: keep it positive
      meters_per_lon(kEarthRadius * radians(1.0) *
                     std::max(std::cos(radians(reference.lat)), 1e-6)),
      meters_per_lat(kEarthRadius * radians(1.0)) {}

double LocalMetric::distance(GeoPoint a, GeoPoint b) const {
  return std::hypot(east(b) - east(a), north(b) - north(a));
}

double LocalMetric::bearing(GeoPoint a, GeoPoint b) const {
  return std::atan2(north(b) - north(a), east(b) - east(a));
}

std::optional<GeoBox> road_extent(const OsmMap& map) {
  std::optional<GeoBox> box;
  for (const MapWay& way : map.ways) {
    if (!way.tags.contains("highway")) continue;
    for (const std::int64_t ref : way.nodes) {
      const GeoPoint p = map.nodes.at(ref).place;
      if (!box) box = GeoBox{p.lon, p.lat, p.lon, p.lat};
      box->extend(p);
    }
  }
  return box;
}

void IssueLog::add(Severity severity, const std::string& kind, const std::string& what,
                   const std::string& example, long count) {
  constexpr std::size_t kExamples = 5;
  Issue& issue = issues_[kind];
  issue.severity = severity;
  issue.what = what;
  issue.count += count;
  if (!example.empty() && issue.examples.size() < kExamples) issue.examples.push_back(example);
}

long IssueLog::count(const std::string& kind) const {
  const auto found = issues_.find(kind);
  return found == issues_.end() ? 0 : found->second.count;
}

}  // namespace sumogamma::osm
