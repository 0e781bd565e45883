#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sumogamma {

/// One agent at one step, in SUMO's terms: a vehicle's front bumper, a person's centre.
struct TrajectoryRow {
  std::string id;          ///< SUMO's
  std::string_view type;   ///< name of the type
  std::string_view place;  ///< a vehicle's lane, a person's edge; empty where there is none
  double x = 0, y = 0;     ///< [m]
  double angle = 0;        ///< clockwise from north [degrees]
  double speed = 0;        ///< of that point [m/s]
  double along = 0;        ///< on the lane, as SUMO counts [m]
  double slope = 0;        ///< [degrees]
};

/// Everybody at one step. What it points to holds during the call that it is handed to alone, but
/// for names of types and places, which hold as long as the run.
struct TrajectoryStep {
  double time = 0;  ///< at which the step began [s]
  std::span<const TrajectoryRow> vehicles, persons;
};

/// Something that steps are written to.
class TrajectorySink {
 public:
  TrajectorySink() = default;
  virtual ~TrajectorySink() = default;
  TrajectorySink(const TrajectorySink&) = delete;
  TrajectorySink& operator=(const TrajectorySink&) = delete;

  /// Throws Error naming its file.
  virtual void add(const TrajectoryStep& step) = 0;
  /// Ends it. Idempotent. Throws Error naming its file.
  virtual void close() = 0;
};

}  // namespace sumogamma
