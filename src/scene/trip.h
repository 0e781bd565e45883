#pragma once

#include "scene/scene.h"

namespace sumogamma {

/// From entering the scene to the destination.
struct FinishedTrip {
  AgentId id;
  AgentTypeId type{};
  double departed = 0, arrived = 0;  ///< [s]
};

}  // namespace sumogamma
