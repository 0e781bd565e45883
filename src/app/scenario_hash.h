#pragma once

#include <string>

#include "sumo/scenario_input.h"

namespace sumogamma {

/// Of the content of all files that a scenario names: what was driven on others isn't gone on with.
std::string hash_of_files(const ScenarioInput& input);

}  // namespace sumogamma
