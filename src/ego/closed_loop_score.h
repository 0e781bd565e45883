#pragma once

#include <optional>
#include <span>

#include "ego/ego_record.h"

namespace sumogamma {

/// nuPlan's closed-loop score of one episode, adapted to a world in which the others react: a
/// product of multipliers times a weighted mean (docs/ego.md has the table).
struct ClosedLoopScore {
  // multipliers, 0 or 1
  double no_fault = 1, drivable_area = 1, driving_direction = 1, making_progress = 1;
  // weighted: 5, 5, 4, 2
  double time_to_collision = 1, progress = 1, speed_limit = 1, comfort = 1;

  double total() const;
  /// The same without comfort, which discrete accelerations of 3 m/s^2 never keep.
  double without_comfort() const;
};

/// From samples `step` [s] apart, and the first contact. `reference`: what the way is held against
/// [m], GAMMA's own on the same seed; both count as at least 0.1 m. An episode of no samples has
/// score 0 by its progress.
ClosedLoopScore closed_loop_score(std::span<const EgoSample> samples,
                                  const std::optional<EgoContact>& contact, double reference,
                                  double step);

}  // namespace sumogamma
