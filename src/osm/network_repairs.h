#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "osm/netconvert.h"
#include "osm/network_file.h"
#include "osm/osm_map.h"
#include "osm/repair_names.h"

namespace sumogamma::osm {

/// What a repair of a network looks at.
struct NetworkView {
  const OsmMap& map;
  const NetworkFile& network;
  const std::vector<NodeGroup>& joins;  ///< nodes that are one junction each
  int round = 0;  ///< how often this repair has looked at this conversion of the map before
};

/// When repairs are asked: the first stage that wants something changed gets it, and then all are
/// asked again.
enum class Stage : std::uint8_t { Joined, Junctions, Roads, Turns, Signals };

/// What netconvert is to do otherwise.
struct NetworkChanges {
  std::vector<NodeGroup> joins;  ///< to make one junction each
  std::vector<NodeGroup> apart;  ///< of those that are one: to leave as the map has them
  NetworkPatch patch;            ///< of the network as it stands
  Stage asked_by = Stage::Joined;

  /// Joins are made where the map is converted, patches where the network is.
  bool of_map() const { return !joins.empty() || !apart.empty(); }
  bool empty() const { return !of_map() && patch.empty(); }
};

/// One thing that netconvert does not read or makes badly, found in what it made and mended by
/// running it again.
struct NetworkRepair {
  RepairName name;
  Stage stage;
  int rounds;  ///< how often it may look at one conversion of the map
  void (*find)(const NetworkView&, NetworkChanges&, IssueLog&);
};
std::span<const NetworkRepair> network_repairs();

/// One thing that is mended in the finished network's file; true where it changed.
struct FileRepair {
  RepairName name;
  bool (*mend)(NetworkFile&, IssueLog&);
};
std::span<const FileRepair> file_repairs();

/// What made a network.
struct Conversion {
  std::vector<std::string> command;      ///< netconvert's, of the last conversion of the map
  std::map<std::string, double> before;  ///< metres of overlapping lanes before edges moved apart
};

/// Has netconvert build the network of a prepared map, and again until no repair that is switched
/// on wants anything else, but no more than 16 times; then mends the file. The network as it stands
/// in `netconvert.network`, or nothing where it was stopped. Errors as run_netconvert().
std::optional<NetworkFile> make_network(const OsmMap& map, NetconvertRequest netconvert,
                                        const RepairSet& off, Conversion& conversion,
                                        IssueLog& log);

}  // namespace sumogamma::osm
