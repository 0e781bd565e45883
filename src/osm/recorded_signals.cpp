#include "osm/recorded_signals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "base/error.h"
#include "osm/geo_projection.h"
#include "osm/network_file.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {

namespace {

constexpr std::string_view kReplayed = "recorded";  // programID of what was recorded

constexpr double kAtLane = 2.5;  // of a signal's lane from that of the network [m]
constexpr double kAtExit =
    8.0;  // likewise of the lane that it leads to: it may be the next one [m]
constexpr double kOnJunction = 20.0;  // so far behind its lane's end a stop line may lie [m]
constexpr double kHolds = 86400;      // how long the last state is shown [s]

char letter_of(const std::string& state) {
  static const std::map<std::string, char> letters = {{"STOP_AND_REMAIN", 'r'},
                                                      {"STOP_THEN_PROCEED", 's'},
                                                      {"PRE_MOVEMENT", 'u'},
                                                      {"PERMISSIVE_MOVEMENT_ALLOWED", 'G'},
                                                      {"PROTECTED_MOVEMENT_ALLOWED", 'G'},
                                                      {"PERMISSIVE_CLEARANCE", 'y'},
                                                      {"PROTECTED_CLEARANCE", 'y'},
                                                      {"CAUTION_CONFLICTING_TRAFFIC", 'o'},
                                                      {"DARK", 'O'},
                                                      {"UNAVAILABLE", 'O'},
                                                      {"0", 'r'},
                                                      {"1", 'G'},
                                                      {"3", 'y'},
                                                      {"g", 'G'}};
  const auto found = letters.find(state);
  if (found != letters.end()) return found->second;
  return state.size() == 1 && std::string_view("rusGyoO").find(state[0]) != std::string_view::npos
             ? state[0]
             : '\0';
}

std::vector<std::string> split(const std::string& line, char by) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, by);) {
    const std::size_t begin = part.find_first_not_of(" \t\r\n"),
                      end = part.find_last_not_of(" \t\r\n");
    parts.push_back(begin == std::string::npos ? "" : part.substr(begin, end - begin + 1));
  }
  return parts;
}

/// Places of columns in a row.
struct Columns {
  std::size_t group = 0, state = 0, time = 0;
  bool frames = false;
};

Columns columns_of(const std::filesystem::path& file, const std::vector<std::string>& head) {
  const auto find = [&](const char* name) {
    return static_cast<std::size_t>(std::find(head.begin(), head.end(), name) - head.begin());
  };
  Columns columns{find("signal_group"), find("state"), find("time_s"), false};
  if (columns.time == head.size()) {
    columns.time = find("frame");
    columns.frames = true;
  }
  if (std::max({columns.group, columns.state, columns.time}) == head.size())
    throw Error(file.string() + ":1",
                "lacks a column, expected signal_group, state and time_s or frame");
  return columns;
}

/// Lanes of a network by edge and number, and its connections.
struct Ways {
  std::map<std::string, Polyline> lanes;
  std::vector<pugi::xml_node> links;  ///< from lanes that aren't within a junction, with a signal
};

Ways ways_of(const pugi::xml_node& net) {
  Ways ways;
  for (const pugi::xml_node edge : net.children("edge"))
    for (const pugi::xml_node lane : edge.children("lane"))
      ways.lanes[lane.attribute("id").value()] = Polyline(shape_of(lane));
  for (const pugi::xml_node link : net.children("connection"))
    if (link.attribute("tl")) ways.links.push_back(link);
  return ways;
}

/// The group whose way a link is; 0: none is known.
int group_of(const pugi::xml_node& link, const Ways& ways,
             const std::vector<SignalledWay>& signalled) {
  const auto lane = [&](const char* edge, const char* index) -> const Polyline& {
    return ways.lanes.at(
        fmt::format("{}_{}", link.attribute(edge).value(), link.attribute(index).value()));
  };
  const Polyline &from = lane("from", "fromLane"), &to = lane("to", "toLane");
  // a stop line may lie on what the network has for the junction
  const Polyline over(shape_of(link));
  int group = 0;
  double least = std::numeric_limits<double>::infinity();
  for (const SignalledWay& way : signalled) {
    double at_lane = from.project(way.from).distance, at_exit = to.project(way.to).distance;
    if (!over.empty()) {
      at_lane = std::min(at_lane, over.project(way.from, 0.0, kOnJunction).distance);
      at_exit = std::min(at_exit, over.project(way.to).distance);
    }
    if (at_lane > kAtLane || at_exit > kAtExit || at_lane + at_exit >= least) continue;
    least = at_lane + at_exit;
    group = way.group;
  }
  return group;
}

/// Who has to let whom go first at a junction, by link: SUMO's requests, whose bits count from the
/// right. Empty where they aren't told link by link.
std::vector<std::string> responses_at(const pugi::xml_node& net, const std::string& junction,
                                      std::size_t links) {
  std::vector<std::string> responses;
  for (const pugi::xml_node request :
       net.find_child_by_attribute("junction", "id", junction.c_str()).children("request"))
    responses.emplace_back(request.attribute("response").value());
  if (responses.size() != links) responses.clear();
  return responses;
}

/// What a signal shows at a time.
std::string state_at(double time, const std::vector<int>& groups, const SignalChanges& changes,
                     const std::vector<std::string>& responses) {
  std::string state;
  for (const int group : groups) {
    const auto shown = changes.find(group);
    if (shown == changes.end()) {
      state += 'O';
      continue;
    }
    auto change = shown->second.upper_bound(time + 1e-6);
    if (change != shown->second.begin()) --change;
    state += change->second;
  }
  const std::string told = state;
  for (std::size_t link = 0; link < responses.size(); ++link)
    for (std::size_t other = 0; other < responses.size(); ++other) {
      const std::string& bits = responses[link];
      const bool waits = other < bits.size() && bits[bits.size() - 1 - other] == '1';
      if (told[link] == 'G' && waits && (told[other] == 'G' || told[other] == 'y'))
        state[link] = 'g';
    }
  return state;
}

}  // namespace

SignalChanges read_signal_changes(const std::filesystem::path& file, double period) {
  std::ifstream stream(file);
  if (!stream) throw Error(file.string(), "can't be read");
  std::string line;
  std::getline(stream, line);
  const Columns columns = columns_of(file, split(line, ','));
  SignalChanges changes;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    const std::vector<std::string> parts = split(line, ',');
    if (parts.empty()) continue;
    if (parts.size() <= std::max({columns.group, columns.state, columns.time}))
      throw Error(fmt::format("{}:{}", file.string(), number), "lacks a value");
    char *group_end = nullptr, *time_end = nullptr;
    const long group = std::strtol(parts[columns.group].c_str(), &group_end, 10);
    const double time = std::strtod(parts[columns.time].c_str(), &time_end);
    const char letter = letter_of(parts[columns.state]);
    if (*group_end != '\0' || group < 1 || *time_end != '\0' || !std::isfinite(time) || !letter)
      throw Error(fmt::format("{}:{}", file.string(), number),
                  "expected a signal group from 1 on, a time and a state such as STOP_AND_REMAIN");
    changes[static_cast<int>(group)][columns.frames ? period * time : time] = letter;
  }
  if (changes.empty()) throw Error(file.string(), "has no changes of signals");
  return changes;
}

std::vector<SignalledWay> read_signal_map(const std::filesystem::path& file, GeoPoint origin) {
  pugi::xml_document document;
  if (!document.load_file(file.c_str()) || !document.child("kml"))
    throw Error(file.string(), "is no KML, expected a map of lanes and signal groups");
  const LaneletPlane plane(origin);
  struct Lane {
    Vec2 begin;
    std::vector<std::string> sinks, groups;
  };
  std::map<std::string, Lane> lanes;
  for (const pugi::xpath_node& found : document.select_nodes("//*[local-name()='Placemark']")) {
    const auto value = [&](const char* name) -> std::string {
      return found.node()
          .select_node(fmt::format(".//*[local-name()='Data'][@name='{}']", name).c_str())
          .node()
          .child_value("value");
    };
    std::istringstream coordinates(found.node().child("LineString").child_value("coordinates"));
    std::string first;
    coordinates >> first;
    const std::vector<std::string> place = split(first, ',');
    if (place.size() < 2 || value("Source").empty()) continue;
    const GeoPoint begin{std::strtod(place[0].c_str(), nullptr),
                         std::strtod(place[1].c_str(), nullptr)};
    lanes[value("Source")] = {plane.place_of(begin), split(value("Sink"), ','),
                              split(value("SignalGroup"), ',')};
  }
  std::vector<SignalledWay> ways;
  for (const auto& [name, lane] : lanes) {
    if (lane.sinks.size() != lane.groups.size())
      throw Error(file.string(), fmt::format("lane {} has {} sinks and {} signal groups", name,
                                             lane.sinks.size(), lane.groups.size()));
    for (std::size_t k = 0; k < lane.sinks.size(); ++k)
      if (lanes.contains(lane.sinks[k]))
        ways.push_back({std::atoi(lane.groups[k].c_str()), lane.begin, lanes[lane.sinks[k]].begin});
  }
  if (ways.empty()) throw Error(file.string(), "tells no signal group of a way over a junction");
  return ways;
}

std::size_t mark_signalled(const std::vector<SignalledWay>& ways, LaneletMap& map) {
  std::size_t marked = 0;
  for (Lanelet& lanelet : map.lanelets) {
    const bool is_at = std::any_of(ways.begin(), ways.end(), [&](const SignalledWay& way) {
      return lanelet.center.project(way.from).distance < kAtLane;
    });
    if (!is_at || lanelet.use == LaneletUse::Foot) continue;
    lanelet.signalled = true;
    ++marked;
  }
  return marked;
}

SignalReplay replay_signals(const std::filesystem::path& network,
                            const std::vector<SignalledWay>& ways, const SignalChanges& changes,
                            double begin) {
  pugi::xml_document document;
  if (!document.load_file(network.c_str())) throw Error(network.string(), "can't be read");
  pugi::xml_node net = document.child("net");
  const Ways found = ways_of(net);
  std::set<double> times{0.0};
  for (const auto& [group, shown] : changes)
    for (const auto& [time, letter] : shown)
      if (time > begin) times.insert(std::round(10.0 * (time - begin)) / 10.0);
  SignalReplay replay;
  for (pugi::xml_node logic : net.children("tlLogic")) {
    const std::string id = logic.attribute("id").value();
    std::vector<int> groups;
    for (const pugi::xml_node& link : found.links) {
      if (link.attribute("tl").value() != id) continue;
      const auto index = static_cast<std::size_t>(link.attribute("linkIndex").as_int());
      groups.resize(std::max(groups.size(), index + 1));
      groups[index] = group_of(link, found, ways);
    }
    replay.links += groups.size();
    replay.unknown += static_cast<std::size_t>(std::count(groups.begin(), groups.end(), 0));
    const std::vector<std::string> responses = responses_at(net, id, groups.size());
    logic.remove_children();
    logic.attribute("type").set_value("static");
    logic.attribute("programID").set_value(kReplayed.data());
    logic.attribute("offset").set_value("0");
    for (auto time = times.begin(); time != times.end(); ++time) {
      pugi::xml_node phase = logic.append_child("phase");
      const double duration = std::next(time) == times.end() ? kHolds : *std::next(time) - *time;
      phase.append_attribute("duration") = fmt::format("{:.2f}", duration).c_str();
      phase.append_attribute("state") = state_at(*time + begin, groups, changes, responses).c_str();
    }
    replay.phases = times.size();
    ++replay.signals;
  }
  save_xml(document, network);
  return replay;
}

std::set<std::string> replayed_signals(const std::filesystem::path& network) {
  const std::string content = read_maybe_gzip(network);
  pugi::xml_document document;
  if (!document.load_buffer(content.data(), content.size()))
    throw Error(network.string(), "can't be read as XML, expected a SUMO network");
  std::set<std::string> ids;
  for (const pugi::xml_node logic : document.child("net").children("tlLogic"))
    if (logic.attribute("programID").value() == kReplayed)
      ids.insert(logic.attribute("id").value());
  return ids;
}

}  // namespace sumogamma::osm
