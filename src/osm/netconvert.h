#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

struct NetconvertRequest {
  std::filesystem::path prepared;  ///< OSM XML
  std::filesystem::path network;   ///< to write
  std::filesystem::path log;       ///< netconvert's own words, appended
  std::string projection;
  bool left_hand = false;
  bool layers = false;  ///< give bridges and tunnels a height of 5 m a layer, so that traffic on
                        ///< them is kept apart
  double time_limit = 1800.0;  ///< [s]
  std::function<bool()> should_stop;
};

/// Folder of SUMO's data: $SUMO_HOME where it is set and holds typemaps, else /usr/share/sumo.
/// Throws Error where neither does.
std::filesystem::path sumo_home();

/// Runs netconvert on a prepared map with the option set that docs/import.md explains. Returns its
/// command line. Throws Error with netconvert's own message where it is missing, fails or crashes;
/// returns an empty command where should_stop ended it.
std::vector<std::string> run_netconvert(const NetconvertRequest& request);

/// Second pass that only marks roundabouts which netconvert 1.15 does not see (it takes
/// junction=roundabout for a one-way road and guesses from geometry). Each is a ring of edges in
/// driving order. Same errors.
std::vector<std::string> mark_roundabouts(const NetconvertRequest& request,
                                          const std::vector<std::vector<std::string>>& rings);

/// netconvert's messages by kind: ids and numbers replaced, then counted.
std::map<std::string, long> count_message_kinds(const std::string& log_text);

}  // namespace sumogamma::osm
