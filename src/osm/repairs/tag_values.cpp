#include "osm/repairs/tag_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <vector>

#include "osm/ways.h"

namespace sumogamma::osm {
namespace {

constexpr double kSlowest = 3.0, kFastest = 160.0;  // [km/h]: the highest limit anywhere is 160
constexpr int kMostLanes = 8;    // of one direction: few motorways and toll plazas have more
constexpr int kMostLayers = 10;  // over or under the ground: the highest interchange has 7

std::vector<std::string> split(const std::string& text, std::string_view separators) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

std::string trimmed(std::string text) {
  const auto space = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && space(text.back())) text.pop_back();
  while (!text.empty() && space(text.front())) text.erase(text.begin());
  return text;
}

/// The number at the start of a text, and what follows it.
std::optional<double> number_of(const std::string& text, std::string& rest) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || !std::isfinite(value)) return std::nullopt;
  rest = trimmed(std::string(end, text.data() + text.size()));
  return value;
}

std::optional<double> one_speed_limit(std::string text) {
  text = trimmed(std::move(text));
  if (text == "walk") return 5.0;
  if (text.size() > 3 && text[2] == ':') text = text.substr(3);
  if (text.starts_with("zone")) text = text.substr(text.starts_with("zone:") ? 5 : 4);
  std::string unit;
  const std::optional<double> value = number_of(text, unit);
  if (!value) return std::nullopt;
  if (unit.empty() || unit == "km/h" || unit == "kmh" || unit == "kph" || unit == "kmph")
    return *value;
  if (unit == "mph") return *value * 1.609344;
  if (unit == "knots") return *value * 1.852;
  return std::nullopt;
}

/// Is it a name that netconvert knows ("DE:urban", "none"), or one for which the kind of road
/// holds?
bool is_a_name(const std::string& value) {
  if (value == "none" || value == "signals" || value == "sign" || value == "variable") return true;
  return value.find(':') != std::string::npos &&
         std::none_of(value.begin(), value.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::string example(const MapWay& way, const std::string& value) {
  return "way/" + std::to_string(way.id) + " " + value.substr(0, 40);
}

void correct_speed(MapWay& way, const char* key, IssueLog& log) {
  const auto found = way.tags.find(key);
  if (found == way.tags.end()) return;
  const std::string value = found->second;
  if (value == "signals" || value == "variable" || value == "sign") {
    way.tags.erase(found);
    log.add(Severity::Note, "maxspeed_of_signs",
            "limits that signs show by the hour: that of the kind of road instead",
            example(way, value));
    return;
  }
  if (is_a_name(value)) return;
  const std::optional<double> limit = speed_limit(value);
  if (!limit) {
    way.tags.erase(found);
    log.add(Severity::Warning, "maxspeed_not_meant",
            "maxspeed that is no speed limit (0, negative, over 160 km/h, no number): that of the "
            "kind of road instead",
            example(way, value));
    return;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", std::round(10 * *limit) / 10);
  std::string rest;
  if (number_of(value, rest) && rest.empty()) return;  // a plain number: as it stands
  found->second = text;
  if (value.find_first_of(";|") != std::string::npos)
    log.add(Severity::Warning, "maxspeed_list", "several values of maxspeed: the least of them",
            example(way, value));
}

/// A whole number of lanes, the least of a list; nothing where it is none.
std::optional<int> lane_count(const std::string& value) {
  std::optional<int> least;
  for (const std::string& part : split(value, ";|")) {
    std::string rest;
    const std::optional<double> count = number_of(trimmed(part), rest);
    if (!count || !rest.empty() || std::abs(*count) > 1e6) return std::nullopt;
    const int lanes = static_cast<int>(std::ceil(*count));  // 1.5: two that are narrow
    least = std::min(least.value_or(lanes), lanes);
  }
  return least;
}

void correct_lanes(MapWay& way, const char* key, int most, IssueLog& log) {
  const auto found = way.tags.find(key);
  if (found == way.tags.end()) return;
  const std::string value = found->second;
  const std::optional<int> lanes = lane_count(value);
  if (!lanes || *lanes < 1 || *lanes > most) {
    way.tags.erase(found);
    log.add(Severity::Warning, "lanes_not_meant",
            "numbers of lanes that can't be meant (none, no number, more than 8 in a direction): "
            "those of the kind of road instead",
            example(way, std::string(key) + "=" + value));
    return;
  }
  if (std::to_string(*lanes) == value) return;
  found->second = std::to_string(*lanes);
  log.add(Severity::Note, "lanes_rewritten", "numbers of lanes that netconvert doesn't read",
          example(way, std::string(key) + "=" + value));
}

/// Lists by lane that are longer than any road is wide.
void correct_lists(MapWay& way, IssueLog& log) {
  for (auto entry = way.tags.begin(); entry != way.tags.end();) {
    const auto& [key, value] = *entry;
    const auto lanes = 1 + std::count(value.begin(), value.end(), '|');
    if (key.find(":lanes") == std::string::npos || lanes <= 2 * kMostLanes) {
      ++entry;
      continue;
    }
    log.add(Severity::Warning, "lanes_not_meant",
            "numbers of lanes that can't be meant (none, no number, more than 8 in a direction): "
            "those of the kind of road instead",
            example(way, key + " of " + std::to_string(lanes)));
    entry = way.tags.erase(entry);
  }
}

/// SUMO has no lane that both directions use, and netconvert 1.15 would make it one more lane to
/// drive straight on in one of them: the other lanes stay, those who turn wait in theirs.
void take_out_center_lane(MapWay& way, IssueLog& log) {
  const std::optional<int> both = lane_count(tag(way.tags, "lanes:both_ways"));
  if (!both || *both < 1 || *both > kMostLanes) return;
  const auto count = [&](const char* key) { return lane_count(tag(way.tags, key)); };
  const std::optional<int> all = count("lanes"), forward = count("lanes:forward"),
                           backward = count("lanes:backward");
  std::optional<int> left = all ? std::optional(*all - *both) : std::nullopt;
  if (forward && backward) left = *forward + *backward;
  if (left && *left >= 1) way.tags["lanes"] = std::to_string(*left);
  way.tags.erase("lanes:both_ways");
  way.tags.erase("turn:lanes:both_ways");
  log.add(
      Severity::Warning, "center_turn_lane",
      "lanes in the middle for those who turn out of either direction: SUMO has none, they wait "
      "in their own lane",
      example(way, "lanes:both_ways"));
}

void correct_layer(MapWay& way, IssueLog& log) {
  const auto found = way.tags.find("layer");
  if (found == way.tags.end()) return;
  std::string rest;
  const std::optional<double> layer = number_of(found->second, rest);
  const bool whole = layer && rest.empty() && *layer == std::floor(*layer);
  if (whole && std::abs(*layer) <= kMostLayers) return;
  log.add(Severity::Warning, "layer_not_meant",
          "layers that can't be meant (no whole number from -10 to 10): left out",
          example(way, found->second));
  way.tags.erase(found);
}

void correct_oneway(MapWay& way, IssueLog& log) {
  const auto found = way.tags.find("oneway");
  if (found == way.tags.end() ||
      tag_is(way.tags, "oneway", {"yes", "true", "1", "-1", "reverse", "no", "false", "0"}))
    return;
  const bool by_hour = tag_is(way.tags, "oneway", {"reversible", "alternating"});
  if (by_hour)
    log.add(Severity::Warning, "oneway_by_hour",
            "roads whose direction changes by the hour or at lights: open both ways at all times",
            example(way, found->second));
  else
    log.add(Severity::Warning, "oneway_unknown",
            "values of oneway that nobody knows: open both ways", example(way, found->second));
  way.tags.erase(found);
}

void note_unread(const MapWay& way, IssueLog& log) {
  for (const char* key : {"bus:lanes", "psv:lanes", "bicycle:lanes", "width:lanes", "width"})
    if (way.tags.contains(key))
      log.add(Severity::Note, std::string("ignored_") + key, "tags that SUMO 1.15 does not read",
              way_name(way));
}

}  // namespace

std::optional<double> speed_limit(const std::string& value) {
  std::optional<double> least;
  for (const std::string& part : split(value, ";|")) {
    const std::optional<double> limit = one_speed_limit(part);
    if (!limit || *limit < kSlowest || *limit > kFastest) return std::nullopt;
    least = std::min(least.value_or(*limit), *limit);
  }
  return least;
}

void correct_tag_values(OsmMap& map, IssueLog& log) {
  for (MapWay& way : map.ways) {
    if (!way.tags.contains("highway")) continue;
    correct_layer(way, log);
    if (!is_car_way(way)) continue;
    note_unread(way, log);
    correct_oneway(way, log);
    for (const char* key :
         {"maxspeed", "maxspeed:forward", "maxspeed:backward", "maxspeed:type", "zone:maxspeed"})
      correct_speed(way, key, log);
    take_out_center_lane(way, log);
    correct_lanes(way, "lanes", is_one_way(way) ? kMostLanes : 2 * kMostLanes, log);
    for (const char* key : {"lanes:forward", "lanes:backward"})
      correct_lanes(way, key, kMostLanes, log);
    correct_lists(way, log);
  }
}

}  // namespace sumogamma::osm
