#include "model/obstacle_index.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {

namespace {

constexpr double kMostCells = 4e6;

double distance_to(const ObstacleIndex::Side& side, const Vec2& point) {
  const Vec2 along = side.to - side.from;
  const double square = along.squaredNorm();
  const double t = square > 0 ? std::clamp((point - side.from).dot(along) / square, 0.0, 1.0) : 0.0;
  return (side.from + t * along - point).norm();
}

}  // namespace

std::size_t ObstacleIndex::cell_of(double offset, std::size_t count) const {
  const double cell = offset / cell_;
  if (!(cell > 0)) return 0;
  return cell >= static_cast<double>(count) ? count - 1 : static_cast<std::size_t>(cell);
}

ObstacleIndex::ObstacleIndex(const std::vector<Obstacle>& obstacles) {
  for (std::size_t k = 0; k < obstacles.size(); ++k) {
    const std::vector<Vec2>& outline = obstacles[k].outline;
    const bool closed = obstacles[k].kind != ObstacleKind::Barrier && outline.size() > 2;
    for (std::size_t m = 0; m + (closed ? 0 : 1) < outline.size(); ++m)
      sides_.push_back(
          {outline[m], outline[(m + 1) % outline.size()], static_cast<std::int32_t>(k)});
    if (outline.size() == 1)
      sides_.push_back({outline[0], outline[0], static_cast<std::int32_t>(k)});
  }
  std::erase_if(sides_, [](const Side& s) { return !s.from.allFinite() || !s.to.allFinite(); });
  if (sides_.empty()) return;

  Vec2 low = sides_[0].from, high = low;
  for (const Side& side : sides_) {
    low = low.cwiseMin(side.from).cwiseMin(side.to);
    high = high.cwiseMax(side.from).cwiseMax(side.to);
  }
  const Vec2 extent = high - low;
  cell_ = std::max(cell_, std::sqrt((extent.x() + cell_) * (extent.y() + cell_) / kMostCells));
  origin_ = low;
  columns_ = static_cast<std::size_t>(extent.x() / cell_) + 1;
  lines_ = static_cast<std::size_t>(extent.y() / cell_) + 1;

  // two passes over the cells of each side's bounding box: count, then fill
  auto for_each_cell = [&](auto&& visit) {
    for (std::uint32_t k = 0; k < sides_.size(); ++k) {
      const Vec2 a = sides_[k].from.cwiseMin(sides_[k].to) - origin_,
                 b = sides_[k].from.cwiseMax(sides_[k].to) - origin_;
      for (std::size_t y = cell_of(a.y(), lines_); y <= cell_of(b.y(), lines_); ++y)
        for (std::size_t x = cell_of(a.x(), columns_); x <= cell_of(b.x(), columns_); ++x)
          visit(y * columns_ + x, k);
    }
  };
  cell_begin_.assign(columns_ * lines_ + 1, 0);
  for_each_cell([&](std::size_t cell, std::uint32_t) { ++cell_begin_[cell + 1]; });
  for (std::size_t k = 1; k < cell_begin_.size(); ++k) cell_begin_[k] += cell_begin_[k - 1];
  cell_sides_.resize(cell_begin_.back());
  std::vector<std::uint32_t> next(cell_begin_.begin(), cell_begin_.end() - 1);
  for_each_cell([&](std::size_t cell, std::uint32_t k) { cell_sides_[next[cell]++] = k; });
}

void ObstacleIndex::find_near(const Vec2& center, double radius,
                              std::vector<std::uint32_t>& found) const {
  found.clear();
  if (sides_.empty() || !center.allFinite() || !(radius >= 0)) return;
  const Vec2 at = center - origin_;
  for (std::size_t y = cell_of(at.y() - radius, lines_); y <= cell_of(at.y() + radius, lines_); ++y)
    for (std::size_t x = cell_of(at.x() - radius, columns_);
         x <= cell_of(at.x() + radius, columns_); ++x)
      for (std::uint32_t k = cell_begin_[y * columns_ + x]; k < cell_begin_[y * columns_ + x + 1];
           ++k)
        if (distance_to(sides_[cell_sides_[k]], center) <= radius) found.push_back(cell_sides_[k]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
}

bool ObstacleIndex::is_between(const Vec2& from, const Vec2& to) const {
  if (empty()) return false;
  const Vec2 way = to - from;
  std::vector<std::uint32_t> found;
  find_near(0.5 * (from + to), 0.5 * way.norm(), found);
  return std::any_of(found.begin(), found.end(), [&](std::uint32_t index) {
    const auto share =
        crossing_shares(from, way, side(index).from, side(index).to - side(index).from);
    return share && share->minCoeff() >= 0.0 && share->maxCoeff() <= 1.0;
  });
}

}  // namespace sumogamma
