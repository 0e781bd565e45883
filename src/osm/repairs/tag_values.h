#pragma once

#include <optional>
#include <string>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// A speed limit as mappers write it: "50", "30 mph", "30mph", "50 km/h", "20 knots", "walk",
/// "DE:zone30", "DE:30"; of a list ("50;70", "70|100") the least. [km/h]; nothing for one that is
/// no number or that nobody can drive (below 3, over 160 km/h).
std::optional<double> speed_limit(const std::string& value);

/// Takes out or rewrites values of lanes, maxspeed, layer and oneway of roads that can't be meant,
/// or that netconvert 1.15 would misread: it drops a road whose limit is 0, lets 999 km/h be driven
/// and builds 99 lanes. The kind of road then says what holds. Each kind of these is a warning,
/// with the way and the value.
void correct_tag_values(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
