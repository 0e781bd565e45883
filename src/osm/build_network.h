#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "osm/osm_map.h"
#include "osm/public_transport.h"
#include "osm/repair_names.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Which side traffic keeps to.
enum class Side : std::uint8_t { Auto, Left, Right };

struct BuildRequest {
  std::filesystem::path map;
  std::optional<GeoBox> bbox;  ///< cut to this; without it the bounds that the file declares
  Side side = Side::Auto;      ///< Auto: from the place
  RepairSet without;           ///< repairs that are switched off
  std::filesystem::path
      folder;  ///< existing; net.net.xml, obstacles.add.xml and netconvert.log are written into it
  std::filesystem::path work;  ///< existing; for files that do not stay
  std::function<bool()> should_stop = [] { return false; };
  std::function<void(const std::string&)> progress = [](const std::string&) {};
};

struct BuildResult {
  bool stopped = false;
  GeoBox box;
  bool box_from_file = false;  ///< the extract said what it covers
  bool left_hand = false;
  std::string side_reason;  ///< "region Japan", "asked for", ...
  std::string projection;
  std::map<std::string, long> read;     ///< what the extract held
  std::map<std::string, double> built;  ///< network_facts(), and overlaps before edges moved apart
  std::map<std::string, long> obstacles;  ///< what became of buildings, walls and trees
  RepairSet without;                      ///< repairs that were switched off
  std::map<std::string, long> netconvert_messages;
  std::vector<std::string> command;  ///< netconvert's
  IssueLog log;
  RoadNetwork road;           ///< as written
  PublicTransport transport;  ///< lines and stops on it
  LineReport lines;
};

/// Reads and checks the extract, cuts and repairs it, has netconvert build the network, marks
/// roundabouts, and writes the obstacles in the network's coordinates. Throws Error: see read_osm()
/// and run_netconvert(), and where the box lies outside the extract or nothing in it is a road.
BuildResult build_network(const BuildRequest& request);

}  // namespace sumogamma::osm
