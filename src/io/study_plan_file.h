#pragma once

#include <filesystem>

#include "study/study_plan.h"

namespace sumogamma {

inline constexpr const char* kPlanFile = "plan.json";

/// What a report has to know of a study whose results lie in `folder`: everything but where its
/// scenarios are. Throws Error naming the file.
void write_study_plan(const std::filesystem::path& folder, const Study& study);
Study read_study_plan(const std::filesystem::path& folder);

}  // namespace sumogamma
