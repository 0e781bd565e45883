#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace sumogamma::osm {

/// A place on the ellipsoid (WGS 84) [deg].
struct GeoPoint {
  double lon = 0, lat = 0;
};

/// A box in longitude and latitude [deg]; west < east, south < north.
struct GeoBox {
  double west = 0, south = 0, east = 0, north = 0;

  GeoPoint center() const { return {(west + east) / 2, (south + north) / 2}; }
  bool contains(GeoPoint p) const {
    return p.lon >= west && p.lon <= east && p.lat >= south && p.lat <= north;
  }
  bool overlaps(const GeoBox& other) const {
    return west <= other.east && other.west <= east && south <= other.north && other.south <= north;
  }
  void extend(GeoPoint p);
  /// Larger by so many metres on each side.
  GeoBox grown(double meters) const;
};

/// True for a place within a ring that doesn't cross the 180th meridian (even-odd rule on longitude
/// and latitude). The ring may repeat its first point.
bool ring_has(std::span<const GeoPoint> ring, GeoPoint place);

/// Sorted, so that whatever is written from it is the same bytes each time.
using Tags = std::map<std::string, std::string, std::less<>>;

/// Value of a key, empty where it is absent.
const std::string& tag(const Tags& tags, std::string_view key);
/// True where the key has one of the values.
bool tag_is(const Tags& tags, std::string_view key, std::span<const std::string_view> values);
inline bool tag_is(const Tags& tags, std::string_view key,
                   std::initializer_list<std::string_view> values) {
  return tag_is(tags, key, std::span<const std::string_view>(values.begin(), values.size()));
}

struct MapNode {
  GeoPoint place;
  Tags tags;
};

struct MapWay {
  std::int64_t id = 0;
  std::vector<std::int64_t> nodes;
  Tags tags;
};

struct MapMember {
  char type = 'n';  ///< n, w or r
  std::int64_t ref = 0;
  std::string role;
};

struct MapRelation {
  std::int64_t id = 0;
  std::vector<MapMember> members;
  Tags tags;
};

/// An area put together from a closed way or a multipolygon relation. Rings do not repeat their
/// first point.
struct MapArea {
  using Ring = std::vector<GeoPoint>;
  struct Part {
    Ring outer;
    std::vector<Ring> inner;
  };
  std::string id;  ///< "way/123" or "relation/45"
  Tags tags;
  std::vector<Part> parts;
};

/// What an extract holds, as plain data: the objects that matter for traffic, ids positive.
struct OsmMap {
  std::map<std::int64_t, MapNode> nodes;
  std::vector<MapWay> ways;            ///< by id
  std::vector<MapRelation> relations;  ///< turn restrictions, by id
  std::vector<MapArea> areas;          ///< buildings and pedestrian areas
  std::vector<MapRelation> routes;     ///< lines of public transport, by id
  /// Where public transport halts: nodes and ways (of which the middle) by type and id.
  std::map<std::pair<char, std::int64_t>, MapNode> stops;
  std::optional<GeoBox> bounds;        ///< what the file says it covers
  std::map<std::string, long> counts;  ///< what was read: "nodes", "ways", "deleted_objects", ...
  std::string server_remark;           ///< why a server's answer is not whole; "" for none
  std::string bad_place;               ///< a node that is nowhere on the earth; "" for none
  std::int64_t next_id = 1;            ///< above every id in use

  std::int64_t new_id() { return next_id++; }
};

/// Metres east and north of a reference: good to centimetres within a city, for measuring only (the
/// network itself is projected by PROJ).
struct LocalMetric {
  GeoPoint origin;
  double meters_per_lon = 0, meters_per_lat = 0;

  explicit LocalMetric(GeoPoint reference);
  double east(GeoPoint p) const { return (p.lon - origin.lon) * meters_per_lon; }
  double north(GeoPoint p) const { return (p.lat - origin.lat) * meters_per_lat; }
  /// The place so many metres east and north of the reference.
  GeoPoint place(double east, double north) const {
    return {origin.lon + east / meters_per_lon, origin.lat + north / meters_per_lat};
  }
  double distance(GeoPoint a, GeoPoint b) const;
  /// Direction from a to b [rad], counter-clockwise from east.
  double bearing(GeoPoint a, GeoPoint b) const;
};

/// Box round the nodes of the ways with a highway tag; nothing where there are none.
std::optional<GeoBox> road_extent(const OsmMap& map);

/// How much the reader of a report should care.
enum class Severity : std::uint8_t { Note, Warning };

/// One kind of thing that was guessed, moved or dropped, with its number and a few examples.
struct Issue {
  Severity severity = Severity::Note;
  std::string what;
  long count = 0;
  std::vector<std::string> examples;  ///< ids, at most five
};

/// Everything that an import has to say, by a stable key such as "signal_moved".
class IssueLog {
 public:
  void add(Severity severity, const std::string& kind, const std::string& what,
           const std::string& example = "", long count = 1);
  const std::map<std::string, Issue>& issues() const { return issues_; }
  long count(const std::string& kind) const;

 private:
  std::map<std::string, Issue> issues_;
};

}  // namespace sumogamma::osm
