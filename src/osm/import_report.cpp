#include "osm/import_report.h"

#include "osm/osm_reader.h"

namespace sumogamma::osm {
namespace {

/// What became of the map's lines; null where it has none.
nlohmann::ordered_json lines_report(const BuildResult& result) {
  const LineReport& lines = result.lines;
  nlohmann::ordered_json report;
  if (lines.found.empty() && lines.others.empty()) return report;
  report["lines"] = lines.found;
  report["not_on_roads"] = lines.others;
  report["driven"] = lines.driven;
  report["parts"] = result.transport.parts.size();
  report["stops"] = result.transport.stops.size();
  report["at_all_stops_of_their_way"] = lines.at_all_stops;
  report["left_out"] = nlohmann::ordered_json::array();
  for (const auto& [line, why] : lines.left_out)
    report["left_out"].push_back({{"line", line}, {"why", why}});
  return report;
}

}  // namespace

nlohmann::ordered_json import_report(const BuildResult& result, const std::string& map_name) {
  nlohmann::ordered_json report;
  report["map"] = map_name;
  report["attribution"] = "(c) OpenStreetMap contributors, Open Database License 1.0";
  report["libosmium"] = osmium_version();
  report["box"] = {{"west", result.box.west},
                   {"south", result.box.south},
                   {"east", result.box.east},
                   {"north", result.box.north},
                   {"from", result.box_from_file ? "file" : "roads or --bbox"}};
  report["left_hand"] = result.left_hand;
  report["left_hand_reason"] = result.side_reason;
  report["projection"] = result.projection;
  report["read"] = result.read;
  report["built"] = result.built;
  report["obstacles"] = result.obstacles;
  if (!result.without.empty()) report["repairs_left_out"] = result.without;
  report["issues"] = nlohmann::ordered_json::array();
  for (const auto& [kind, issue] : result.log.issues())
    report["issues"].push_back(
        {{"severity", issue.severity == Severity::Warning ? "warning" : "note"},
         {"kind", kind},
         {"what", issue.what},
         {"count", issue.count},
         {"examples", issue.examples}});
  if (const auto lines = lines_report(result); !lines.is_null()) report["public_transport"] = lines;
  report["netconvert_messages"] = result.netconvert_messages;
  report["netconvert_command"] = result.command;
  return report;
}

}  // namespace sumogamma::osm
