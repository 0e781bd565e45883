#pragma once

#include <span>
#include <string>
#include <vector>

#include "demand/line_timetable.h"

namespace sumogamma {

inline constexpr double kNearStop = 20.0;  ///< from its stop begins a walk on the stop's edge [m]

/// Somebody who walks to a stop, rides, and walks on.
struct Rider {
  double time = 0;                    ///< of departure [s]
  std::vector<std::string> to, from;  ///< edges to the first stop, and from the last
  double share_of_edge = 0;           ///< where on the first and last edge the trip begins and ends
  std::size_t boards = 0, alights = 0;  ///< rows of PublicTransport::stops
  std::string line;
};

/// Riders of the buses, all alike: from about 400 m on foot at the most of one stop to as far from
/// a later one, as many an hour as asked for, else three for each bus. They depart so as to be at
/// the stop from one minute to a headway before their bus is due, ten minutes at the most; who
/// would have departed before the begin is on the way then. Both walks are SUMO's (duarouter).
/// Sorted by time, deterministic in the seed. None, with a reason in the report, where nobody can
/// walk to two stops of a part; none and `stopped` where it was stopped.
std::vector<Rider> draw_riders(const RoadNetwork& road, const AgentTypeTable& types,
                               const DemandRequest& request, std::span<const BusRun> runs,
                               DemandReport& report);

}  // namespace sumogamma
