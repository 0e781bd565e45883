#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "demand/demand.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// What the two scenario files of an imported folder say.
struct ScenarioFiles {
  std::string name;                                 ///< of the scenario
  std::string map;                                  ///< file name of the extract
  double west = 0, south = 0, east = 0, north = 0;  ///< the place [deg]
  bool left_hand = false;
  bool turn_on_red = false;
  long agents = 100;
  double on_foot = 0;        ///< share of people on foot among them
  double duration = 3600.0;  ///< [s]
  DemandSettings demand;     ///< beyond `agents`
  bool stops = false;        ///< SUMO reads kPublicTransportFile
};

/// Writes scenario.sumocfg (for SUMO, and for `run`) and scenario.toml (for `run`). Throws Error
/// naming the file.
void write_scenario_files(const std::filesystem::path& folder, const ScenarioFiles& scenario,
                          const AgentTypeTable& types);

/// A .sumocfg with or without kPublicTransportFile among its additional files, everything else in
/// it as it was; the very text where nothing changes. Throws Error naming `file` where it is no XML
/// or has no additional files.
std::string with_stops(const std::string& sumocfg, bool stops, const std::string& file);

/// A scenario.toml with other numbers in [run] agents and on_foot, every other byte as it was.
std::string with_agents_alive(std::string toml, long agents, double on_foot);

/// The demand's part of import.json.
nlohmann::ordered_json demand_report(const DemandReport& report, const DemandRequest& request);

}  // namespace sumogamma
