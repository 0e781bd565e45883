#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "road/road_network.h"

namespace sumogamma {

/// A lane at or near a point.
struct LaneHit {
  LaneId lane = kNoLane;
  double along = 0;  ///< on the lane's centreline [m]; 0 for a walking area
  double offset =
      0;  ///< signed distance to the centreline, positive to the left [m]; 0 for a walking area
  double distance = 0;          ///< to the lane's surface [m], 0 inside
  Vec2 direction = Vec2(1, 0);  ///< of travel at `along`, unit; meaningless for a walking area
};

/// Even-odd test: true inside the ring (open or closed list of corners). False for fewer than three
/// corners.
bool ring_contains(std::span<const Vec2> ring, const Vec2& point);

/// Distance from a point to the ring's boundary [m]; infinite for an empty ring.
double distance_to_ring(std::span<const Vec2> ring, const Vec2& point);
/// Likewise to the ground within it: 0 inside.
double distance_to_area(std::span<const Vec2> ring, const Vec2& point);

/// Answers "which lanes are here?" for lanes of all kinds by a uniform grid over the network. Lanes
/// lie on one another on junctions and under bridges, so every answer is a set. Immutable: safe to
/// read from many threads.
///
/// A strip lane (normal, internal, crossing) contains a point that projects onto its centreline
/// within half its width and isn't beyond its ends by more than kEndTolerance; a walking area
/// contains what its ring contains.
class LaneLocator {
 public:
  static constexpr double kEndTolerance = 0.1;  ///< [m]

  LaneLocator() = default;
  /// Keeps a reference: the network must outlive the locator.
  explicit LaneLocator(const RoadNetwork& network);

  /// All lanes that contain the point, in order of id, into `hits` (cleared first). No allocation
  /// once warm.
  void find_containing(const Vec2& point, std::vector<LaneHit>& hits) const {
    find_containing(
        point, [](LaneId) { return true; }, hits);
  }
  /// Likewise those of them for which wanted(LaneId) holds.
  template <typename Wanted>
  void find_containing(const Vec2& point, Wanted&& wanted, std::vector<LaneHit>& hits) const {
    hits.clear();
    const std::size_t cell = cell_at(point);
    if (cell >= columns_ * lines_) return;
    const Vec2 place = point - origin_;
    for (std::uint32_t k = entry_begin_[cell]; k < entry_begin_[cell + 1]; ++k) {
      if (!entries_[k].box.is_within(place, 0.0) || !wanted(entries_[k].lane)) continue;
      const LaneHit hit = measure(entries_[k], point);
      if (hit.distance <= 0.0) hits.push_back(hit);
    }
  }

  /// True where a junction's outline contains the point.
  bool on_junction(const Vec2& point) const;

  /// The lane open to one of `classes` that is nearest to the point, at most `reach` [m] away;
  /// among lanes equally near (all that contain it) the one whose direction is nearest to `heading`
  /// [rad] (walking areas and lanes for pedestrians alone have none), then the first by id. kNoLane
  /// in the hit's lane where there is none.
  LaneHit find_nearest(const Vec2& point, VehicleClassMask classes, double heading,
                       double reach = 20.0) const;

 private:
  /// About ground, seen from the grid's origin [m]. A little too large, so that rounding hides
  /// none.
  struct Box {
    float left, bottom, right, top;

    /// May some of the ground be `reach` [m] or less away?
    bool is_within(const Vec2& place, double reach) const {
      const double x = place.x(), y = place.y();
      return x >= static_cast<double>(left) - reach && x <= static_cast<double>(right) + reach &&
             y >= static_cast<double>(bottom) - reach && y <= static_cast<double>(top) + reach;
    }
  };
  /// Part of a lane within a cell: segments first..last of its centreline, or a walking area's
  /// ring, and a box about its surface.
  struct Entry {
    LaneId lane;
    std::uint32_t first, last;
    Box box;
  };

  std::size_t cell_at(const Vec2& point) const;
  template <typename Visit>
  void visit_cells(const Vec2& lower, const Vec2& upper, Visit&& visit) const;
  template <typename AddEntry, typename AddJunction>
  void rasterize(AddEntry&& add_entry, AddJunction&& add_junction) const;
  Box box_about(const Vec2& lower, const Vec2& upper) const;
  LaneHit measure(const Entry& entry, const Vec2& point) const;

  const RoadNetwork* network_ = nullptr;
  Vec2 origin_ = Vec2::Zero();
  double cell_ = 1.0;  ///< [m]
  std::size_t columns_ = 0, lines_ = 0;
  std::vector<std::uint32_t> entry_begin_, junction_begin_;  ///< by cell, one more at the end
  std::vector<Entry> entries_;
  std::vector<JunctionId> junctions_;
};

}  // namespace sumogamma
