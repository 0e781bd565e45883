#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "io/study_results.h"
#include "study/study_plan.h"

namespace sumogamma {

/// One self-contained HTML page: the question; the answer in words and as a table of measures with
/// paired differences to the baseline; pictures; tables by scenario and type; what was run. Reads
/// the runs' own files below `folder` for pictures, as far as they are there.
std::string study_html(const std::filesystem::path& folder, const Study& study,
                       std::span<const StudyRunResult> runs, std::span<const SummaryRow> rows);

}  // namespace sumogamma
