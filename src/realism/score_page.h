#pragma once

#include <span>
#include <string>

#include "realism/score.h"

namespace sumogamma {

/// A page with every distribution of the recordings, of windows and of free runs, and beside each
/// those of the methods that drive (GAMMA, SUMO) and of the fan of constant velocity.
std::string score_page(std::span<const RecordingScore> scores, const std::string& version);

}  // namespace sumogamma
