#pragma once

#include <zlib.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "road/lane_locator.h"
#include "scene/agent_type.h"
#include "scene/point_speeds.h"
#include "scene/scene.h"

namespace sumogamma {

/// SUMO's id of an agent.
using AgentName = std::function<std::string_view(AgentId)>;

/// Writes trajectories in SUMO's floating-car-data schema (root <fcd-export>), gzipped where the
/// file's name ends in
/// ".gz": vehicles by front bumper, persons by centre, angles in degrees clockwise from north,
/// speeds of these points, and steps by the time at which they began, as in SUMO's own FCD output.
/// SUMO's own tools read it. The file is whole and readable after close() or destruction, also when
/// a run was interrupted.
class TrajectoryWriter {
 public:
  /// `period`: least time between two recorded steps [s]; 0 records all. `step`: length of a tick
  /// [s]. `locator`: for agents whose scene row names no lane; may be null. Network and locator
  /// must outlive the writer. Throws Error naming the file.
  TrajectoryWriter(const std::filesystem::path& file, double period, double step,
                   const RoadNetwork& network, const LaneLocator* locator = nullptr);
  ~TrajectoryWriter();
  TrajectoryWriter(const TrajectoryWriter&) = delete;
  TrajectoryWriter& operator=(const TrajectoryWriter&) = delete;

  /// To be called after each tick; records the scene where the period is over. Agents that the
  /// world drives stand where they were when the tick began, and go into the step before. Throws
  /// Error naming the file where the disk is full.
  void add(const Scene& scene, const AgentTypeTable& types, const AgentName& name_of);

  /// Ends the document. Idempotent. Throws Error naming the file where the end couldn't be written.
  void close();

 private:
  void append_agent(const Scene& scene, std::size_t row, const AgentType& type,
                    std::string_view name, std::string& text);
  /// Those whom we drive, or all others.
  void append_all(const Scene& scene, const AgentTypeTable& types, const AgentName& name_of,
                  bool driven);
  void finish_step();
  void flush_text();
  [[noreturn]] void fail();

  std::filesystem::path file_;
  double period_, step_, next_time_ = 0;
  bool started_ = false;
  bool open_ = false;                      ///< a step waits for those that the world drives
  bool external_ = false;                  ///< there are such
  std::string head_, vehicles_, persons_;  ///< of the open step
  PointSpeeds speeds_;
  std::vector<double> speed_;  ///< by row [m/s]
  const RoadNetwork& network_;
  const LaneLocator* locator_;
  gzFile stream_ = nullptr;
  std::string text_;
  int since_sync_ = 0;
};

}  // namespace sumogamma
