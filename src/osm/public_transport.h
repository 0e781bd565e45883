#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "osm/line_routes.h"
#include "road/public_transport.h"

namespace sumogamma::osm {

/// What came of a map's lines.
struct LineReport {
  std::map<std::string, long> found;      ///< lines on roads by kind
  std::map<std::string, long> others;     ///< lines that no road carries, by kind: not driven
  long driven = 0;                        ///< lines with at least one part
  std::vector<std::string> at_all_stops;  ///< lines whose relation names no stop in the map
  std::vector<std::pair<std::string, std::string>> left_out;  ///< line, why
};

/// The parts of lines that a bus can drive in the network, and the stops on them. A part with fewer
/// than two stops is left out, and a line without a part is named in the report.
PublicTransport place_lines(const LineGround& ground, const MapLines& lines, LineReport& report);

}  // namespace sumogamma::osm
