#pragma once

#include <cstdio>
#include <filesystem>

#include "demand/demand.h"

namespace sumogamma {

/// What [demand] asks for by itself; its files are read, relative to `base`. Throws Error naming
/// the key or the file.
DemandRequest request_of(const DemandSettings& settings, const std::filesystem::path& base,
                         const AgentTypeTable& types);

/// The lines of a place with what [demand] says of their buses and riders.
AskedTransport transport_of(const DemandSettings& settings, PublicTransport transport);

/// The window in degrees, on a network. Throws Error naming the key where the network has no
/// geographic projection or the window lies outside of it.
TripWindow window_on(const RoadNetwork& road, const std::vector<double>& degrees);

/// Agents that a run has to keep alive for it: as asked for, or what the trips make.
long agents_alive(const DemandRequest& request, const DemandReport& report);

/// What came of it, for people: by type, fullest lane, counts.
void print_demand(std::FILE* out, const DemandReport& report);

}  // namespace sumogamma
