#pragma once

#include <ostream>

#include "prediction/predictor_parameters.h"
#include "prediction/protocol.h"

namespace sumogamma {

/// Writes what tools/train_spread.py learns from: a row for each window of protocol C, seen by
/// itself, with the recording's name, kind (0 on foot, 1 on wheels), band, log unsteadiness,
/// mixture and speed of the agent, the sums of unsteadiness of its kind in the scene by band
/// (spread_model.h), and at the steps 1 to 12 how far the truth was from the prediction, forward
/// and to the left [m]. The predictor sees `seen`, the same recording as `truth` but for added
/// noise. `header`: with names.
void write_spread_rows(std::ostream& out, const TrackSet& seen, const TrackSet& truth,
                       const PredictorParameters& parameters, bool header);

}  // namespace sumogamma
