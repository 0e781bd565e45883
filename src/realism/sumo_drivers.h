#pragma once

#include <cstdint>
#include <filesystem>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace sumogamma {

// SUMO's own drivers as the methods sumo-krauss, sumo-idm, sumo-eidm and sumo-sublane have them:
// carFollowModel, else SUMO's defaults, in steps of kScoreStep; sumo-sublane is Krauss with
// lateral-resolution 0.64.

/// What SUMO is started with, behind its own name: more may follow.
std::vector<std::string> sumo_arguments(const std::filesystem::path& network,
                                        const std::filesystem::path& routes,
                                        const std::string& method, std::uint64_t seed);

/// Makes a vType of append_vehicle_type one of a method's, with this factor on speed limits.
void set_driver(pugi::xml_node type, const std::string& method, const std::string& speed_factor);

std::string xml_text(const pugi::xml_document& document);

}  // namespace sumogamma
