#pragma once

#include <filesystem>
#include <string>

#include "study/study_plan.h"

namespace sumogamma {

/// What decides the outcome of a study's runs, as JSON: options, this program, and by name
/// scenarios (hash of their files) and variants. Seeds, measures and questions may change: the runs
/// stay what they are.
std::string identity_of(const Study& study);

/// Makes the folder and leaves the study's identity in it. A folder with runs of the same study is
/// gone on with; scenarios and variants that are new are added. Throws Error naming the folder
/// where it holds something else, or runs by other options, scenarios or another build.
void claim_study_folder(const std::filesystem::path& folder, const Study& study);

/// Throws Error where a folder's runs are none of this study.
void require_same_study(const std::filesystem::path& folder, const Study& study);

/// The running program's own file.
std::filesystem::path own_program();

}  // namespace sumogamma
