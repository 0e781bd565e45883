#pragma once

#include <filesystem>

#include "road/public_transport.h"

namespace sumogamma {

/// The file of a scenario that holds its lines and stops.
inline constexpr const char* kPublicTransportFile = "public_transport.add.xml";

/// Writes stops as SUMO's <busStop> and each part of a line as a <route> with its stops, whose
/// parameters are "line", "kind" and "headway" [s]. Throws Error naming the file.
void write_public_transport(const std::filesystem::path& file, const RoadNetwork& road,
                            const PublicTransport& transport);

/// Reads what write_public_transport() wrote, and what others put beside it. Throws Error naming
/// the file and the element where a lane, an edge or a stop isn't there.
PublicTransport read_public_transport(const std::filesystem::path& file, const RoadNetwork& road);

}  // namespace sumogamma
