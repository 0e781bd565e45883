#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "sumo/scenario_input.h"
#include "sumo/sumo_outputs.h"

namespace sumogamma {

/// Things of one kind in one file that a scenario asks for and a run doesn't do.
struct NotFollowed {
  std::string what;   ///< "rerouter", "stop speed", "option random"
  std::string first;  ///< id of the first of them; may be empty
  std::string file;   ///< name without its folder
  std::uint64_t count = 0;
  std::string why;  ///< may be empty
};

/// What a scenario's files hold, as far as a run has to know it before it starts.
struct ScenarioInventory {
  std::vector<NotFollowed> not_followed;  ///< by file, then by kind, in the order of the files
  std::set<std::string> types;            ///< ids of vTypes
  std::set<std::string> ids;              ///< of vehicles, trips, people, containers
  std::set<std::string> flows;  ///< ids of flows, whose vehicles are called ID.0, ID.1, ...
  /// Numbers given as departSpeed, by id of vehicle, trip or flow [m/s].
  std::unordered_map<std::string, double> depart_speeds;
  std::vector<std::string> rerouter_edges;  ///< on which rerouters act
  std::vector<std::string> sign_lanes;      ///< of variable speed signs
  std::vector<AskedOutput> outputs;         ///< that sumo-gamma writes, in the order of the files
  std::vector<std::filesystem::path> output_folders;  ///< in which SUMO writes files
  bool switches_programs = false;  ///< a WAUT puts other programs in charge of signals
  bool complete = true;  ///< all demand was read: a loaded state or calibrators may bring others
};

/// Goes through the route and additional files, what they include, and the configuration, by
/// compatibility_table(). With `plain` (SUMO drives everybody) only what concerns the run itself is
/// listed. Ids are gathered where `with_ids`. A file that is no XML is left to SUMO's own words.
/// Throws Error naming file and element, or option, and what to do, for an output that would be
/// wrong for who GAMMA drives.
ScenarioInventory take_inventory(const ScenarioInput& input, bool plain, bool with_ids);

/// "rerouter r1 in x.add.xml: not followed (who GAMMA drives keeps its route)"; of several "37
/// e1Detector in det.add.xml: ...".
std::string describe(const NotFollowed& item);

/// The flow that an agent of this id would be of; empty where its id has no number.
std::string flow_of(const std::string& id);

/// Does an agent of this id come out of the demand?
bool has_id(const ScenarioInventory& inventory, const std::string& id);

}  // namespace sumogamma
