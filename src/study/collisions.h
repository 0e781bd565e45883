#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "geometry/convex_polygon.h"
#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/scene.h"
#include "scene/storey.h"

namespace sumogamma {

/// Keys of `collisions` in results.json.
struct CollisionResult {
  std::uint64_t unique_pairs = 0;           ///< pairs of agents that overlapped at least once
  double unique_pairs_per_agent_hour = 0;   ///< 0 for an empty run
  double overlap_share_of_agent_steps = 0;  ///< agent-steps with an overlap / all agent-steps
  std::uint64_t deep_pairs = 0;             ///< pairs whose overlap was ever deeper than kDeep
  std::map<std::string, std::uint64_t>
      by_types;  ///< unique pairs by "car-pedestrian", the names in alphabetical order
  double worst_penetration_m = 0;  ///< deepest overlap of the run [m]
  double agent_hours = 0;          ///< time that agents were alive, summed [h]
};

/// A pair that overlapped, from the first time on: where to look when a count surprises.
struct CollisionPair {
  double since = 0;  ///< [s]
  AgentId a, b;      ///< a < b
  AgentTypeId type_a{}, type_b{};
  Vec2 position = Vec2::Zero();  ///< midway between the two centres, the first time [m]
  double depth = 0;              ///< the deepest [m]
  double duration = 0;           ///< of all ticks with an overlap [s]
};

/// Tests the oriented footprints of all agents alive, whoever drives them, against each other every
/// tick: sweep over x, then the separating axis theorem. Agents above one another
/// (on_other_storey(), bridges) don't meet.
class CollisionMonitor {
 public:
  static constexpr double kContact =
      1e-3;  ///< an overlap counts from this depth: poses are exact to far less [m]
  static constexpr double kDeep = 0.1;  ///< [m]

  /// `step`: time between two calls of add [s]. `road`: for heights, or null; must outlive the
  /// monitor.
  explicit CollisionMonitor(double step, const RoadNetwork* road = nullptr);

  void add(const Scene& scene, const AgentTypeTable& types);

  CollisionResult result() const;
  /// In the order in which they began.
  const std::vector<CollisionPair>& pairs() const { return pairs_; }
  /// By row of the last scene: true where the agent overlaps another.
  const std::vector<bool>& overlapping() const { return overlapping_; }

 private:
  struct Interval {
    double left, right;
    std::uint32_t row;
  };
  void prepare(const Scene& scene);
  void meet(const Scene& scene, const AgentTypeTable& types, std::size_t a, std::size_t b);

  double step_;
  const RoadNetwork* road_;
  bool has_storeys_;
  std::vector<CollisionPair> pairs_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> index_;  ///< into pairs_, by ids
  std::map<std::string, std::uint64_t> by_types_;
  std::uint64_t agent_steps_ = 0, overlap_steps_ = 0;

  // scratch of one tick
  std::vector<Interval> intervals_;
  std::vector<ConvexPolygon> outlines_;
  std::vector<Ground> ground_;
  std::vector<bool> overlapping_;
};

}  // namespace sumogamma
