#include "osm/osm_reader.h"

// g++ 12 takes libosmium's "data right behind the object" for an overread; clang does not know the
// warning
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic ignored "-Wstringop-overread"
#endif
// libosmium asserts on some malformed input where it does not throw; the checks that matter are
// made here
#ifndef NDEBUG
#define NDEBUG
#endif
#include <algorithm>
#include <array>
#include <osmium/area/assembler.hpp>
#include <osmium/area/multipolygon_manager.hpp>
#include <osmium/handler/node_locations_for_ways.hpp>
#include <osmium/index/map/flex_mem.hpp>
#include <osmium/io/any_input.hpp>
#include <osmium/object_pointer_collection.hpp>
#include <osmium/osm/object_comparisons.hpp>
#include <osmium/version.hpp>
#include <osmium/visitor.hpp>
#include <set>

#include "base/error.h"
#include "osm/file_kind.h"
#include "osm/xml_dialects.h"

namespace sumogamma::osm {
namespace {

using Index = osmium::index::map::FlexMem<osmium::unsigned_object_id_type, osmium::Location>;
using Locations = osmium::handler::NodeLocationsForWays<Index, Index>;
using Areas = osmium::area::MultipolygonManager<osmium::area::Assembler>;

/// Keys of ways and nodes that anything downstream looks at.
constexpr std::array kWayKeys = {"highway", "building", "barrier", "building:part"};
constexpr std::array kNodeKeys = {"highway",  "barrier",         "natural",
                                  "crossing", "traffic_signals", "railway"};

/// Kinds of lines that a report speaks of.
constexpr std::array<std::string_view, 13> kLines = {
    "bus",   "trolleybus", "share_taxi", "minibus",   "tram",  "light_rail", "subway",
    "train", "railway",    "monorail",   "funicular", "ferry", "aerialway"};

bool is_stop(const osmium::TagList& tags) {
  return tags.has_tag("highway", "bus_stop") || tags.has_tag("highway", "platform") ||
         tags.has_tag("public_transport", "platform") ||
         tags.has_tag("public_transport", "stop_position");
}

template <std::size_t N>
bool has_any(const osmium::TagList& tags, const std::array<const char*, N>& keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return tags.has_key(key); });
}

Tags copy_tags(const osmium::TagList& list) {
  Tags tags;
  for (const osmium::Tag& entry : list) tags.emplace(entry.key(), entry.value());
  return tags;
}

GeoPoint point_of(osmium::Location location) {
  return {location.lon_without_check(), location.lat_without_check()};
}

constexpr std::size_t kLargestText = std::size_t{1} << 29;  // bytes: what is rewritten as XML

/// The text of an XML file, cut where it is very large, and what is unusual in it. It is looked at
/// block by block: only small files come out of an editor or a server, large ones must not be held
/// whole.
std::string read_text(const osmium::io::File& input, XmlDialect& dialect) {
  if (input.format() != osmium::io::file_format::xml) return {};
  constexpr std::size_t kOverlap = 256;
  const int descriptor = osmium::io::detail::open_for_reading(input.filename());
  auto decompressor = osmium::io::CompressionFactory::instance().create_decompressor(
      input.compression(), descriptor);
  std::string text, tail;
  for (std::string block = decompressor->read(); !block.empty(); block = decompressor->read()) {
    const std::string seen = tail + block;
    look_at_xml(seen, dialect);
    tail = seen.substr(seen.size() - std::min(seen.size(), kOverlap));
    if (text.size() < kLargestText) text += block;
  }
  decompressor->close();
  return text;
}

/// First pass: where the nodes are, which relations make areas, and whether objects stand in the
/// usual order.
class FirstPass : public osmium::handler::Handler {
 public:
  FirstPass(Locations& locations, Areas& areas, std::map<std::string, long>& counts)
      : locations_(locations), areas_(areas), counts_(counts) {}

  void node(const osmium::Node& node) {
    check_order(node);
    ++counts_["nodes"];
    if (!node.visible()) return;
    if (node.location().valid())
      locations_.node(node);
    else
      ++counts_["nodes_without_valid_place"];
  }
  void way(const osmium::Way& way) {
    check_order(way);
    ++counts_["ways"];
  }
  void relation(const osmium::Relation& relation) {
    check_order(relation);
    ++counts_["relations"];
    if (relation.visible()) areas_.relation(relation);
  }
  bool ordered() const { return ordered_; }

 private:
  void check_order(const osmium::OSMObject& object) {
    const auto key =
        std::make_tuple(static_cast<int>(object.type()), object.id() > 0, object.positive_id());
    if (seen_ && !(last_ < key)) ordered_ = false;
    last_ = key;
    seen_ = true;
  }
  Locations& locations_;
  Areas& areas_;
  std::map<std::string, long>& counts_;
  std::tuple<int, bool, osmium::unsigned_object_id_type> last_{};
  bool seen_ = false, ordered_ = true;
};

/// Second pass: what matters becomes plain data.
class SecondPass : public osmium::handler::Handler {
 public:
  SecondPass(Locations& locations, OsmMap& map, const std::optional<GeoBox>& keep)
      : locations_(locations), map_(map), keep_(keep) {}

  void node(const osmium::Node& node) {
    if (!node.visible() || !node.location().valid()) return;
    const GeoPoint place = point_of(node.location());
    if (keep_ && !keep_->contains(place)) return;
    if (is_stop(node.tags())) map_.stops[{'n', node.id()}] = {place, copy_tags(node.tags())};
    if (!has_any(node.tags(), kNodeKeys)) return;
    MapNode& kept = map_.nodes[node.id()];
    kept.place = place;
    kept.tags = copy_tags(node.tags());
  }

  /// False where the way is not fit to be looked at by anyone.
  bool way(osmium::Way& way) {
    if (!way.visible() || way.nodes().size() < 2) {
      ++map_.counts["ways_without_nodes"];
      return false;
    }
    locations_.way(way);
    if (is_stop(way.tags())) take_platform(way);
    if (!has_any(way.tags(), kWayKeys)) return true;
    MapWay kept{way.id(), {}, copy_tags(way.tags())};
    std::vector<GeoPoint> places;
    std::optional<GeoBox> extent;
    for (const osmium::NodeRef& ref : way.nodes()) {
      if (!ref.location().valid()) {
        ++map_.counts["missing_nodes"];
        continue;
      }
      if (!kept.nodes.empty() && kept.nodes.back() == ref.ref()) continue;
      kept.nodes.push_back(ref.ref());
      places.push_back(point_of(ref.location()));
      if (!extent)
        extent = GeoBox{places.back().lon, places.back().lat, places.back().lon, places.back().lat};
      extent->extend(places.back());
    }
    if (kept.nodes.size() < 2) {
      ++map_.counts["ways_without_nodes"];
      return true;
    }
    if (keep_ && !keep_->overlaps(*extent)) {
      ++map_.counts["ways_outside"];
      return true;
    }
    for (std::size_t i = 0; i < places.size(); ++i) map_.nodes[kept.nodes[i]].place = places[i];
    map_.ways.push_back(std::move(kept));
    return true;
  }

  void relation(const osmium::Relation& relation) {
    if (!relation.visible()) return;
    const std::string_view type = relation.tags().get_value_by_key("type", "");
    const std::string_view route = relation.tags().get_value_by_key("route", "");
    const bool line =
        type == "route" && std::find(kLines.begin(), kLines.end(), route) != kLines.end();
    if (type != "restriction" && !line) return;
    MapRelation kept{relation.id(), {}, copy_tags(relation.tags())};
    for (const osmium::RelationMember& member : relation.members())
      kept.members.push_back(
          {osmium::item_type_to_char(member.type()), member.ref(), member.role()});
    (line ? map_.routes : map_.relations).push_back(std::move(kept));
  }

  void area(const osmium::Area& area) {
    MapArea kept;
    kept.id = (area.from_way() ? "way/" : "relation/") + std::to_string(area.orig_id());
    kept.tags = copy_tags(area.tags());
    bool inside = !keep_;
    auto ring_of = [&](const osmium::NodeRefList& nodes) {
      MapArea::Ring ring;
      for (const osmium::NodeRef& ref : nodes) {
        ring.push_back(point_of(ref.location()));
        inside = inside || keep_->contains(ring.back());
      }
      if (ring.size() > 1) ring.pop_back();  // osmium repeats the first point
      return ring;
    };
    for (const osmium::OuterRing& outer : area.outer_rings()) {
      MapArea::Part part{ring_of(outer), {}};
      for (const osmium::InnerRing& inner : area.inner_rings(outer))
        part.inner.push_back(ring_of(inner));
      if (part.outer.size() >= 3) kept.parts.push_back(std::move(part));
    }
    if (inside && !kept.parts.empty()) map_.areas.push_back(std::move(kept));
  }

 private:
  /// The middle of a way along which passengers wait.
  void take_platform(const osmium::Way& way) {
    std::optional<GeoBox> extent;
    for (const osmium::NodeRef& ref : way.nodes()) {
      if (!ref.location().valid()) continue;
      const GeoPoint place = point_of(ref.location());
      if (!extent) extent = GeoBox{place.lon, place.lat, place.lon, place.lat};
      extent->extend(place);
    }
    if (!extent || (keep_ && !keep_->contains(extent->center()))) return;
    map_.stops[{'w', way.id()}] = {extent->center(), copy_tags(way.tags())};
  }

  Locations& locations_;
  OsmMap& map_;
  const std::optional<GeoBox>& keep_;
};

osmium::TagsFilter area_filter() {
  osmium::TagsFilter filter{false};
  filter.add_rule(true, "building");
  filter.add_rule(true, "area", "yes");
  filter.add_rule(true, "highway", "pedestrian");
  return filter;
}

void take_bounds(const osmium::io::Header& header, OsmMap& map) {
  for (const osmium::Box& box : header.boxes()) {
    if (!box.valid()) continue;
    const GeoPoint low = point_of(box.bottom_left()), high = point_of(box.top_right());
    if (!(low.lon < high.lon && low.lat < high.lat)) continue;
    if (!map.bounds) map.bounds = GeoBox{low.lon, low.lat, high.lon, high.lat};
    map.bounds->extend(low);
    map.bounds->extend(high);
  }
}

/// Feeds one object to the second pass and, where it is sound, to the area builder.
template <typename AreaHandler>
void second_pass_object(osmium::OSMObject& object, SecondPass& pass, AreaHandler& area_handler) {
  switch (object.type()) {
    case osmium::item_type::node:
      return pass.node(static_cast<osmium::Node&>(object));
    case osmium::item_type::way:
      if (pass.way(static_cast<osmium::Way&>(object)))
        area_handler.way(static_cast<osmium::Way&>(object));
      return;
    case osmium::item_type::relation:
      return pass.relation(static_cast<osmium::Relation&>(object));
    default:
      return;
  }
}

void read_second_pass(const osmium::io::File& input, bool ordered, SecondPass& pass, Areas& areas) {
  auto& area_handler =
      areas.handler([&](osmium::memory::Buffer&& buffer) { osmium::apply(buffer, pass); });
  if (ordered) {
    osmium::io::Reader reader(input);
    while (osmium::memory::Buffer buffer = reader.read())
      for (auto& object : buffer.select<osmium::OSMObject>())
        second_pass_object(object, pass, area_handler);
    reader.close();
  } else {
    // Overpass' "out body; >; out skel qt;" puts ways before nodes, and ids in no order: sort in
    // memory
    std::vector<osmium::memory::Buffer> buffers;
    osmium::ObjectPointerCollection objects;
    osmium::io::Reader reader(input);
    while (osmium::memory::Buffer buffer = reader.read()) buffers.push_back(std::move(buffer));
    reader.close();
    for (osmium::memory::Buffer& buffer : buffers)
      for (auto& object : buffer.select<osmium::OSMObject>()) objects.osm_object(object);
    objects.sort(osmium::object_order_type_id_reverse_version{});
    objects.unique(osmium::object_equal_type_id{});
    for (auto& object : objects) second_pass_object(object, pass, area_handler);
  }
  areas.flush_output();
  osmium::memory::Buffer rest = areas.read();
  if (rest) osmium::apply(rest, pass);
}

/// Unsaved objects of an editor have negative ids: give them positive ones above all others.
void make_ids_positive(OsmMap& map) {
  std::int64_t highest = 0;
  for (const auto& [id, node] : map.nodes) highest = std::max(highest, id);
  for (const MapWay& way : map.ways) highest = std::max(highest, way.id);
  for (const MapRelation& relation : map.relations) highest = std::max(highest, relation.id);
  map.next_id = highest + 1;

  std::map<std::pair<char, std::int64_t>, std::int64_t> renamed;
  auto positive = [&](char type, std::int64_t id) {
    if (id > 0) return id;
    const auto [entry, added] = renamed.emplace(std::make_pair(type, id), map.next_id);
    if (added) ++map.next_id;
    return entry->second;
  };
  std::map<std::int64_t, MapNode> nodes;
  for (auto& [id, node] : map.nodes) nodes.emplace(positive('n', id), std::move(node));
  map.nodes = std::move(nodes);
  for (MapWay& way : map.ways) {
    way.id = positive('w', way.id);
    for (std::int64_t& ref : way.nodes) ref = positive('n', ref);
  }
  for (MapRelation& relation : map.relations) {
    relation.id = positive('r', relation.id);
    for (MapMember& member : relation.members) member.ref = positive(member.type, member.ref);
  }
  // lines and stops take what was given to the others: no id of a network depends on them
  const auto same = [&](char type, std::int64_t id) {
    const auto given = renamed.find({type, id});
    return given == renamed.end() ? id : given->second;
  };
  for (MapRelation& line : map.routes)
    for (MapMember& member : line.members) member.ref = same(member.type, member.ref);
  std::map<std::pair<char, std::int64_t>, MapNode> stops;
  for (auto& [key, stop] : map.stops)
    stops.emplace(std::pair(key.first, same(key.first, key.second)), std::move(stop));
  map.stops = std::move(stops);
  auto by_id = [](const auto& a, const auto& b) { return a.id < b.id; };
  std::stable_sort(map.ways.begin(), map.ways.end(), by_id);
  std::stable_sort(map.relations.begin(), map.relations.end(), by_id);
  std::stable_sort(map.routes.begin(), map.routes.end(), by_id);
  if (!renamed.empty()) map.counts["renamed_negative_ids"] = static_cast<long>(renamed.size());
}

void check_readable(const std::filesystem::path& file) {
  std::error_code code;
  const auto status = std::filesystem::status(file, code);
  if (!std::filesystem::exists(status))
    throw Error(
        file.string(),
        "no such file; expected an OpenStreetMap extract (.osm, .osm.gz, .osm.bz2, .osm.pbf)");
  if (std::filesystem::is_directory(status))
    throw Error(
        file.string(),
        "is a folder; expected an OpenStreetMap extract (.osm, .osm.gz, .osm.bz2, .osm.pbf)");
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(file, code) == 0)
    throw Error(file.string(), "is empty; expected an OpenStreetMap extract");
}

OsmMap read_checked(const osmium::io::File& input, const std::optional<GeoBox>& keep) {
  OsmMap map;
  Index positive, negative;
  Locations locations(positive, negative);
  locations.ignore_errors();
  osmium::area::Assembler::config_type config;
  config.ignore_invalid_locations = true;
  Areas areas(config, area_filter());

  FirstPass first(locations, areas, map.counts);
  {
    osmium::io::Reader reader(input);
    take_bounds(reader.header(), map);
    while (osmium::memory::Buffer buffer = reader.read()) osmium::apply(buffer, first);
    reader.close();
  }
  areas.prepare_for_lookup();
  SecondPass second(locations, map, keep);
  read_second_pass(input, first.ordered(), second, areas);
  areas.for_each_incomplete_relation(
      [&](const osmium::relations::RelationHandle&) { ++map.counts["incomplete_areas"]; });
  make_ids_positive(map);
  std::stable_sort(map.areas.begin(), map.areas.end(),
                   [](const MapArea& a, const MapArea& b) { return a.id < b.id; });
  return map;
}

osmium::io::File as_input(const std::string& text) {
  return osmium::io::File(text.data(), text.size(), "osm");
}

/// Reads the file as it stands, or as plain XML where it has what libosmium doesn't know, or
/// refuses: what it says of the file itself holds where neither can be read.
OsmMap read_either(const std::filesystem::path& file, const std::optional<GeoBox>& keep) {
  const osmium::io::File input(file.string(), kind_of_file(file));
  XmlDialect dialect;
  const std::string text = read_text(input, dialect);
  std::map<std::string, long> counts;
  OsmMap map;
  if (dialect.any()) {
    map = read_checked(as_input(plain_osm_xml(text, file, counts)), keep);
  } else {
    try {
      map = read_checked(input, keep);
    } catch (const osmium::invalid_location&) {
      const std::string where = node_off_the_earth(text);
      if (where.empty()) throw;
      throw Error(file.string(), where + " is no place on the earth: mend or delete it");
    } catch (const std::exception&) {
      std::string plain;
      try {
        if (text.size() < kLargestText) plain = plain_osm_xml(text, file, counts);
      } catch (const Error&) {  // no XML either: the first reason holds
      }
      if (plain.empty()) throw;
      map = read_checked(as_input(plain), keep);
      ++counts["read_as_plain_xml"];
    }
  }
  map.counts.merge(counts);
  map.server_remark = dialect.remark;
  if (map.counts["nodes_without_valid_place"] > 0) map.bad_place = node_off_the_earth(text);
  return map;
}

}  // namespace

OsmMap read_osm(const std::filesystem::path& file, const std::optional<GeoBox>& keep) {
  check_readable(file);
  OsmMap map;
  try {
    map = read_either(file, keep);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(file.string(),
                "too large for this machine's memory: cut it first (osmium extract -b W,S,E,N)");
  } catch (const std::exception& error) {
    throw Error(file.string(), std::string("not a whole OpenStreetMap file: ") + error.what() +
                                   "; download or convert it again");
  }
  if (map.counts["nodes"] == 0)
    throw Error(
        file.string(),
        "holds no OpenStreetMap objects; expected nodes and ways (an empty download?" +
            (map.server_remark.empty() ? ")" : "; the server said: " + map.server_remark + ")"));
  if (!map.bad_place.empty() && map.ways.empty())
    throw Error(file.string(), map.bad_place + " is no place on the earth; are the two mixed up?");
  return map;
}

std::string osmium_version() { return LIBOSMIUM_VERSION_STRING; }

}  // namespace sumogamma::osm
