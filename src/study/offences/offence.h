#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/scene.h"

namespace sumogamma {

/// Counts of one type, or of everybody.
struct RuleCounts {
  std::uint64_t red_light_crossings =
      0;  ///< stop lines or crossings entered while their link showed red
  std::uint64_t signal_crossings =
      0;  ///< all signalled stop lines or crossings entered, whatever they showed
  std::uint64_t red_lights_met =
      0;  ///< encounters of an agent that could go with a red light: the base of a rate of running
  std::uint64_t mid_block_crossings = 0;  ///< roads crossed on foot between junctions
  double wrong_way_s = 0;                 ///< against every lane of the place
  double overtaking_s = 0;                ///< likewise, but past somebody narrow: no offence
  double off_road_s = 0;                  ///< on no lane and no junction
  double sidewalk_by_vehicle_s = 0;       ///< motor vehicles on ground for people on foot
};

/// Keys of `rules` in results.json.
struct RuleResult {
  RuleCounts all;
  std::map<std::string, RuleCounts> by_type;
};

enum class Offence : std::uint8_t { RedLight, WrongWay, OffRoad, Sidewalk };

/// One agent's offence from its beginning to its end, for offences.csv: where to look when a count
/// surprises.
struct OffenceSpan {
  Offence kind = Offence::RedLight;
  AgentId id;
  AgentTypeId type{};
  Vec2 position = Vec2::Zero();  ///< at its beginning [m]
  double since = 0;              ///< [s]
  double duration = 0;           ///< 0 for a red light [s]
};

/// A red light that was run: for the replay.
struct RedLightEvent {
  double time = 0;
  AgentId id;
  Vec2 position = Vec2::Zero();
  ConnectionId connection = kNoConnection;
};

}  // namespace sumogamma
