#include "study/safety/encroachment.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/units.h"
#include "geometry/convex_polygon.h"

namespace sumogamma {

namespace {

constexpr double kCell = 4.0;    // [m]
constexpr double kMoving = 0.1;  // who is slower crosses nothing [m/s]

std::uint64_t cell_key(double x, double y) {
  const auto column = static_cast<std::int32_t>(std::floor(x / kCell));
  const auto line = static_cast<std::int32_t>(std::floor(y / kCell));
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32) |
         static_cast<std::uint32_t>(line);
}

/// Calls with the key of each cell that the circle about a body touches.
template <typename Call>
void for_cells(const Vec2& center, double radius, Call&& call) {
  const double low_x = std::floor((center.x() - radius) / kCell);
  const double low_y = std::floor((center.y() - radius) / kCell);
  for (double x = low_x; x * kCell <= center.x() + radius; ++x)
    for (double y = low_y; y * kCell <= center.y() + radius; ++y)
      call(cell_key((x + 0.5) * kCell, (y + 0.5) * kCell));
}

double angle_between(double a, double b) { return std::abs(wrap_angle(a - b)); }

}  // namespace

const std::vector<Encroachment>& EncroachmentMonitor::add(const Scene& scene) {
  found_.clear();
  const auto count = static_cast<std::uint32_t>(scene.size());
  for (std::uint32_t row = 0; row < count; ++row)
    if (scene.velocity[row].norm() > kMoving) look(scene, row);
  for (std::uint32_t row = 0; row < count; ++row) remember(scene, row);
  if (scene.time >= next_cleaning_) {
    forget(scene.time - longest_);
    next_cleaning_ = scene.time + longest_;
  }
  return found_;
}

void EncroachmentMonitor::look(const Scene& scene, std::uint32_t row) {
  seen_.clear();
  const double now = scene.time, own = scene.heading[row];
  for_cells(scene.position[row], scene.footprint[row].radius, [&](std::uint64_t key) {
    const auto cell = cells_.find(key);
    if (cell == cells_.end()) return;
    for (const Visit& visit : cell->second)
      if (visit.id != scene.id[row] && now - visit.time <= longest_ &&
          angle_between(visit.heading, own) > kAlong)
        seen_.push_back(visit.id);
  });
  std::sort(seen_.begin(), seen_.end());
  seen_.erase(std::unique(seen_.begin(), seen_.end()), seen_.end());
  for (const AgentId other : seen_) find_latest(scene, row, other);
}

void EncroachmentMonitor::find_latest(const Scene& scene, std::uint32_t row, AgentId other) {
  const auto found = past_.find(other.value);
  if (found == past_.end()) return;
  const Past& past = found->second;
  const Vec2& position = scene.position[row];
  const double reach = scene.footprint[row].radius + past.footprint.radius;
  const ConvexPolygon own =
      place_polygon(scene.footprint[row].outline(), direction_of(scene.heading[row]));
  const auto overlaps = [&](const Vec2& place, double heading) {
    const Vec2 offset = place - position;
    return offset.squaredNorm() < reach * reach &&
           overlap_depth(own, place_polygon(past.footprint.outline(), direction_of(heading)),
                         offset) > 0.0;
  };
  // together on it: a collision
  if (const std::size_t present = find_row(scene, other); present < scene.size())
    if (overlaps(scene.position[present], scene.heading[present])) return;
  for (auto pose = past.poses.rbegin(); pose != past.poses.rend(); ++pose) {
    if (!overlaps(pose->position, pose->heading)) continue;
    // it was there at that moment and no longer a step later
    const double time = std::max(scene.time - pose->time - step_, 0.0);
    const double angle = angle_between(pose->heading, scene.heading[row]);
    if (time <= longest_ && angle > kAlong)
      found_.push_back({row, other, time, angle, 0.5 * (position + pose->position)});
    return;
  }
}

void EncroachmentMonitor::remember(const Scene& scene, std::uint32_t row) {
  Past& past = past_[scene.id[row].value];
  past.footprint = scene.footprint[row];
  past.poses.push_back({scene.time, scene.position[row], scene.heading[row]});
  while (scene.time - past.poses.front().time > longest_ + step_) past.poses.pop_front();
  const Visit visit{scene.id[row], scene.time, scene.heading[row]};
  for_cells(scene.position[row], scene.footprint[row].radius, [&](std::uint64_t key) {
    std::vector<Visit>& cell = cells_[key];
    const auto known = std::find_if(cell.begin(), cell.end(),
                                    [&](const Visit& one) { return one.id == visit.id; });
    if (known == cell.end())
      cell.push_back(visit);
    else
      *known = visit;
  });
}

void EncroachmentMonitor::forget(double before) {
  std::erase_if(past_, [&](const auto& one) { return one.second.poses.back().time < before; });
  for (auto cell = cells_.begin(); cell != cells_.end();) {
    std::erase_if(cell->second, [&](const Visit& visit) { return visit.time < before; });
    cell = cell->second.empty() ? cells_.erase(cell) : std::next(cell);
  }
}

}  // namespace sumogamma
