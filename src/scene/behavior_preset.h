#pragma once

#include <cstdint>
#include <string_view>

#include "scene/agent_type.h"

namespace sumogamma {

/// Named values of everything in Compliance, and of the critical gaps, for all types at once.
enum class BehaviorPreset : std::uint8_t {
  Compliant,  ///< keeps every rule
  Observed,   ///< as recorded on real roads where there is a record; docs/scenario.md has the table
};

/// Word for a preset as in scenario.toml.
std::string_view name_of(BehaviorPreset preset);

/// Sets what a preset says of every type. Types that it doesn't know keep what they have.
void apply_preset(BehaviorPreset preset, AgentTypeTable& types);

}  // namespace sumogamma
