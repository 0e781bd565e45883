#pragma once

#include <zlib.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/trajectory_rows.h"
#include "road/lane_locator.h"
#include "scene/agent_type.h"
#include "scene/point_speeds.h"
#include "scene/scene.h"

namespace sumogamma {

/// SUMO's id of an agent.
using AgentName = std::function<std::string_view(AgentId)>;

/// Writes trajectories in SUMO's floating-car-data schema (root <fcd-export>), gzipped where the
/// file's name ends in ".gz": vehicles by front bumper, persons by centre, angles in degrees
/// clockwise from north. SUMO's own tools read it. The file is whole and readable after close() or
/// destruction, also when a run was interrupted.
class FcdSink final : public TrajectorySink {
 public:
  /// Throws Error naming the file.
  explicit FcdSink(const std::filesystem::path& file);
  ~FcdSink() override;

  void add(const TrajectoryStep& step) override;
  void close() override;

 private:
  void flush_text();
  [[noreturn]] void fail();

  std::filesystem::path file_;
  gzFile stream_ = nullptr;
  std::string text_;
  int since_sync_ = 0;
};

/// Makes rows of scenes and hands them to files, every `period`: speeds are those of the points
/// that stand in the rows, and steps have the time at which they began, as in SUMO's own FCD
/// output.
class TrajectoryWriter {
 public:
  /// `period`: least time between two recorded steps [s]; 0 records all. `step`: length of a tick
  /// [s]. `locator`: for agents whose scene row names no lane; may be null. Network and locator
  /// must outlive the writer.
  TrajectoryWriter(double period, double step, const RoadNetwork& network,
                   const LaneLocator* locator = nullptr);
  ~TrajectoryWriter();
  TrajectoryWriter(const TrajectoryWriter&) = delete;
  TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;

  /// Before the first step.
  void add_sink(std::unique_ptr<TrajectorySink> sink) { sinks_.push_back(std::move(sink)); }

  /// To be called after each tick; records the scene where the period is over. Agents that the
  /// world drives stand where they were when the tick began, and go into the step before. Throws
  /// Error naming the file where the disk is full.
  void add(const Scene& scene, const AgentTypeTable& types, const AgentName& name_of);

  /// Ends all files. Idempotent. Throws Error naming the file whose end couldn't be written.
  void close();

 private:
  TrajectoryRow row_of(const Scene& scene, std::size_t row, const AgentType& type,
                       std::string_view name) const;
  /// Those whom we drive, or all others.
  void append_all(const Scene& scene, const AgentTypeTable& types, const AgentName& name_of,
                  bool driven);
  void finish_step();

  double period_, step_, next_time_ = 0;
  bool started_ = false;
  bool open_ = false;      ///< a step waits for those that the world drives
  bool external_ = false;  ///< there are such
  bool closed_ = false;
  double open_time_ = 0;                           ///< of the open step [s]
  std::vector<TrajectoryRow> vehicles_, persons_;  ///< likewise
  PointSpeeds speeds_;
  std::vector<double> speed_;  ///< by row [m/s]
  const RoadNetwork& network_;
  const LaneLocator* locator_;
  std::vector<std::unique_ptr<TrajectorySink>> sinks_;
};

}  // namespace sumogamma
