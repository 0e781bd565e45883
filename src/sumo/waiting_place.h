#pragma once

#include <cstddef>

#include "model/model.h"
#include "scene/scene.h"

namespace sumogamma {

/// Moves somebody who waits on a pavement or footway, for a bus, say, towards the kerb (on a way
/// without one to its right), at 0.5 m/s over `dt` [s], and along it where others stand there
/// already: in the middle they would hold up whoever passes. From a vehicle that comes within half
/// a metre it steps back until that has gone: a bus that draws in, or whose corner swings over the
/// kerb, would not get by otherwise. Keeps its body on the lane and off everybody; nobody moves on
/// the lanes of vehicles, crossings and walking areas.
void step_to_kerb(const Model& model, Scene& scene, std::size_t row, double dt);

}  // namespace sumogamma
