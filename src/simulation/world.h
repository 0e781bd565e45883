#pragma once

#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// Where agents come from and go to: the one virtual interface of a run (SUMO, or nothing at all).
class World {
 public:
  virtual ~World() = default;
  /// Brings the scene up to date before a tick: newcomers appended, leavers removed, signals,
  /// agents that others drive.
  virtual void observe(Scene& scene, RoadState& road) = 0;
  /// Takes over the new state after a tick and advances its own time by one step.
  virtual void advance(const Scene& scene) = 0;
  /// True once nothing will come any more.
  virtual bool finished() const = 0;
};

}  // namespace sumogamma
