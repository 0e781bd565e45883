#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "model/tick_geometry.h"
#include "scene/scene.h"

namespace sumogamma {

/// Which agents' bare outlines have overlapped so far, in a scene whose rows stay the same.
class OverlapRecord {
 public:
  explicit OverlapRecord(std::size_t rows) : deepest_(rows, 0.0), now_(rows, 0) {}

  /// Adds the overlaps of the present state. `geometry` must be prepared for `scene`.
  void update(const Scene& scene, const TickGeometry& geometry, Workers& workers);

  /// Agents that have overlapped by more than `depth` [m] at least once.
  std::size_t agents_deeper_than(double depth) const;
  /// Distinct pairs that have overlapped.
  std::size_t pairs() const { return pairs_.size(); }
  /// Sum over the updates of the agents in overlap.
  std::int64_t agent_steps() const { return agent_steps_; }
  /// Agents that overlapped in the last update, by row.
  const std::vector<char>& now() const { return now_; }

 private:
  struct Contact {
    std::uint32_t first, second;
    double depth;
  };
  std::vector<double> deepest_;
  std::vector<char> now_;
  std::vector<std::uint64_t> pairs_;  ///< sorted
  std::vector<std::vector<Contact>> found_;
  std::int64_t agent_steps_ = 0;
};

}  // namespace sumogamma
