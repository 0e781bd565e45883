#pragma once

#include <vector>

#include "geometry/box_grid.h"
#include "geometry/segment.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Where a lane on foot ends at a walking area: people walk straight from one such place to
/// another.
struct WalkingEnd {
  Vec2 place = Vec2::Zero();  ///< [m]
  double width = 0;           ///< of the lane [m]
};
std::vector<WalkingEnd> walking_ends(const RoadNetwork& road, const Lane& area);

/// The ground that lanes need, for cutting obstacles out of it. Lanes for wheels count with their
/// whole width; those for feet with 0.6 m to either side of their middle, since guessed sidewalks
/// are wider than many real ones, as do the ways over walking areas from one lane to another;
/// walking areas whole. A tunnel opens the house above it rather than being walled up, by 1.5 m
/// more than its lanes' width, since what is left between lanes that wind is no wall of it either.
class LaneClearing {
 public:
  explicit LaneClearing(const RoadNetwork& road);

  /// The stretches of the segment that lie on lanes: sorted, disjoint.
  std::vector<Stretch> stretches_on_lanes(const Vec2& from, const Vec2& to) const;
  /// Polygons that together cover the ground of the lanes near the box; they overlap.
  std::vector<std::vector<Vec2>> polygons_near(const Vec2& low, const Vec2& high) const;
  /// True where the disc touches a lane.
  bool touches_lane(const Vec2& center, double radius) const;

 private:
  /// A piece of lane: a rectangle about a segment of its middle line.
  struct Piece {
    Vec2 from = Vec2::Zero(), direction = Vec2::UnitX();
    double length = 0, half_width = 0;
  };
  void add_piece(const Vec2& from, const Vec2& to, double half_width);
  void add_walking_area(const RoadNetwork& road, const Lane& area);

  std::vector<Piece> pieces_;
  std::vector<std::vector<Vec2>> walking_areas_;
  BoxGrid piece_grid_, area_grid_;
};

}  // namespace sumogamma::osm
