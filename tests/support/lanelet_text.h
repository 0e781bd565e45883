#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma::testing {

/// How nodes of a made Lanelet2 map tell their places.
enum class LaneletPlaces : std::uint8_t {
  AboutZero,  ///< longitude and latitude about 0, 0, as in INTERACTION's maps
  Local,      ///< local_x and local_y beside others' longitude and latitude
};

/// A Lanelet2 map in OSM XML, made of its parts.
class LaneletText {
 public:
  explicit LaneletText(LaneletPlaces places = LaneletPlaces::AboutZero) : places_(places) {}

  /// A way through points; its number.
  int way(const std::vector<Vec2>& points, const std::string& type = "line_thin",
          const std::string& subtype = "") {
    const int id = ++way_id_;
    ways_ += fmt::format("<way id='{}'>", id);
    for (const Vec2& point : points) ways_ += fmt::format("<nd ref='{}'/>", node(point));
    ways_ += fmt::format("<tag k='type' v='{}'/><tag k='subtype' v='{}'/></way>\n", type, subtype);
    return id;
  }
  /// A lanelet between two ways; its number.
  int lanelet(int left, int right, const std::string& tags = "", const std::string& members = "") {
    return relation("lanelet",
                    fmt::format("<member type='way' ref='{}' role='left'/>"
                                "<member type='way' ref='{}' role='right'/>{}",
                                left, right, members),
                    tags.empty() ? tag("subtype", "road") + tag("one_way", "yes") : tags);
  }
  /// Numbers of relations are given in order, from 1001 on.
  int relation(const std::string& type, const std::string& members, const std::string& tags) {
    const int id = ++relation_id_;
    relations_ +=
        fmt::format("<relation id='{}'>{}{}{}</relation>\n", id, members, tag("type", type), tags);
    return id;
  }
  static std::string tag(const std::string& key, const std::string& value) {
    return fmt::format("<tag k='{}' v='{}'/>", key, value);
  }
  static std::string rule(int id) {
    return fmt::format("<member type='relation' ref='{}' role='regulatory_element'/>", id);
  }
  std::string text() const {
    return "<?xml version='1.0' encoding='UTF-8'?>\n<osm version='0.6' generator='JOSM'>\n" +
           nodes_ + ways_ + relations_ + "</osm>\n";
  }

 private:
  int node(const Vec2& point) {
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (points_[k] == point) return static_cast<int>(k) + 1;
    points_.push_back(point);
    const int id = static_cast<int>(points_.size());
    // metres a degree at the equator, 3 degrees off the middle of UTM's zone 31
    constexpr double kX = 111319.49 * 1.00097, kY = 110574.28 * 1.00097;
    const bool local = places_ == LaneletPlaces::Local;
    nodes_ += fmt::format("<node id='{}' visible='true' lat='{:.12f}' lon='{:.12f}'>{}</node>\n",
                          id, local ? 50.7 : point.y() / kY, local ? 6.1 : point.x() / kX,
                          local ? tag("local_x", std::to_string(point.x())) +
                                      tag("local_y", std::to_string(point.y()))
                                : "");
    return id;
  }

  LaneletPlaces places_;
  std::vector<Vec2> points_;
  std::string nodes_, ways_, relations_;
  int way_id_ = 100, relation_id_ = 1000;
};

/// Two lanes from the west go straight on over a junction and have the right of way there over a
/// lane from the south, which goes north or turns right; a crosswalk in the east.
///
///               N                relations: 1001 limit of 50, 1002 right of way,
///               |                1003, 1004 the western lanes (right, left), 1005, 1006 over the
///    W ======== + ======== E     junction, 1007, 1008 the eastern ones, 1009 the southern one,
///               |                1010 from it to the east, 1011 to the north, 1012 the northern
///               S                one, 1013 the crosswalk
inline std::string lanelet_crossing(LaneletPlaces places = LaneletPlaces::AboutZero) {
  LaneletText map(places);
  const auto t = &LaneletText::tag;
  const int sign = map.way({{-1, -2}, {0, -2}}, "traffic_sign", "de274-50");
  const int limit = map.relation("regulatory_element",
                                 fmt::format("<member type='way' ref='{}' role='refers'/>", sign),
                                 t("subtype", "speed_limit"));
  const int right_of_way = map.relation("regulatory_element",
                                        "<member type='relation' ref='1003' role='right_of_way'/>"
                                        "<member type='relation' ref='1004' role='right_of_way'/>"
                                        "<member type='relation' ref='1009' role='yield'/>",
                                        t("subtype", "right_of_way"));
  std::vector<int> borders;
  for (const auto& [from, to] : {std::pair(-60.0, 0.0), {0.0, 20.0}, {20.0, 80.0}})
    for (const double y : {0.0, 3.5, 7.0}) borders.push_back(map.way({{from, y}, {to, y}}));
  const std::string rules = LaneletText::rule(limit) + LaneletText::rule(right_of_way);
  for (std::size_t k = 0; k < 6; ++k)
    map.lanelet(borders[3 * (k / 2) + k % 2 + 1], borders[3 * (k / 2) + k % 2], "",
                k < 2 ? rules : "");
  // its right border is drawn against its direction
  map.lanelet(map.way({{5, -60}, {5, -10}}), map.way({{8.5, -10}, {8.5, -60}}),
              t("subtype", "road") + t("speed_limit", "30 km/h"), LaneletText::rule(right_of_way));
  map.lanelet(map.way({{5, -10}, {10, 2}, {20, 3.5}}), map.way({{8.5, -10}, {12, -1}, {20, 0}}));
  map.lanelet(map.way({{5, -10}, {5, 17}}), map.way({{8.5, -10}, {8.5, 17}}));
  map.lanelet(map.way({{5, 17}, {5, 60}}), map.way({{8.5, 17}, {8.5, 60}}));
  map.lanelet(map.way({{30, -2}, {30, 9}}), map.way({{33, -2}, {33, 9}}),
              t("subtype", "crosswalk"));
  return map.text();
}

}  // namespace sumogamma::testing
