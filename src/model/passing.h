#pragma once

#include "model/surroundings.h"

namespace sumogamma {

/// Where beside its path an agent on wheels should be [m, positive left]: where it likes to be, or
/// far enough aside to pass somebody slow with a gap, where the room of its own direction allows
/// it. Wide vehicles pass narrow ones on the inner side; narrow ones pass anybody, on either side.
double passing_offset(const Model& model, const Path& path, const Scene& scene,
                      const Surroundings& around, std::size_t row);

}  // namespace sumogamma
