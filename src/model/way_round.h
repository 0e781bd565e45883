#pragma once

#include <optional>

#include "model/tick_geometry.h"

namespace sumogamma {

/// The way round bodies that stand in the way of one on wheels which is wedged between them:
/// direction of its centre's velocity, as a turn from its heading [rad, positive left]. Nothing
/// where the arc that leads most nearly along `preferred` is free for some metres, or where none
/// is. Locally, the velocity nearest to the preferred one presses the body against a tail that it
/// could get past by turning later.
std::optional<double> way_round(const Model& model, const Scene& scene,
                                const TickGeometry& geometry, std::size_t row,
                                const Vec2& preferred);

/// Does a body on wheels that points along `forward` (unit) and creeps by such a turn [rad] head
/// more than across its way (unit), and turn further from it? A bicycle that found no way past a
/// car at red went round in a circle, against all others.
bool turns_back(const Vec2& forward, const Vec2& way, double turn);

}  // namespace sumogamma
