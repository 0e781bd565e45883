#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geometry/spatial_grid.h"
#include "scene/agent_type.h"
#include "scene/scene.h"
#include "study/agent_track.h"
#include "study/distribution_distance.h"
#include "study/safety/encroachment.h"

namespace sumogamma {

/// What `compare` compares.
enum class MotionMeasure : std::uint8_t {
  Speed,             ///< [m/s]
  Acceleration,      ///< change of speed over kWindow [m/s^2]
  YawRate,           ///< change of heading over kWindow, of who goes faster than 1 m/s [rad/s]
  NearestDistance,   ///< gap to the nearest other outline, up to 40 m [m]
  TimeGap,           ///< gap to who is ahead in the own strip over the own speed, above 1 m/s [s]
  TimeToCollision,   ///< least, up to 5 s [s]
  PostEncroachment,  ///< up to 5 s, the least of a pair [s]
};
inline constexpr std::size_t kMotionMeasures = 7;

struct MotionMeasureInfo {
  MotionMeasure measure;
  const char *name, *label, *unit;
  Bins bins;
};
/// In the order of the enumeration.
const std::array<MotionMeasureInfo, kMotionMeasures>& motion_measures();

/// Counts of every measure by agent, from scenes a period apart: of a run, a SUMO simulation or a
/// recording, all by the same code.
class MotionSampler {
 public:
  static constexpr double kWindow = 1.0;  ///< [s], as near as whole periods come

  /// `only`: names of types that are sampled (all are seen by others); empty: all.
  explicit MotionSampler(std::set<std::string> only = {}) : only_(std::move(only)) {}

  /// Another run or recording begins, with scenes `period` apart [s].
  void begin_group(double period);
  void add(const Scene& scene, const AgentTypeTable& types);
  /// No more scenes.
  void finish() { end_group(); }

  const std::vector<AgentHistogram>& agents(MotionMeasure measure) const {
    return agents_[static_cast<std::size_t>(measure)];
  }
  std::uint64_t sampled_agents() const { return sampled_; }
  std::size_t groups() const { return groups_; }

 private:
  using Counts = std::array<std::vector<float>, kMotionMeasures>;
  struct State {
    bool known = false;
    std::vector<double> speed, heading;  ///< of the last window, oldest first
    Counts counts;
  };
  void count(Counts& counts, MotionMeasure measure, double value) const;
  void sample_motion(const Scene& scene, std::size_t row, State& state) const;
  void sample_neighbours(const Scene& scene, std::size_t row, State& state) const;
  void sample_encroachments(const Scene& scene, const AgentTypeTable& types);
  void leave(State& state);
  void end_group();

  std::set<std::string> only_;
  std::size_t groups_ = 0, window_ = 1;
  double period_ = 0;
  bool open_ = false;
  std::uint64_t sampled_ = 0;
  AgentTrack<State> track_;
  SpatialGrid grid_;
  std::vector<EncroachmentMonitor> encroachments_;                   ///< one, of the present group
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> least_;  ///< of pairs of the group
  std::array<std::vector<AgentHistogram>, kMotionMeasures> agents_;
};

}  // namespace sumogamma
