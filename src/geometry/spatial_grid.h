#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Points sorted into square cells, rebuilt every tick. Rows of cells lie one after the other in
/// memory, so that a query reads a few contiguous runs. Points far outside the bulk share the
/// border cells: answers stay exact.
class SpatialGrid {
 public:
  /// A point with its row, in the grid's order (by cell, then by row).
  struct Entry {
    Vec2 position;
    std::uint32_t row = 0;
  };

  /// Sorts the points. No allocation while their number stays within what was seen before. Not
  /// finite coordinates count as the border.
  void rebuild(std::span<const Vec2> positions);

  /// Calls visit(first, last) with the runs of entries() whose cells lie within `radius` [m] of
  /// `center` along both axes: all points within the radius are among them.
  template <typename Visit>
  void visit_runs(const Vec2& center, double radius, Visit&& visit) const {
    if (entries_.empty() || !(radius >= 0)) return;
    const std::size_t left = column(center.x() - radius), right = column(center.x() + radius);
    const std::size_t bottom = line(center.y() - radius), top = line(center.y() + radius);
    for (std::size_t y = bottom; y <= top; ++y)
      visit(cell_begin_[y * columns_ + left], cell_begin_[y * columns_ + right + 1]);
  }

  /// Calls visit(row, squared distance) for every point within `radius` [m] of `center`, in the
  /// grid's order.
  template <typename Visit>
  void visit_within(const Vec2& center, double radius, Visit&& visit) const {
    const double reach = radius * radius;
    visit_runs(center, radius, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t k = first; k < last; ++k) {
        const double distance = (entries_[k].position - center).squaredNorm();
        if (distance <= reach) visit(entries_[k].row, distance);
      }
    });
  }

  /// Rows in the grid's order.
  std::span<const Entry> entries() const { return entries_; }

 private:
  std::size_t column(double x) const { return cell_index(x - origin_.x(), columns_); }
  std::size_t line(double y) const { return cell_index(y - origin_.y(), lines_); }
  std::size_t cell_index(double offset, std::size_t count) const {
    const double cell = offset * inverse_cell_;
    // a comparison that is false for NaN sends it to the first cell
    if (!(cell > 0)) return 0;
    // signed on the way: the quicker conversion
    return cell >= static_cast<double>(count)
               ? count - 1
               : static_cast<std::size_t>(static_cast<std::int64_t>(cell));
  }

  std::vector<Entry> entries_;
  std::vector<std::uint32_t> cell_begin_;  ///< first entry of each cell, one more at the end
  std::vector<std::uint32_t> cell_of_;     ///< cell of each row
  Vec2 origin_ = Vec2::Zero();
  double inverse_cell_ = 1.0;
  std::size_t columns_ = 1, lines_ = 1;
};

}  // namespace sumogamma
