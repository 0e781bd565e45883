#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "geometry/vec2.h"

namespace sumogamma {

/// Boxes by the square cells that they touch, for finding those near a place without looking at all
/// of them. Boxes are told by the indices of whatever they are about.
class BoxGrid {
 public:
  /// Sides of the cells [m]: about those of most boxes.
  explicit BoxGrid(double cell) : cell_(cell) {}

  void add(std::uint32_t index, const Vec2& low, const Vec2& high) {
    visit_cells(low, high, [&](std::uint64_t key) { cells_[key].push_back(index); });
  }
  /// Boxes that touch the cell of a point, in the order in which they were added.
  const std::vector<std::uint32_t>& at(const Vec2& point) const {
    static const std::vector<std::uint32_t> kNone;
    const auto found = cells_.find(key(cell_of(point.x()), cell_of(point.y())));
    return found == cells_.end() ? kNone : found->second;
  }
  /// Boxes that touch the cells of a box, ascending, each once.
  std::vector<std::uint32_t> near(const Vec2& low, const Vec2& high) const {
    std::vector<std::uint32_t> found;
    visit_cells(low, high, [&](std::uint64_t key) {
      if (const auto entry = cells_.find(key); entry != cells_.end())
        found.insert(found.end(), entry->second.begin(), entry->second.end());
    });
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }

 private:
  std::int64_t cell_of(double coordinate) const {
    return static_cast<std::int64_t>(std::floor(coordinate / cell_));
  }
  static std::uint64_t key(std::int64_t column, std::int64_t row) {
    return (static_cast<std::uint64_t>(column + (1 << 30)) << 32) |
           static_cast<std::uint64_t>(row + (1 << 30));
  }
  template <typename Visit>
  void visit_cells(const Vec2& low, const Vec2& high, Visit visit) const {
    for (std::int64_t column = cell_of(low.x()); column <= cell_of(high.x()); ++column)
      for (std::int64_t row = cell_of(low.y()); row <= cell_of(high.y()); ++row)
        visit(key(column, row));
  }

  double cell_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;  ///< never iterated
};

}  // namespace sumogamma
