#include "io/scenario_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <pugixml.hpp>
#include <sstream>

#include "base/error.h"
#include "base/number_text.h"
#include "io/output_file.h"
#include "io/public_transport_file.h"

namespace sumogamma {
namespace {

std::string plain(double value) {
  // a TOML float needs a point
  const std::string result = number_text(value);
  return result.find_first_of(".e") == std::string::npos ? result + ".0" : result;
}

std::string toml_string(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) < 0x20)
      continue;  // a control character in a file name is not worth keeping
    quoted += c;
  }
  return quoted + "\"";
}

std::string list_text(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + plain(value);
  return "[" + text + "]";
}

/// [demand], where something was asked for.
std::string demand_text(const DemandSettings& demand) {
  std::string text, shares;
  if (demand.agents > 0) text += fmt::format("agents = {}\n", demand.agents);
  if (!demand.profile.empty()) text += "profile = " + list_text(demand.profile) + "\n";
  if (!demand.window.empty())
    text += "window = " + list_text(demand.window) + "  # W, S, E, N: agents are alive in there\n";
  if (!demand.od.empty()) text += "od = " + toml_string(demand.od) + "\n";
  if (!demand.counts.empty()) text += "counts = " + toml_string(demand.counts) + "\n";
  if (demand.public_transport) text += "public_transport = true\n";
  if (demand.headway > 0)
    text += "headway = " + plain(demand.headway) + "  # [s], of lines without one in the map\n";
  if (demand.riders >= 0) text += "riders = " + plain(demand.riders) + "  # an hour\n";
  for (const DemandShare& share : demand.shares)
    if (share.share > 0) shares += share.type + " = " + plain(share.share) + "\n";
  if (!shares.empty()) text += "[demand.shares]\n" + shares;
  return text.empty() ? "" : "[demand]  # drawn anew by sumo-gamma demand\n" + text + "\n";
}

/// Puts a value behind `key =` in [run], where it stands there.
void replace_in_run(std::string& toml, const std::string& key, const std::string& value) {
  const std::size_t run = toml.find("[run]");
  if (run == std::string::npos) return;
  const std::size_t end = std::min(toml.find("\n[", run), toml.size());
  const std::size_t line = toml.find("\n" + key + " = ", run);
  if (line >= end) return;
  const std::size_t begin = line + key.size() + 4;
  toml.replace(begin, toml.find_first_of(" \n", begin) - begin, value);
}

std::string toml_text(const ScenarioFiles& scenario, const AgentTypeTable& types) {
  const std::string box = fmt::format("{:.7f},{:.7f},{:.7f},{:.7f}", scenario.west, scenario.south,
                                      scenario.east, scenario.north);
  std::ostringstream text;
  text << "# Made by sumo-gamma import; every key has a default, and run --set KEY=VALUE overrides "
          "any.\n"
       << "[scenario]\n"
       << "name = " << toml_string(scenario.name) << "\n"
       << "map = " << toml_string(scenario.map) << "\n"
       << "bbox = \"" << box << "\"  # W,S,E,N; traffic keeps "
       << (scenario.left_hand ? "left" : "right") << "\n"
       << "attribution = \"(c) OpenStreetMap contributors, ODbL 1.0\"\n\n"
       << "[run]\n"
       << "agents = " << scenario.agents << "  # to be alive\n"
       << "on_foot = " << plain(scenario.on_foot)
       << "  # share of people on foot among them, in this demand\n"
       << "duration = " << plain(scenario.duration) << "  # [s], for which demand was written\n"
       << "step = 0.05  # [s]\n\n"
       << demand_text(scenario.demand)
       << (scenario.turn_on_red
               ? "[traffic]\nturn_on_red = true  # after a halt, where no sign forbids it\n\n"
               : "")
       << "[behavior]\n"
       << "preset = \"compliant\"  # keeps every rule; or \"observed\"\n\n"
       << "# Any field of a type may be overridden; what is built in, of some:\n";
  for (const AgentType& type : types)
    text << "# [types." << type.name << "]\n"
         << "# preferred_speed = " << plain(type.preferred_speed) << "  # [m/s]\n"
         << "# max_acceleration = " << plain(type.max_acceleration) << "  # [m/s^2]\n"
         << "# horizon = " << plain(type.horizon) << "  # tau [s]\n";
  return text.str();
}

std::string with_stops_file(const std::string& additional) {
  return additional + "," + kPublicTransportFile;
}

void write_sumocfg(const std::filesystem::path& file, const ScenarioFiles& scenario) {
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("configuration");
  auto section = [&](const char* name,
                     std::initializer_list<std::pair<const char*, std::string>> options) {
    pugi::xml_node node = root.append_child(name);
    for (const auto& [key, value] : options)
      node.append_child(key).append_attribute("value") = value.c_str();
  };
  // for each ghost that it is told of SUMO looks through all departures that it has read ahead:
  // these stand in order of time, so that few will do
  section("input", {{"net-file", "net.net.xml"},
                    {"route-files", "demand.rou.xml"},
                    {"additional-files",
                     scenario.stops ? with_stops_file("obstacles.add.xml") : "obstacles.add.xml"},
                    {"route-steps", "20"}});
  section("time", {{"begin", "0"}, {"end", plain(scenario.duration)}});
  section("report",
          {{"xml-validation", "never"}, {"xml-validation.net", "never"}, {"no-step-log", "true"}});
  if (!document.save_file(file.c_str(), "  "))
    throw Error(file.string(), "cannot be written: is the disk full?");
}

nlohmann::ordered_json transport_report(const TransportDemand& transport) {
  nlohmann::ordered_json json;
  json["parts_of_lines"] = transport.parts;
  json["buses"] = transport.buses;
  json["buses_on_the_way"] = transport.initial;
  json["buses_alive"] = transport.alive;
  json["riders"] = transport.riders;
  json["problem"] = transport.problem;
  json["left_out"] = nlohmann::ordered_json::array();
  for (const auto& [part, why] : transport.left_out)
    json["left_out"].push_back({{"part", part}, {"why", why}});
  return json;
}

}  // namespace

void write_scenario_files(const std::filesystem::path& folder, const ScenarioFiles& scenario,
                          const AgentTypeTable& types) {
  write_sumocfg(folder / "scenario.sumocfg", scenario);
  write_file(folder / "scenario.toml", toml_text(scenario, types));
}

std::string with_stops(const std::string& sumocfg, bool stops, const std::string& file) {
  pugi::xml_document document;
  if (!document.load_buffer(sumocfg.data(), sumocfg.size(), pugi::parse_full))
    throw Error(file, "is no readable XML");
  pugi::xml_attribute files = document.select_node("//additional-files/@value").attribute();
  if (!files) throw Error(file, "has no <additional-files>, among which the stops would be");
  const std::string before = files.value(), name = kPublicTransportFile;
  const std::size_t at = before.find(name);
  if ((at != std::string::npos) == stops) return sumocfg;
  if (stops)
    files = before.empty() ? name.c_str() : with_stops_file(before).c_str();
  else
    files = std::string(before).erase(at > 0 ? at - 1 : at, name.size() + 1).c_str();
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

std::string with_agents_alive(std::string toml, long agents, double on_foot) {
  replace_in_run(toml, "agents", std::to_string(agents));
  replace_in_run(toml, "on_foot", plain(std::round(1000.0 * on_foot) / 1000.0));
  return toml;
}

nlohmann::ordered_json demand_report(const DemandReport& report, const DemandRequest& request) {
  nlohmann::ordered_json json;
  json["agents"] = request.agents;
  json["duration"] = request.duration;
  json["seed"] = request.seed;
  json["departures"] = report.departures;
  json["departures_on_the_way"] = report.initial;
  json["busiest_lane"] = {{"lane", report.busiest_lane}, {"load", report.busiest_load}};
  json["agents_alive"] = report.agents;
  for (const CountFit& fit : report.counts)
    json["counts"].push_back({{"edge", fit.count.edge},
                              {"to", fit.count.to},
                              {"per_hour", fit.count.per_hour},
                              {"by_the_trips", fit.per_hour},
                              {"geh", fit.geh}});
  if (request.transport) json["public_transport"] = transport_report(report.transport);
  for (const DemandByType& type : report.types)
    json["by_type"][type.type] = {{"share", type.share},
                                  {"trips_asked", type.trips_drawn},
                                  {"trips_kept", type.trips_routable},
                                  {"departures", type.departures},
                                  {"mean_length", type.mean_length},
                                  {"mean_duration", type.mean_duration},
                                  {"left_out", type.problem}};
  return json;
}

}  // namespace sumogamma
