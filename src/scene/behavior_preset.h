#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "scene/agent_type.h"

namespace sumogamma {

/// Named values of everything in Compliance, of the critical gaps, and of headways, standing gaps
/// and acceleration, for all types at once.
enum class BehaviorPreset : std::uint8_t {
  Compliant,  ///< keeps every rule
  Observed,   ///< as recorded on real roads where there is a record; docs/scenario.md has the table
  Interaction,  ///< drivers of cars as in the recordings of INTERACTION (docs/scenario.md)
  Unregulated,  ///< nobody keeps a rule of the road, and all are slow (keeps_rules())
};

/// Word for a preset as in scenario.toml.
std::string_view name_of(BehaviorPreset preset);

/// All of them, and their words.
inline constexpr std::array kBehaviorPresets{BehaviorPreset::Compliant, BehaviorPreset::Observed,
                                             BehaviorPreset::Interaction,
                                             BehaviorPreset::Unregulated};
std::vector<std::string> preset_names();

/// Do signals, right of way, leaders and lanes count? Without them everybody makes for its way
/// alone and avoids the others.
inline bool keeps_rules(BehaviorPreset preset) { return preset != BehaviorPreset::Unregulated; }

/// Sets what a preset says of every type. Types that it doesn't know keep what they have.
void apply_preset(BehaviorPreset preset, AgentTypeTable& types);

}  // namespace sumogamma
