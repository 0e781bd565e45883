#pragma once

#include <string>
#include <vector>

#include "prediction/observed_scene.h"

namespace sumogamma {

/// A picture (SVG) of one frame: what was seen (grey), what then happened (black), the prediction
/// (blue) and its samples (light blue, may be none), with the boxes of now. Metres to scale, y
/// upwards.
std::string forecast_svg(const TrackSet& truth, const ObservedScene& scene,
                         const Forecast& forecast, const std::vector<Forecast>& samples);

}  // namespace sumogamma
