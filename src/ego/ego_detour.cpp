#include "ego/ego_detour.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "planning/pursuit.h"
#include "road/detour.h"
#include "scene/extent.h"
#include "scene/locate.h"
#include "scene/storey.h"

namespace sumogamma {

namespace {

constexpr double kAhead = 25.0;     // of its way that is looked at [m]
constexpr double kFarthest = 50.0;  // to where it is back on its lanes [m]

/// The pose in which a body's centre is at a place of a line, along it.
AxlePose pose_on(const WheeledShape& shape, const Polyline& line, double along) {
  const Vec2 forward = line.direction_at(along);
  return {line.point_at(along) - shape.rear_axle_to_center * forward, heading_of(forward)};
}

/// Does a body whose centre moves along the line keep `margin` to everything that stands?
bool keeps_off(const WheeledShape& shape, const Polyline& line, double from, double to,
               const std::vector<OrientedBox>& bodies, double margin) {
  constexpr double kSpacing = 0.5;  // [m]
  const double end = std::min(to, line.length());
  for (double along = from; along <= end; along += kSpacing)
    if (overlaps_any(body_at(shape, pose_on(shape, line, along), margin), bodies)) return false;
  return true;
}

/// The first place beyond what stands on the line where a body has room for itself and some way to
/// come to it; none where that is too far off.
std::optional<double> place_beyond(const WheeledShape& shape, const Polyline& line, double from,
                                   double end, const std::vector<OrientedBox>& bodies,
                                   double margin) {
  constexpr double kSearchStep = 1.0, kRunIn = 8.0;  // [m]
  bool blocked = false;
  for (double along = from + kSearchStep; along <= end; along += kSearchStep) {
    const bool free = keeps_off(shape, line, along, along + kSearchStep, bodies, margin);
    if (blocked && free && keeps_off(shape, line, along, along + kRunIn, bodies, margin))
      return std::min(along + kRunIn, end);
    blocked |= !free;
  }
  return blocked ? std::nullopt : std::optional(std::min(from + kAhead, end));
}

/// What a way round is looked for with.
struct Care {
  double margin = 0;    ///< kept to what stands [m]
  double steering = 0;  ///< front wheel angle at most [rad]
};
// Planners keep more than Hybrid A* has to: the first margin is what a crash is for them. At ease a
// car turns within 10 m, which it follows at 5 m/s; with its wheels at the lock it does at a walk.
constexpr Care kCares[] = {{EgoControl{}.side_margin, 0.25}, {0.3, 0.25}, {0.3, 0.61}};

/// The piece of a lane path that a way is to lead past.
struct Passed {
  const Path& lanes;
  double from, to;  ///< [m]
  const std::vector<OrientedBox>& bodies;
};

/// Centres of the body on a way that Hybrid A* finds from its place back onto its lanes; empty
/// where there is none.
std::vector<Vec2> way_past(const Model& model, const Scene& scene, std::size_t row,
                           const Passed& passed, const Care& care) {
  const WheeledShape shape = wheeled_shape(type_of(model.types, scene.type[row]), care.steering);
  const Vec2 forward = direction_of(scene.heading[row]);
  const AxlePose start{scene.position[row] - shape.rear_axle_to_center * forward,
                       scene.heading[row]};
  std::vector<std::uint32_t> sides;
  model.obstacles.find_near(scene.position[row], kFarthest, sides);
  std::vector<Wall> walls;
  for (const std::uint32_t side : sides)
    walls.push_back({model.obstacles.side(side).from, model.obstacles.side(side).to});
  const HybridAStarParameters search{.margin = care.margin};
  const DrivableSpace space{.lanes = &passed.lanes,
                            .bodies = passed.bodies,
                            .walls = walls,
                            .lanes_from = passed.from - search.reach,
                            .lanes_to = passed.to + search.reach};
  const AxlePose goal = pose_on(shape, passed.lanes.line, passed.to);
  std::vector<Vec2> centres;
  for (const AxlePose& pose : find_way(shape, start, goal, space, search).poses)
    centres.push_back(body_at(shape, pose).center);
  return centres;
}

}  // namespace

void EgoDetour::note_standing(const Scene& scene, double period) {
  constexpr double kStands = 0.1;  // slower is standing [m/s]
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const std::uint32_t id = scene.id[row].value;
    if (scene.velocity[row].norm() >= kStands)
      stood_.erase(id);
    else
      stood_[id] += period;
  }
}

std::vector<OrientedBox> EgoDetour::bodies_in_the_way(const EgoTrip& trip,
                                                      const Scene& scene) const {
  constexpr double kLong = 3.0;  // [s]
  std::vector<OrientedBox> bodies;
  for (std::size_t other = 0; other < scene.size(); ++other) {
    const auto stood = stood_.find(scene.id[other].value);
    if (other == trip.row || stood == stood_.end() || stood->second < kLong) continue;
    const bool parks = scene.control[other] == Control::Parked || scene.halt[other].left > 0.0;
    if ((trip.rules && !parks) ||
        (scene.position[other] - scene.position[trip.row]).norm() > kFarthest ||
        on_other_storey(trip.model.road, scene, trip.row, other))
      continue;
    bodies.push_back(box_of(scene, other));
  }
  return bodies;
}

void EgoDetour::look(const EgoTrip& trip, double period, Scene& scene, RoadState& road) {
  constexpr double kOff = 1.0;      // [m]
  constexpr double kAgain = 1.0;    // [s]
  constexpr double kBetween = 0.1;  // a way is straight between its poses [m]
  const auto& [model, goal, row, rules] = trip;
  note_standing(scene, period);
  wait_ -= period;
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr || path->walking || !path->trip || wait_ > 0.0) return;
  if (path != detour_.get()) lanes_ = road.paths[static_cast<std::size_t>(scene.path[row])];
  const std::vector<OrientedBox> bodies = bodies_in_the_way(trip, scene);
  const WheeledShape shape = wheeled_shape(type_of(model.types, scene.type[row]));
  const double off = std::abs(locate_on_path(model.road, road, scene, row));
  const double here = scene.path_along[row];
  const bool is_off = off > kOff;
  if (bodies.empty() && !is_off) return;
  const Polyline& lanes = lanes_->line;
  const double along = lanes.project(scene.position[row], here - kFarthest, here + kFarthest).along;
  const double end = std::min(along + kFarthest, lanes.project(goal.position).along);
  for (const Care& care : kCares) {
    const double margin = care.margin;
    if (path == detour_.get() && margin > margin_) continue;
    // who is nearer to somebody than that already may stay so for its own length
    OrientedBox room = box_of(scene, row);
    room.half += Vec2(margin, margin);
    const double first = overlaps_any(room, bodies) ? shape.length : 0.0;
    if (!is_off &&
        keeps_off(shape, path->line, here + first, here + kAhead, bodies, margin - kBetween))
      return;
    const auto to = place_beyond(shape, lanes, along + first, end, bodies, margin);
    if (!to || *to <= along + 1.0) continue;
    wait_ = kAgain;
    const auto points = way_past(model, scene, row, {*lanes_, along, *to, bodies}, care);
    if (points.size() < 2) continue;
    take_path(with_detour(*lanes_, along, *to, points), along + off, row, road, scene);
    detour_ = road.paths[static_cast<std::size_t>(scene.path[row])];
    margin_ = margin;
    ++taken_;
    return;
  }
  if (wait_ > 0.0) ++missed_;
}

}  // namespace sumogamma
