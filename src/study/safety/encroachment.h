#pragma once

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include "scene/scene.h"

namespace sumogamma {

/// Somebody is where another was a moment before.
struct Encroachment {
  std::uint32_t row = 0;  ///< who came later, a row of the present scene
  AgentId before;         ///< who was there
  double time = 0;        ///< since that one left [s]: the post-encroachment time
  double angle = 0;       ///< between the two ways, 0 to pi [rad]
  Vec2 place = Vec2::Zero();
};

/// Post-encroachment time (Allen, Shin and Cooper 1978): from when the first of two road users
/// leaves a piece of ground to when the second comes onto it, over outlines as they are, without
/// any extrapolation. Exact in space, to one step in time. Ways that run within kAlong of each
/// other are following, not crossing, and none of it.
class EncroachmentMonitor {
 public:
  static constexpr double kLongest = 5.0;               ///< [s]; FHWA's SSAM looks no further
  static constexpr double kAlong = 0.5235987755982988;  ///< 30 degrees [rad]

  /// `step`: time between two calls of add [s]; `longest`: times beyond it are none [s].
  explicit EncroachmentMonitor(double step, double longest = kLongest)
      : step_(step), longest_(longest) {}

  /// Who of the scene is on ground that another left no longer than `longest` ago, each pair at the
  /// shortest time of this moment; in order of rows, then of who was before. Two that stand on the
  /// same ground now have none.
  const std::vector<Encroachment>& add(const Scene& scene);

 private:
  struct Pose {
    double time = 0;
    Vec2 position = Vec2::Zero();
    double heading = 0;
  };
  struct Past {
    Footprint footprint;
    std::deque<Pose> poses;  ///< oldest first
  };
  struct Visit {
    AgentId id;
    double time = 0;
    double heading = 0;
  };
  void look(const Scene& scene, std::uint32_t row);
  void find_latest(const Scene& scene, std::uint32_t row, AgentId other);
  void remember(const Scene& scene, std::uint32_t row);
  void forget(double before);

  double step_, longest_;
  double next_cleaning_ = 0;
  std::unordered_map<std::uint64_t, std::vector<Visit>> cells_;  ///< never iterated for results
  std::unordered_map<std::uint32_t, Past> past_;                 ///< by id, likewise
  std::vector<AgentId> seen_;                                    ///< scratch: others of one row
  std::vector<Encroachment> found_;
};

}  // namespace sumogamma
