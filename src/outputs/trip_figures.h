#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "outputs/lane_passages.h"

namespace sumogamma {

/// What of a trip SUMO doesn't know where somebody else drives.
struct TripFigures {
  bool driven = false;   ///< by GAMMA, ever
  bool entered = false;  ///< it has been on the road
  bool arrived = false;
  bool bicycle = false;
  double waited = 0;  ///< off the map for room, after SUMO had inserted it [s]
  VehiclePlace first, last;
  TripOdometer odometer;
  /// Beginnings of its stops: time [s], way [m] and time loss [s] until then.
  struct Halt {
    double time, distance, time_loss;
  };
  std::vector<Halt> halts;
};

/// By SUMO's id.
using Trips = std::map<std::string, TripFigures, std::less<>>;

/// The traffic at the end of a step.
struct SummaryFigures {
  bool driven = false;         ///< GAMMA drives a vehicle: else SUMO's own figures are right
  bool walked = false;         ///< GAMMA has moved people, which SUMO's counts don't survive
  std::int64_t waiting = 0;    ///< vehicles that SUMO has inserted and that wait for room
  std::int64_t halting = 0;    ///< vehicles on the road below 0.1 m/s
  double speed = -1;           ///< mean of those on the road that don't stop [m/s]
  double relative_speed = -1;  ///< likewise of speed by their lane's limit
  double waited = 0, waited_arrived = 0;  ///< TripFigures::waited of all so far, of those arrived
  std::int64_t riding = 0;                ///< people in vehicles
};

/// By the begin of the step [ms], as SUMO names it.
using SummaryByTime = std::map<std::int64_t, SummaryFigures>;

/// Copies SUMO's tripinfo-output with the figures of those whom GAMMA drove in place of SUMO's. Who
/// waited to the end is left out. Throws Error naming the file.
void write_tripinfo(const std::filesystem::path& from, const std::filesystem::path& to,
                    const RoadNetwork& network, const Trips& trips, int precision);

/// Copies SUMO's statistic-output with means over `tripinfo`, as write_tripinfo() has written it.
void write_statistics(const std::filesystem::path& from, const std::filesystem::path& to,
                      const std::filesystem::path& tripinfo, const Trips& trips, int precision);

/// Copies SUMO's summary-output, and its person-summary-output.
void write_summary(const std::filesystem::path& from, const std::filesystem::path& to,
                   const SummaryByTime& summary, int precision);
void write_person_summary(const std::filesystem::path& from, const std::filesystem::path& to,
                          const SummaryByTime& summary);

}  // namespace sumogamma
