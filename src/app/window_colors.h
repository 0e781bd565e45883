#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "model/gamma_velocity.h"
#include "scene/road_context.h"
#include "simulation/simulation.h"
#include "sumo/backend.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

using WindowColor = std::array<std::uint8_t, 3>;

/// The color of who GAMMA drives, by what binds it: grey free, vermilion a signal, purple who has
/// the right of way, blue the leader, brown a stop or lane change, green others to keep clear of,
/// orange walls and edges, dark blue its own body, red the stopping guard.
WindowColor window_color(LimitReason reason, const Binding& binding);
/// SUMO's own default, for who is its own again.
inline constexpr WindowColor kSumoColor{255, 255, 0};

/// Paints agents in SUMO's window: what has changed, a tick later.
class WindowColors {
 public:
  WindowColors(const Simulation& sim, const SumoWorld& world, SumoBackend& backend)
      : sim_(sim), world_(world), backend_(backend) {}
  /// After a tick, when its bindings are known; talks to nobody.
  void note();
  /// Tells SUMO; not while that makes its step.
  void paint();

 private:
  const Simulation& sim_;
  const SumoWorld& world_;
  SumoBackend& backend_;
  std::vector<WindowColor> shown_;                            ///< by id; black: as it came
  std::vector<std::pair<std::size_t, WindowColor>> changed_;  ///< ids
};

}  // namespace sumogamma
