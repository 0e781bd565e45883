#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "app/reading_options.h"
#include "realism/recorded_scene.h"

namespace sumogamma {

/// What a user tells about recordings whose bodies count.
struct SceneArguments {
  ReadingArguments reading;
  std::string point = "centre";
  std::vector<std::string> boxes;
};

/// Adds --point and --box, and the options of add_reading_options.
void add_scene_reading_options(CLI::App& command, SceneArguments& arguments);

/// The same for the reader. Throws Error on what is no box, or contradicts itself.
SceneReading scene_reading(const SceneArguments& arguments);

}  // namespace sumogamma
