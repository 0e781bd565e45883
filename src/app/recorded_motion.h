#pragma once

#include <filesystem>
#include <vector>

#include "study/motion_samples.h"

namespace sumogamma {

/// What one side of a comparison stands for.
struct MotionSources {
  std::vector<std::filesystem::path> trajectories;  ///< in SUMO's FCD schema
  std::vector<std::filesystem::path> recordings;    ///< in a format of the prediction command
};

/// The files that a name on the command line means: a run's folder, a folder with runs below it (a
/// study, or one variant's folder in it), an FCD file (.xml, .xml.gz), or a recording. In order of
/// paths. Throws Error naming it where there is nothing of that.
MotionSources find_motion(const std::filesystem::path& named);

/// Feeds all to the sampler, each file as a group of its own. Throws Error naming a file that can't
/// be read, is cut off, or holds no two frames.
void sample_motion(const MotionSources& sources, MotionSampler& sampler);

}  // namespace sumogamma
