#pragma once

#include <cstdint>
#include <vector>

#include "geometry/vec2.h"
#include "road/road_network.h"

namespace sumogamma {

/// The sides of all solid things of a network, sorted into cells: built once, only read afterwards.
class ObstacleIndex {
 public:
  struct Side {
    Vec2 from, to;
    std::int32_t obstacle;  ///< index into RoadNetwork::obstacles
  };

  ObstacleIndex() = default;
  explicit ObstacleIndex(const std::vector<Obstacle>& obstacles);

  bool empty() const { return sides_.empty(); }
  const Side& side(std::uint32_t index) const { return sides_[index]; }

  /// Fills `found` with the sides that come within `radius` [m] of `center`, each once, in
  /// ascending order.
  void find_near(const Vec2& center, double radius, std::vector<std::uint32_t>& found) const;

  /// Does a side lie between two places?
  bool is_between(const Vec2& from, const Vec2& to) const;

 private:
  std::size_t cell_of(double offset, std::size_t count) const;

  std::vector<Side> sides_;
  std::vector<std::uint32_t> cell_begin_, cell_sides_;
  Vec2 origin_ = Vec2::Zero();
  double cell_ = 16.0;  ///< [m]
  std::size_t columns_ = 0, lines_ = 0;
};

}  // namespace sumogamma
