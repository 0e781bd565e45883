#pragma once

#include <memory>
#include <optional>

#include "sumo/entry.h"
#include "sumo/known_agents.h"

namespace sumogamma {

/// An agent with everything that it enters the scene with.
struct Entrant {
  AgentState state;
  std::shared_ptr<const Path> path;
  double height = 0;  ///< of the ground there [m]
};

/// Somebody who waits, as it would enter now: from the lane that SUMO chose, or one beside that.
/// Nothing where there is no room. `id`: its id then, which with `seed` decides its habits.
std::optional<Entrant> find_room(const EntryView& view, PendingAgent& pending, AgentId id,
                                 std::uint64_t seed);

}  // namespace sumogamma
