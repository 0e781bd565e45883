#pragma once

#include <filesystem>
#include <string>

#include "study/study_plan.h"

namespace sumogamma {

/// Reads a study (docs/studies.md lists the keys) and writes its parameters out as variants.
/// Scenarios are looked for beside the file. Throws Error naming file and line for what isn't TOML,
/// an unknown key (with the nearest known one), a value of the wrong type or out of range, a
/// scenario that isn't there, and names that occur twice.
Study read_study(const std::filesystem::path& file);

/// "agents.arrived=5%" or "flow.mean_speed=0.1" of --until. Throws Error.
StudyUntil parse_until(const std::string& text);

}  // namespace sumogamma
