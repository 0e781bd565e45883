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
  double time = 0;        ///< of departure [s]
  std::size_t first = 0;  ///< row of the route where it departs: later ones are on the way already
};

/// Seconds from the begin of a part to the begin of each edge of its route, and in the end to the
/// end of the last one: at the road's limits, `slowness` times as long, with kDwell at each stop.
std::vector<double> arrival_times(const RoadNetwork& road, const AgentType& bus,
                                  const LinePart& part, double slowness);

/// The buses of all lines for the time that demand is asked for: from a drawn moment within its
/// headway on each part departs one a headway, and those that departed before the begin and aren't
/// at the end yet depart within the warm-up from where they are. Sorted by time. Deterministic in
/// the seed. Parts that no bus can drive (suits()) are left out and named in the report.
std::vector<BusRun> line_timetable(const RoadNetwork& road, const AgentType& bus,
                                   const DemandRequest& request, TransportDemand& report);

}  // namespace sumogamma
