#pragma once

#include <filesystem>
#include <string>

#include "study/study_plan.h"

namespace sumogamma {

/// Makes the folder and leaves the study's identity in it. A folder with runs of the same study is
/// gone on with; scenarios and variants that are new are added. Throws Error naming the folder
/// where it holds something else, or runs by other options, scenarios or another build.
void claim_study_folder(const std::filesystem::path& folder, const Study& study);

/// Throws Error where a folder's runs are none of this study.
void require_same_study(const std::filesystem::path& folder, const Study& study);

}  // namespace sumogamma
