#include "study/offences/judges.h"

namespace sumogamma {

void judge_mid_block(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work) {
  const Path* path = view.road.path(view.scene.path[row]);
  if (path == nullptr) return;
  const double along = view.scene.path_along[row];
  if (memory.known)
    for (const RoadCrossing& piece : path->over_road)
      if (memory.path_along < piece.end && along >= piece.end && memory.path_along > piece.begin)
        work.found.push_back(
            {.row = static_cast<std::uint32_t>(row), .what = Finding::RoadCrossed});
  memory.path_along = along;
}

}  // namespace sumogamma
