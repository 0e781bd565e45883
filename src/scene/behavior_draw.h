#pragma once

#include <cstdint>

#include "scene/agent_type.h"
#include "scene/behavior.h"

namespace sumogamma {

/// Behaviour drawn for one agent (responsibility, attention; intention is its path): a pure
/// function of seed and id.
BehaviorState draw_behavior(const AgentType& type, std::uint64_t seed, std::uint32_t id);

}  // namespace sumogamma
