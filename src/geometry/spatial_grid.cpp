#include "geometry/spatial_grid.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {
constexpr double kLeastCell = 6.0;  // [m]
}

void SpatialGrid::rebuild(std::span<const Vec2> positions) {
  const std::size_t count = positions.size();
  entries_.resize(count);
  cell_of_.resize(count);
  if (count == 0) return;

  // the bulk: mean and mean distance from it, so that one agent far away doesn't blow up the cells
  // of all others
  Vec2 mean = Vec2::Zero(), spread = Vec2::Zero();
  double finite = 0;
  for (const Vec2& p : positions)
    if (p.allFinite()) mean += p, finite += 1;
  mean /= std::max(finite, 1.0);
  for (const Vec2& p : positions)
    if (p.allFinite()) spread += (p - mean).cwiseAbs();
  spread = (4.0 / std::max(finite, 1.0)) * spread + Vec2::Constant(kLeastCell);
  Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Vec2& p : positions)
    if (p.allFinite()) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  low = low.cwiseMax(mean - spread).cwiseMin(mean);
  high = high.cwiseMin(mean + spread).cwiseMax(mean);

  // cells of 8 m, larger where there would be many more of them than points
  const Vec2 extent = high - low + Vec2::Constant(1e-3);
  const double most_cells = 1024.0 + 16.0 * static_cast<double>(count);
  const double cell = std::max(kLeastCell, std::sqrt(extent.x() * extent.y() / most_cells));
  const double most_lines = most_cells;
  inverse_cell_ = 1.0 / cell;
  origin_ = low;
  columns_ = static_cast<std::size_t>(std::min(std::floor(extent.x() / cell), most_lines)) + 1;
  lines_ = static_cast<std::size_t>(std::min(std::floor(extent.y() / cell), most_lines)) + 1;

  // counting sort: stable, so rows stay in order within a cell
  cell_begin_.assign(columns_ * lines_ + 1, 0);
  for (std::size_t row = 0; row < count; ++row) {
    const std::size_t index = line(positions[row].y()) * columns_ + column(positions[row].x());
    cell_of_[row] = static_cast<std::uint32_t>(index);
    ++cell_begin_[index + 1];
  }
  for (std::size_t k = 1; k < cell_begin_.size(); ++k) cell_begin_[k] += cell_begin_[k - 1];
  for (std::size_t row = 0; row < count; ++row)
    entries_[cell_begin_[cell_of_[row]]++] = {positions[row], static_cast<std::uint32_t>(row)};
  // the fill moved every begin to the next cell's: move them back
  for (std::size_t k = cell_begin_.size() - 1; k > 0; --k) cell_begin_[k] = cell_begin_[k - 1];
  cell_begin_[0] = 0;
}

}  // namespace sumogamma
