#pragma once

#include <optional>

#include "study/offences/judges.h"

namespace sumogamma {

/// What a point of the ground is to a vehicle.
struct Place {
  bool none = false;               ///< no lane of any kind
  bool junction = false;           ///< within the outline of one
  std::optional<LaneHit> against;  ///< lanes lead the other way alone; one of them
  bool walkway = false;            ///< people walk there, and no motor vehicle drives
};

/// Lanes on another storey than the vehicle's own don't count (bridges). A lane leads the other way
/// that is more than 120 degrees from where the vehicle goes.
Place place_at(const RuleView& view, std::size_t row, const Vec2& point, RuleWork& work);

/// Does something hold of the ground on either side of a vehicle's centre, too? Nobody is where it
/// ought not to be by less than 0.1 m: lanes end askew where they meet.
template <typename Holds>
bool holds_beside(const RuleView& view, std::size_t row, RuleWork& work, Holds&& holds) {
  constexpr double kOver = 0.1;  // [m]
  const Vec2 side = kOver * left_of(direction_of(view.scene.heading[row]));
  const Vec2& center = view.scene.position[row];
  return holds(place_at(view, row, center + side, work)) &&
         holds(place_at(view, row, center - side, work));
}

/// The centre is on no lane and no junction, nor in a gap between two of them (within 0.5 m on
/// opposite sides).
std::optional<Finding> is_off_road(const RuleView& view, std::size_t row, const Place& here,
                                   RuleWork& work);

/// Forward and faster than 0.5 m/s, on a normal lane, off junctions, against every lane of the
/// place that vehicles may use. Overtaking: the same, on a lane that the network calls the opposite
/// one of a lane on which somebody narrow goes the same way, no further off than 20 m, or ahead and
/// reached within 4 s, and no more than 1 m/s faster.
std::optional<Finding> goes_wrong_way(const RuleView& view, std::size_t row, const Place& here,
                                      RuleWork& work);

/// The centre of a motor vehicle is on ground for people on foot alone.
std::optional<Finding> is_on_sidewalk(const RuleView& view, std::size_t row, const Place& here,
                                      RuleWork& work);

}  // namespace sumogamma
