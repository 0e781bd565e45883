#include "osm/lanelet_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <pugixml.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "base/error.h"

namespace sumogamma::osm {

namespace {

constexpr double kAboutZero = 0.5;    // places of maps whose origin is 0, 0 [deg]
constexpr double kCentrePiece = 1.0;  // of a centre line [m]
constexpr double kNarrowest = 0.5;    // a lanelet that is narrower isn't one [m]
constexpr double kLeastLength = 0.1;  // likewise [m]

/// Tags of an element.
Tags tags_of(const pugi::xml_node& element) {
  Tags tags;
  for (const pugi::xml_node tag : element.children("tag"))
    tags[tag.attribute("k").value()] = tag.attribute("v").value();
  return tags;
}

bool is_deleted(const pugi::xml_node& element) {
  return std::string_view(element.attribute("action").value()) == "delete";
}

/// A finite number, and nothing else in the text but a unit.
std::optional<double> number_in(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (end == text.c_str() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// "50", "50 km/h", "35 mph", "10 m/s" [m/s].
std::optional<double> speed_in(const std::string& text) {
  const std::optional<double> value = number_in(text);
  if (!value || *value <= 0.0) return std::nullopt;
  if (text.find("mph") != std::string::npos) return *value * 0.44704;
  if (text.find("m/s") != std::string::npos || text.find("mps") != std::string::npos) return value;
  return *value / 3.6;
}

/// The limit of a sign's code: "de274-50" says 50 km/h.
std::optional<double> speed_of_sign(const std::string& code) {
  const std::size_t dash = code.rfind('-');
  if (!code.starts_with("de274") || dash == std::string::npos) return speed_in(code);
  return speed_in(code.substr(dash + 1));
}

bool is_stop_sign(const std::string& code) { return code == "de206" || code.starts_with("usR1-1"); }

/// A regulatory element, as far as it is understood.
struct Element {
  std::string subtype;
  std::set<std::int64_t> first, yield;  ///< lanelets of a right of way
  std::optional<double> speed;
  bool stop = false;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const std::optional<GeoPoint>& origin) : file_(file) {
    const pugi::xml_parse_result parsed = document_.load_file(file.c_str());
    if (!parsed || !document_.child("osm"))
      throw Error(file.string(),
                  parsed ? "is no OSM XML, expected a Lanelet2 map"
                         : std::string("can't be read as a Lanelet2 map: ") + parsed.description());
    read_nodes(origin);
    for (const pugi::xml_node way : root().children("way"))
      if (!is_deleted(way)) read_way(way);
    for (const pugi::xml_node relation : root().children("relation"))
      if (!is_deleted(relation)) read_element(relation);
  }

  LaneletMap read() {
    for (const pugi::xml_node relation : root().children("relation"))
      if (!is_deleted(relation) && tag(tags_of(relation), "type") == "lanelet")
        read_lanelet(relation);
    for (const pugi::xml_node relation : root().children("relation"))
      if (!is_deleted(relation) && tag(tags_of(relation), "type") == "multipolygon")
        ++map_.left_out["areas"];
    const bool drives = std::any_of(map_.lanelets.begin(), map_.lanelets.end(),
                                    [](const auto& one) { return one.use != LaneletUse::Foot; });
    if (!drives)
      throw Error(file_.string(),
                  "has no lanelets for vehicles, expected relations with type=lanelet");
    return std::move(map_);
  }

 private:
  pugi::xml_node root() const { return document_.child("osm"); }

  [[noreturn]] void refuse(const char* kind, std::int64_t id, const std::string& what) const {
    throw Error(file_.string(), fmt::format("{} {} {}", kind, id, what));
  }

  void read_nodes(const std::optional<GeoPoint>& origin) {
    std::vector<std::pair<std::int64_t, GeoPoint>> places;
    bool local = true, about_zero = true;
    for (const pugi::xml_node node : root().children("node")) {
      if (is_deleted(node)) continue;
      const std::int64_t id = node.attribute("id").as_llong();
      const GeoPoint place{node.attribute("lon").as_double(NAN),
                           node.attribute("lat").as_double(NAN)};
      const Tags tags = tags_of(node);
      const auto x = number_in(tag(tags, "local_x")), y = number_in(tag(tags, "local_y"));
      local = local && x && y;
      if (x && y) points_[id] = {*x, *y};
      about_zero =
          about_zero && std::abs(place.lon) < kAboutZero && std::abs(place.lat) < kAboutZero;
      places.emplace_back(id, place);
    }
    if (places.empty()) throw Error(file_.string(), "has no nodes, expected a Lanelet2 map");
    map_.axes = "local_x and local_y of its nodes";
    if (local) return;
    if (!origin && !about_zero)
      throw Error(file_.string(),
                  "tells longitude and latitude alone; --origin LAT,LON says where the recording's "
                  "axes have their origin");
    project(places, origin.value_or(GeoPoint{}));
  }

  void project(const std::vector<std::pair<std::int64_t, GeoPoint>>& places, GeoPoint origin) {
    const LaneletPlane plane(origin);
    for (const auto& [id, place] : places) {
      points_[id] = plane.place_of(place);
      if (!points_[id].allFinite() || points_[id].norm() > 1e5)
        refuse("node", id,
               fmt::format("lies at latitude {}, longitude {}, expected a place within "
                           "100 km of the origin {}, {}",
                           place.lat, place.lon, origin.lat, origin.lon));
    }
    map_.axes = plane.describe();
  }

  void read_way(const pugi::xml_node& way) {
    std::vector<std::int64_t>& nodes = ways_[way.attribute("id").as_llong()];
    for (const pugi::xml_node node : way.children("nd"))
      nodes.push_back(node.attribute("ref").as_llong());
    way_tags_[way.attribute("id").as_llong()] = tags_of(way);
  }

  void read_element(const pugi::xml_node& relation) {
    const Tags tags = tags_of(relation);
    if (tag(tags, "type") != "regulatory_element") return;
    Element& element = elements_[relation.attribute("id").as_llong()];
    element.subtype = tag(tags, "subtype");
    element.speed = speed_of_sign(tag(tags, "sign_type"));
    if (!element.speed) element.speed = speed_in(tag(tags, "limit"));
    for (const pugi::xml_node member : relation.children("member")) {
      const std::string_view role = member.attribute("role").value();
      const std::int64_t of = member.attribute("ref").as_llong();
      if (role == "right_of_way") element.first.insert(of);
      if (role == "yield") element.yield.insert(of);
      if (role != "refers") continue;
      const std::string& code = tag(way_tags_[of], "subtype");
      if (!element.speed) element.speed = speed_of_sign(code);
      element.stop = element.stop || is_stop_sign(code);
    }
    const bool known = element.subtype == "traffic_light" || element.subtype == "right_of_way" ||
                       element.subtype == "all_way_stop" || element.subtype == "speed_limit";
    if (!known) ++map_.left_out["regulatory elements " + element.subtype];
  }

  void apply(const Element& element, Lanelet& lanelet) const {
    if (element.subtype == "traffic_light") lanelet.signalled = true;
    if (element.subtype == "speed_limit" && element.speed) lanelet.speed = *element.speed;
    if (element.subtype == "all_way_stop") lanelet.rule = LaneletRule::StopsOnAllArms;
    if (element.subtype != "right_of_way") return;
    if (element.first.contains(lanelet.id)) lanelet.rule = LaneletRule::GoesFirst;
    if (element.yield.contains(lanelet.id))
      lanelet.rule = element.stop ? LaneletRule::Stops : LaneletRule::Yields;
  }

  void read_lanelet(const pugi::xml_node& relation) {
    const Tags tags = tags_of(relation);
    Lanelet lanelet;
    lanelet.id = relation.attribute("id").as_llong();
    const std::string& subtype = tag(tags, "subtype");
    if (tag_is(tags, "subtype", {"crosswalk", "walkway", "stairs", "shared_walkway"}))
      lanelet.use = LaneletUse::Foot;
    else if (subtype == "bicycle_lane")
      lanelet.use = LaneletUse::Bicycle;
    else if (!tag_is(
                 tags, "subtype",
                 {"", "road", "highway", "play_street", "bus_lane", "emergency_lane", "exit"})) {
      ++map_.left_out["lanelets " + subtype];
      return;
    }
    if (lanelet.use == LaneletUse::Foot) ++map_.left_out["lanelets for people (" + subtype + ")"];
    lanelet.bicycles = tag(tags, "bicycle") != "no" && tag(tags, "participant:bicycle") != "no" &&
                       subtype != "highway";
    std::optional<double> speed = speed_in(tag(tags, "speed_limit"));
    if (!speed) speed = speed_in(tag(tags, "maxspeed"));
    lanelet.speed = speed.value_or(0.0);
    if (lanelet.use == LaneletUse::Road && tag(tags, "one_way") == "no")
      ++map_.left_out["directions against a road lanelet that is driven both ways"];
    read_borders(relation, lanelet);
    if (lanelet.speed <= 0.0) {
      map_.without_a_limit += lanelet.use != LaneletUse::Foot;
      lanelet.speed = kLaneletSpeed;
    }
    map_.lanelets.push_back(std::move(lanelet));
  }

  void read_borders(const pugi::xml_node& relation, Lanelet& lanelet) {
    for (const pugi::xml_node member : relation.children("member")) {
      const std::string_view role = member.attribute("role").value();
      const std::int64_t of = member.attribute("ref").as_llong();
      if (role == "regulatory_element" && elements_.contains(of)) apply(elements_[of], lanelet);
      if (role != "left" && role != "right") continue;
      if (!ways_.contains(of)) refuse("lanelet", lanelet.id, fmt::format("lacks its way {}", of));
      append_border(ways_[of], role == "left" ? lanelet.left : lanelet.right);
    }
    if (lanelet.left.size() < 2 || lanelet.right.size() < 2)
      refuse("lanelet", lanelet.id, "has no left or no right border of two nodes");
    set_direction(lanelet);
    set_center(lanelet);
  }

  /// A border may be made of several ways.
  void append_border(std::vector<std::int64_t> nodes, std::vector<std::int64_t>& border) const {
    if (!border.empty() && !nodes.empty()) {
      if (border.front() == nodes.front() || border.front() == nodes.back())
        std::reverse(border.begin(), border.end());
      if (border.back() == nodes.back()) std::reverse(nodes.begin(), nodes.end());
      if (border.back() == nodes.front()) nodes.erase(nodes.begin());
    }
    border.insert(border.end(), nodes.begin(), nodes.end());
  }

  std::vector<Vec2> points_of(const std::vector<std::int64_t>& nodes, std::int64_t lanelet) const {
    std::vector<Vec2> points;
    for (const std::int64_t node : nodes) {
      const auto at = points_.find(node);
      if (at == points_.end()) refuse("lanelet", lanelet, fmt::format("lacks its node {}", node));
      points.push_back(at->second);
    }
    return points;
  }

  /// Ways run either way: both borders are made to run so that the left one lies on the left.
  void set_direction(Lanelet& lanelet) {
    const auto at = [&](std::int64_t node) { return points_of({node}, lanelet.id).front(); };
    const auto ends = [&](std::int64_t a, std::int64_t b) { return (at(a) - at(b)).norm(); };
    auto &left = lanelet.left, &right = lanelet.right;
    if (ends(left.front(), right.front()) + ends(left.back(), right.back()) >
        ends(left.front(), right.back()) + ends(left.back(), right.front()))
      std::reverse(right.begin(), right.end());
    std::vector<Vec2> outline = points_of(right, lanelet.id);
    const std::vector<Vec2> back = points_of(left, lanelet.id);
    outline.insert(outline.end(), back.rbegin(), back.rend());
    double area = 0;
    for (std::size_t k = 0; k < outline.size(); ++k)
      area += cross(outline[k], outline[(k + 1) % outline.size()]);
    if (area >= 0) return;
    std::reverse(left.begin(), left.end());
    std::reverse(right.begin(), right.end());
    ++map_.turned;
  }

  void set_center(Lanelet& lanelet) const {
    const Polyline left(points_of(lanelet.left, lanelet.id)),
        right(points_of(lanelet.right, lanelet.id));
    const double length = std::max(left.length(), right.length());
    const auto pieces = std::max(1, static_cast<int>(std::ceil(length / kCentrePiece)));
    std::vector<Vec2> points;
    std::vector<double> widths;
    for (int k = 0; k <= pieces; ++k) {
      const double share = static_cast<double>(k) / pieces;
      const Vec2 a = left.point_at(share * left.length()),
                 b = right.point_at(share * right.length());
      points.emplace_back(0.5 * (a + b));
      widths.push_back((a - b).norm());
    }
    std::nth_element(widths.begin(), widths.begin() + pieces / 2, widths.end());
    lanelet.width = widths[static_cast<std::size_t>(pieces / 2)];
    lanelet.center = Polyline(points);
    if (lanelet.width < kNarrowest || lanelet.center.length() < kLeastLength)
      refuse("lanelet", lanelet.id,
             fmt::format("is {:.2f} m wide and {:.2f} m long, expected at least {} m and {} m",
                         lanelet.width, lanelet.center.length(), kNarrowest, kLeastLength));
  }

  std::filesystem::path file_;
  pugi::xml_document document_;
  LaneletMap map_;
  std::map<std::int64_t, Vec2> points_;
  std::map<std::int64_t, std::vector<std::int64_t>> ways_;
  std::map<std::int64_t, Tags> way_tags_;
  std::map<std::int64_t, Element> elements_;
};

}  // namespace

LaneletPlane::LaneletPlane(GeoPoint origin)
    : origin_(origin),
      zone_(std::clamp(static_cast<int>(std::floor((origin.lon + 180.0) / 6.0)) + 1, 1, 60)),
      projection_(fmt::format("+proj=utm +zone={}{} +ellps=WGS84 +units=m +no_defs", zone_,
                              origin.lat < 0 ? " +south" : "")),
      zero_(projection_.to_plane(origin)) {}

std::string LaneletPlane::describe() const {
  return fmt::format("UTM zone {} less the origin {}, {}", zone_, origin_.lat, origin_.lon);
}

LaneletMap read_lanelet_map(const std::filesystem::path& file,
                            const std::optional<GeoPoint>& origin) {
  return Reader(file, origin).read();
}

}  // namespace sumogamma::osm
