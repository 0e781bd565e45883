#pragma once

#include <ostream>

#include "prediction/protocol.h"

namespace sumogamma {

/// Writes what tools/train_walking_model.py learns from: a row for each window of protocol C of
/// somebody on foot, with the recording's name, the displacements at steps 3, 6, 9 and 12 and the
/// features of walking_model.h, all as x,y [m]. Each window is seen by itself. `header`: with
/// names.
void write_walking_rows(std::ostream& out, const TrackSet& set, bool header);

}  // namespace sumogamma
