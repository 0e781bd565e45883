#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "osm/lanelet_map.h"

namespace sumogamma::osm {

/// A network in SUMO's plain XML, as netconvert reads it.
struct PlainNetwork {
  std::string nodes, edges, connections;           ///< whole files
  std::string nodes_with_outlines;                 ///< `nodes`, with junctions' outlines
  std::map<std::string, std::vector<Vec2>> lanes;  ///< centre lines, by SUMO's id
  std::size_t edge_count = 0, lane_count = 0, junction_count = 0, turn_count = 0;
  std::size_t without_a_rule = 0;  ///< junctions of several arms of which the map tells no rule
  std::size_t cut = 0;             ///< lanelets cut in two
  std::size_t prolonged = 0;       ///< lanes that go on beyond the map's end
};

/// Lanelets as roads (lanelet_graph_of). Those on a junction, together with all that they meet, are
/// one, and the ways over it are connections of their shape. All others are lanes, those between
/// common borders of one edge, with the lanelets' own centre lines. People's lanelets are left out.
/// Throws Error naming the file where no network can be made of it.
PlainNetwork plain_network_of(const LaneletMap& map, double beyond,
                              const std::filesystem::path& file);

/// Writes the plain files `name`.nod.xml, .edg.xml, .con.xml and the network `name`.net.xml into a
/// folder, with netconvert, whose messages go to netconvert.log there. Lanes and ways over
/// junctions of the network are where the lanelets are: netconvert shortens lanes at junctions for
/// an outline of its own. Throws Error with netconvert's message where it fails.
void write_lanelet_network(const PlainNetwork& plain, const std::filesystem::path& folder,
                           const std::string& name);

}  // namespace sumogamma::osm
