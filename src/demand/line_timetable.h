#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "demand/demand.h"

namespace sumogamma {

/// A bus on a part of a line.
struct BusRun {
  std::string id;
  const LinePart* part = nullptr;
  double time = 0;              ///< of departure [s]
  std::vector<double> arrival;  ///< arrival_times() of the part
  std::size_t first = 0;  ///< row of the route where it departs: later ones are on the way already
};

/// Seconds from the begin of a part to the begin of each edge of its route, and in the end to the
/// end of the last one: at the road's limits, `slowness` times as long, with kDwell at each stop.
std::vector<double> arrival_times(const RoadNetwork& road, const AgentType& bus,
                                  const LinePart& part, double slowness);

/// Lines without what no bus can drive (suits()): a part goes on as several where a turn is too
/// sharp for one or two lane changes have too little room, each with two stops at least. Each gets
/// a number behind its line's name ("42:0"), as SUMO's ptlines2flows.py gives. What is left out
/// wholly is named in the report.
std::vector<LinePart> drivable_parts(const RoadNetwork& road, const AgentType& bus,
                                     const std::vector<LinePart>& parts, TransportDemand& report);

/// The buses of all parts for the time that demand is asked for: from a drawn moment within its
/// headway on each part departs one a headway, and those that departed before the begin and aren't
/// at the end yet depart within the warm-up from where they are. Sorted by time. Deterministic in
/// the seed.
std::vector<BusRun> line_timetable(const RoadNetwork& road, const AgentType& bus,
                                   const DemandRequest& request, TransportDemand& report);

}  // namespace sumogamma
