#pragma once

#include <filesystem>
#include <vector>

#include "demand/demand.h"

namespace sumogamma {

/// An origin-destination table: CSV with the columns from, to (edges), type and per_hour. Throws
/// Error naming file and line for a missing column, an unknown type (with the nearest known one)
/// and a number that is none or negative; a table without rows is one, too.
std::vector<AskedTrips> read_od_table(const std::filesystem::path& file,
                                      const AgentTypeTable& types);

/// Counts of vehicles as SUMO's routeSampler reads them: `<interval begin end>` with `<edge id
/// entered>` of an edgeData output and `<edgeRelation from to count>`; several intervals are summed
/// up (https://sumo.dlr.de/docs/Tools/Turns.html). Throws Error naming file and element.
std::vector<EdgeCount> read_counts(const std::filesystem::path& file);

}  // namespace sumogamma
