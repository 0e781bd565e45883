#pragma once

#include <memory>

#include "geometry/vec2.h"
#include "road/road_network.h"

namespace sumogamma {

/// Where motor vehicles may drive: their lanes, also over junctions, and the junctions' outlines,
/// as one area with its border. Gaps of under 0.2 m between them are none.
class DrivableArea {
 public:
  explicit DrivableArea(const RoadNetwork& network);
  ~DrivableArea();
  DrivableArea(DrivableArea&&) noexcept;
  DrivableArea& operator=(DrivableArea&&) noexcept;

  /// Distance of a point to the border [m]: negative inside, positive outside; infinite where a
  /// network has no such lane.
  double signed_distance(const Vec2& point) const;

 private:
  struct Border;
  std::unique_ptr<Border> border_;
};

}  // namespace sumogamma
