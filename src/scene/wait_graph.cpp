#include "scene/wait_graph.h"

namespace sumogamma {

void WaitGraph::rebuild(const Scene& scene) {
  const std::size_t rows = scene.size();
  foe_.resize(rows);
  for (std::size_t row = 0; row < rows; ++row) foe_[row] = foe_row(scene, row);
  in_ring_.assign(rows, false);
  walk_.assign(rows, rows);
  // each row is walked over once: a walk that comes back to its own steps has found a ring
  for (std::size_t start = 0; start < rows; ++start) {
    std::size_t row = start;
    for (; row < rows && walk_[row] == rows; row = foe_[row]) walk_[row] = start;
    if (row == rows || walk_[row] != start) continue;
    for (std::size_t member = row; !in_ring_[member]; member = foe_[member])
      in_ring_[member] = true;
  }
}

}  // namespace sumogamma
