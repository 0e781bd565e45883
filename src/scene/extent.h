#pragma once

#include "geometry/oriented_box.h"
#include "scene/scene.h"

namespace sumogamma {

/// Half the extent of a row's footprint along a unit direction [m].
double half_extent(const Scene& scene, std::size_t row, const Vec2& direction);

/// The box about a row's footprint, along its heading.
OrientedBox box_of(const Scene& scene, std::size_t row);

/// Is a row's footprint wider than kWideBody?
bool is_wide(const Scene& scene, std::size_t row);

}  // namespace sumogamma
