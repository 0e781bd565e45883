#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "osm/osm_map.h"
#include "osm/repairs/carriageways_apart.h"
#include "osm/repairs/swallowed_roads.h"

namespace sumogamma::osm {

struct NetconvertRequest {
  std::filesystem::path
      folder;  ///< netconvert runs here: no path of this machine gets into the network
  std::string prepared = "work/prepared.osm";  ///< OSM XML, within the folder
  std::string road_types;  ///< file of write_road_types(), within the folder; "" for none
  std::string network = "net.net.xml";         ///< to write
  std::string log = "netconvert.log";          ///< netconvert's own words, appended
  std::string joined = "work/joined.nod.xml";  ///< to write: what it joined by itself
  std::string projection;
  bool left_hand = false;
  bool layers = false;  ///< give bridges and tunnels a height of 5 m a layer, so that traffic on
                        ///< them is kept apart
  /// To make one junction each; nothing: netconvert joins as it sees fit.
  std::optional<std::vector<NodeGroup>> joins;
  double time_limit = 1800.0;  ///< [s]
  std::function<bool()> should_stop;
};

/// Folder of SUMO's data: $SUMO_HOME where it is set and holds typemaps, else /usr/share/sumo.
/// Throws Error where neither does.
std::filesystem::path sumo_home();

/// The files of road types that netconvert gets, of SUMO's own, later ones over earlier ones.
std::vector<std::filesystem::path> typemaps();

/// Runs netconvert on a prepared map with the option set that docs/import.md explains. Returns its
/// command line. `before` is the network as it stands, which tells places of junctions to join;
/// none where there is nothing to join. Throws Error with netconvert's own message where it is
/// missing, fails or crashes; returns an empty command where should_stop ended it.
std::vector<std::string> run_netconvert(const NetconvertRequest& request,
                                        const pugi::xml_node& before = {});

/// Runs netconvert on plain XML within the folder (`name`.nod.xml, .edg.xml, .con.xml), which is
/// kept as it stands: no joining, guessing or turning round. Same returns and errors as
/// run_netconvert().
std::vector<std::string> run_netconvert_on_plain(const NetconvertRequest& request,
                                                 const std::string& name);

/// The groups of nodes in a file of joins, as netconvert writes it to request.joined. Throws Error
/// where it is none.
std::vector<NodeGroup> read_joins(const std::filesystem::path& file);

/// Who goes from one edge to another at a junction, and who waits for it there.
struct Prohibition {
  std::string from, to;              ///< of who goes first
  std::string waits_from, waits_to;  ///< of who waits
  auto operator<=>(const Prohibition&) const = default;
};

/// A turn over a junction, from lane to lane.
struct Turn {
  std::string from, to;  ///< edges
  int from_lane = 0, to_lane = 0;
  auto operator<=>(const Turn&) const = default;
};

/// What netconvert 1.15 does not take from OSM, for a second pass over the finished network.
struct NetworkPatch {
  /// Roundabouts by tag that it did not recognise (it guesses them from geometry): edges in driving
  /// order.
  std::vector<std::vector<std::string>> roundabouts;
  /// Junctions with another right of way, by id: SUMO's type "priority_stop" or "allway_stop" where
  /// traffic must stop, "left_before_right" at mini-roundabouts.
  std::map<std::string, std::string> junction_types;
  std::vector<Prohibition> prohibitions;
  std::vector<Turn> refused;  ///< turns to leave out

  /// Lanes of different edges moved off each other.
  CarriagewayPlan carriageways;

  bool empty() const {
    return roundabouts.empty() && junction_types.empty() && prohibitions.empty() &&
           refused.empty() && carriageways.empty();
  }
};

/// Applies the patch to request.network, whose elements are `net`. Same returns and errors as
/// run_netconvert().
std::vector<std::string> patch_network(const NetconvertRequest& request, const pugi::xml_node& net,
                                       const NetworkPatch& patch);

/// netconvert's messages by kind: ids and numbers replaced, then counted.
std::map<std::string, long> count_message_kinds(const std::string& log_text);

}  // namespace sumogamma::osm
