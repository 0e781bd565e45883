#pragma once

#include <string>
#include <vector>

namespace sumogamma {

/// Share of one agent type among the agents alive.
struct DemandShare {
  std::string type;
  double share = 0;
};

/// What is asked of a demand: [demand] of scenario.toml (docs/scenario.md).
struct DemandSettings {
  int agents = 0;                   ///< alive; 0: as [run] has it
  std::vector<DemandShare> shares;  ///< by type; none above 0: default_demand_mix()
  std::vector<double> profile;      ///< how busy equal parts of the duration are
  std::vector<double> window;       ///< W, S, E, N: `agents` are alive in there [degrees]
  std::string od, counts;           ///< files
  bool public_transport = false;    ///< buses on the map's lines, and their riders
  double headway = 0;               ///< of lines of which the map tells none [s]; 0: kUsualHeadway
  double riders = -1;               ///< an hour, on all lines; negative: as many as suit the buses
};

}  // namespace sumogamma
