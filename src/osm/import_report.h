#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "osm/build_network.h"

namespace sumogamma::osm {

/// The map's part of import.json: what was read, built, guessed, moved and dropped, with reasons.
nlohmann::ordered_json import_report(const BuildResult& result, const std::string& map_name);

}  // namespace sumogamma::osm
