#pragma once

#include <vector>

#include "scene/scene.h"

namespace sumogamma {

/// Who waits for whom on the road (RoadContext::foe), from the frozen scene: nobody waits for more
/// than one, so that from each row on there is one chain, which ends at its head or in a ring.
class WaitGraph {
 public:
  WaitGraph() = default;
  explicit WaitGraph(const Scene& scene) { rebuild(scene); }

  /// O(n log n).
  void rebuild(const Scene& scene);

  std::size_t size() const { return foe_.size(); }
  /// Row that a row waits for, size() where there is none.
  std::size_t foe(std::size_t row) const { return foe_[row]; }
  /// Does a row wait, over whom it waits for and so on, for itself?
  bool in_ring(std::size_t row) const { return in_ring_[row]; }

  /// The first of those whom a row waits for, be it over others, of whom `holds` is true; size()
  /// where there is none. Of a ring everybody is asked once.
  template <typename Holds>
  std::size_t find_ahead(std::size_t row, Holds holds) const {
    std::size_t entry = size();
    for (std::size_t next = foe_[row]; next < size() && next != entry; next = foe_[next]) {
      if (holds(next)) return next;
      if (entry == size() && in_ring_[next]) entry = next;
    }
    return size();
  }
  /// Does a row wait for another, be it over others?
  bool waits_for(std::size_t row, std::size_t other) const {
    return find_ahead(row, [&](std::size_t next) { return next == other; }) < size();
  }

 private:
  std::vector<std::size_t> foe_;
  std::vector<bool> in_ring_;
  std::vector<std::size_t> walk_;  ///< scratch
};

}  // namespace sumogamma
