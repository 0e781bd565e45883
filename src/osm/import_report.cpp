#include "osm/import_report.h"

#include "osm/osm_reader.h"

namespace sumogamma::osm {

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
  report["netconvert_messages"] = result.netconvert_messages;
  report["netconvert_command"] = result.command;
  return report;
}

}  // namespace sumogamma::osm
