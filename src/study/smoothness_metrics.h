#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/agent_type.h"
#include "scene/scene.h"
#include "study/agent_track.h"
#include "study/histogram.h"

namespace sumogamma {

/// Keys of `smoothness` in results.json; the same for everybody on wheels together and for each
/// type.
struct SmoothnessValues {
  double accel_p95 = 0;           ///< of |change of speed along the heading| [m/s^2]
  double jerk_p95 = 0;            ///< of |change of that acceleration| [m/s^3]
  double yaw_rate_p95 = 0;        ///< of |turn of the heading| [rad/s]
  double lateral_slip_p95 = 0;    ///< of |sideways speed of the rear axle| [m/s]; 0 for pedestrians
  std::uint64_t reversals = 0;    ///< changes from going forward to going backward
  std::uint64_t agent_steps = 0;  ///< that the quantiles rest on
};

struct SmoothnessResult {
  SmoothnessValues wheeled;
  std::map<std::string, SmoothnessValues> by_type;  ///< pedestrians included
};

/// Measures motion from poses alone, so that it means the same for everyone whoever drives:
/// differences between ticks of agents that move (faster than kMoving before or after). Agents that
/// jump (a teleport of SUMO) start anew.
class SmoothnessMonitor {
 public:
  static constexpr double kMoving = 0.1;     ///< [m/s]
  static constexpr double kBackward = 0.05;  ///< slower than this backward isn't a reversal [m/s]

  explicit SmoothnessMonitor(double step) : step_(step) {}
  void add(const Scene& scene, const AgentTypeTable& types);
  SmoothnessResult result(const AgentTypeTable& types) const;

 private:
  struct State {
    int ticks = 0;  ///< seen so far, at most 3
    Vec2 position = Vec2::Zero();
    double heading = 0, speed = 0, acceleration = 0;
    bool backward = false;
  };
  struct Counts {
    Histogram acceleration{0.02, 1001}, jerk{0.5, 2001}, yaw_rate{0.005, 2001}, slip{0.002, 2501};
    std::uint64_t reversals = 0, agent_steps = 0;
    SmoothnessValues values() const;
  };
  void add_agent(const Scene& scene, std::size_t row, const AgentType& type, Counts& counts);

  double step_;
  AgentTrack<State> track_;
  std::vector<Counts> by_type_;  ///< by AgentTypeId
  Counts wheeled_;
};

}  // namespace sumogamma
