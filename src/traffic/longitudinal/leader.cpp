#include "traffic/longitudinal/leader.h"

#include <algorithm>
#include <cmath>

#include "scene/extent.h"
#include "scene/storey.h"
#include "traffic/lateral/overtaking.h"
#include "traffic/lateral/passing.h"

namespace sumogamma {

namespace {

constexpr double kAbreast = 1.5;    // between the middles [m]
constexpr double kNoseAhead = 0.3;  // likewise of narrow vehicles [m]

/// Somebody on foot who stands: at a kerb, as far as anyone can tell.
bool waits_at_kerb(const Model& model, const Scene& scene, std::size_t row) {
  return scene.held[row].standing > 1.5 &&
         type_of(model.types, scene.type[row]).kinematics == Kinematics::Holonomic;
}

/// Do two bodies that head the same way, more or less, lie close together?
bool near_each_other(const Scene& scene, std::size_t row, std::size_t other) {
  constexpr double kClose = 1.0;  // [m]
  const double reach = scene.footprint[row].radius + scene.footprint[other].radius + kClose;
  return (scene.position[other] - scene.position[row]).norm() < reach &&
         direction_of(scene.heading[other]).dot(direction_of(scene.heading[row])) > 0.0;
}

/// How far the nose of `other` is ahead of the one of `row` [m], seen along the mean of their
/// headings: just as far as the one of `row` is behind the other. Along their paths, which may
/// cross, either might be ahead of the other, and both would wait.
double nose_lead(const Scene& scene, std::size_t row, std::size_t other) {
  const Vec2 mean =
      (direction_of(scene.heading[row]) + direction_of(scene.heading[other])).normalized();
  return (scene.position[other] - scene.position[row]).dot(mean) + half_extent(scene, other, mean) -
         half_extent(scene, row, mean);
}

constexpr double kTakenFor = 10.0;    // is waited for who stands there [s]
constexpr double kHesitates = 2.0;    // [s]
constexpr double kCloses = 0.5;       // of the gap in a second
constexpr double kFarAside = 0.8;     // [m]
constexpr double kLaneBeside = 4.5;   // [m]
constexpr double kCrawl = 1.0;        // [m/s]
constexpr double kHaltsBefore = 0.5;  // who leaves the way for a nose [m]
constexpr double kPatience = 6.0;     // with somebody on foot who stands in the way [s]

constexpr Manner kOvertaking{kOvertakingGap - 0.2, 0.9, 1.5};

/// Has somebody stood for long at its gate, waiting for a gap in the lane beside?
bool waits_long(const TrafficView& view, std::size_t row) {
  constexpr double kLong = 10.0;  // [s]
  return std::isfinite(view.traffic.gate[row]) && view.scene.held[row].standing > kLong;
}

/// Has it been at that in a queue that creeps on?
bool creeps_long(const TrafficView& view, std::size_t row) {
  constexpr double kLong = 10.0, kCreeps = 3.0;  // [s], [m/s]
  return std::isfinite(view.traffic.gate[row]) && view.traffic.waiting_time[row] > kLong &&
         view.scene.speed[row] < kCreeps;
}

/// Has somebody on foot held up a vehicle for long who doesn't get on either?
bool shuffles_before(const TrafficView& view, std::size_t vehicle, std::size_t walker) {
  constexpr double kShuffles = 0.5;  // [m/s]
  const LimitReason reason = view.scene.context[vehicle].reason;
  const bool no_rule = reason == LimitReason::Leader || reason == LimitReason::None;
  return no_rule && view.traffic.waiting_time[vehicle] > 2.0 * kPatience &&
         view.scene.velocity[walker].norm() < kShuffles;
}

/// Is somebody amid a lane change, and hasn't halted there to let others past?
bool is_changing(const TrafficView& view, std::size_t row) {
  const Path* path = view.road.path(view.scene.path[row]);
  return path != nullptr && !std::isfinite(view.traffic.gate[row]) &&
         path->stretch_at(view.scene.path_along[row]).changing;
}

/// Does somebody who is `along` on the path of a row change, or want to, into its lane? Who is at
/// it or has waited for long counts as well where the row is about to get into that lane.
bool changes_into_way(const TrafficView& view, std::size_t row, std::size_t other, double along) {
  constexpr double kSoon = 10.0;  // [m]
  const LaneId lane = view.traffic.merge_to[other];
  if (lane == kNoLane || lane == view.scene.lane[row].lane) return lane != kNoLane;
  const auto& stretches = view.road.path(view.scene.path[row])->stretches;
  return (waits_long(view, other) || is_changing(view, other)) &&
         std::any_of(stretches.begin(), stretches.end(), [&](const PathStretch& stretch) {
           return stretch.lane == lane && stretch.to >= view.scene.path_along[row] &&
                  stretch.from <= along + kSoon;
         });
}

/// Does who is beside the tail of somebody that waits for long for a gap let its nose in, as who is
/// behind it does? In a dense queue beside a long body nobody is ever behind it. There is an end to
/// that, also for who has rolled on by a step meanwhile. `to_nose`: from the own nose to the way
/// that the other's needs [m].
bool lets_nose_in(const TrafficView& view, std::size_t row, std::size_t other, double to_nose) {
  constexpr double kHolds = 20.0;  // [s]
  return to_nose > 0.0 && (waits_long(view, other) || creeps_long(view, other)) &&
         view.scene.held[row].standing < kHolds && view.traffic.waiting_time[row] < 2.0 * kHolds;
}

/// Remembers the nearest of those ahead who wait for a gap in this lane or are on their way into
/// it.
void note_merging(const DrivingAhead::Vehicle& vehicle, bool on_its_way, DrivingAhead& ahead) {
  if (ahead.merging.id >= 0 && ahead.merging.rear <= vehicle.rear) return;
  ahead.merging = vehicle;
  ahead.on_its_way = on_its_way;
}

/// Where somebody means to be, beside the path of another at whose `offset` it is [m].
double aim_beside(const TrafficView& view, std::size_t row, double offset) {
  const Path* path = view.road.path(view.scene.path[row]);
  if (path == nullptr || path->walking) return offset;
  const double along = view.scene.path_along[row];
  const double own =
      cross(path->line.direction_at(along), view.scene.position[row] - path->line.point_at(along));
  return offset + view.traffic.lateral_aim[row] - own;
}

/// Is somebody beside a vehicle, its middle ahead, where that means to be beside its path?
bool is_way_aside_taken(const TrafficView& view, const Path& path, std::size_t row,
                        double own_offset) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const SpatialGrid& grid = view.grid;
  constexpr double kThere = 0.1, kNear = 5.0;  // [m]
  const double aim = traffic.lateral_aim[row], along = scene.path_along[row];
  if (std::abs(aim - own_offset) < kThere) return false;
  const Vec2 tangent = path.line.direction_at(along), left = left_of(tangent);
  const double half_length = half_extent(scene, row, tangent);
  const double half_width = half_extent(scene, row, left_of(direction_of(scene.heading[row])));
  bool taken = false;
  grid.visit_within(scene.position[row], kNear, [&](std::size_t other, double) {
    if (other == row || taken || on_other_storey(model.road, scene, row, other)) return;
    const Vec2 place = to_body(scene.position[other] - scene.position[row], tangent);
    const double offset = own_offset + place.y();
    taken = place.x() > 0.0 && place.x() < half_length + half_extent(scene, other, tangent) &&
            place.y() * (aim - own_offset) > 0.0 &&
            std::abs(offset - aim) < half_width + half_extent(scene, other, left);
  });
  return taken;
}

/// Kept to the sides by who drives past others [m].
double kept_aside(const AgentType& type, double speed) {
  return std::min(0.1 + 0.03 * speed, type.width < 1.0 ? 0.15 : 0.3);
}

void cap_passing(double speed, std::int64_t id, DrivingAhead& ahead) {
  if (speed >= ahead.passing_speed) return;
  ahead.passing_speed = speed;
  ahead.passed = id;
}

}  // namespace

double nose_room(double length) {
  constexpr double kMost = 2.5, kShare = 0.6;  // [m], of the length
  return std::min(kMost, kShare * length);
}

Leader find_leader(const TrafficView& view, std::size_t row, double reach, DrivingAhead& ahead) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const SpatialGrid& grid = view.grid;
  Leader leader;
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr) return leader;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const double along = scene.path_along[row];
  const Vec2 tangent = path->line.direction_at(along);
  const Vec2 position = scene.position[row];
  const double own_half_length = half_extent(scene, row, tangent);
  const Vec2 forward = direction_of(scene.heading[row]);
  const double own_half_width = half_extent(scene, row, left_of(forward));
  const double own_offset = cross(tangent, position - path->line.point_at(along));
  const double speed = scene.speed[row];
  const double aim = traffic.lateral_aim[row];
  const bool narrow = is_narrow(type.width);
  const bool overtakes = traffic.overtaking_room[row] > 0.0;
  // who gives up overtaking falls back behind whoever it was about to pass
  const double wanted = traffic.passing_offset[row];
  const bool returns = !narrow && !overtakes && std::abs(own_offset - wanted) > kFarAside;
  const double margin = kept_aside(type, speed);
  ahead.seen_to = along + reach;

  const bool taken = narrow && scene.held[row].standing < kTakenFor &&
                     is_way_aside_taken(view, *path, row, own_offset);

  grid.visit_within(position, reach, [&](std::size_t other, double) {
    if (other == row || on_other_storey(model.road, scene, row, other)) return;
    // cheap rejection: well behind
    if ((scene.position[other] - position).dot(tangent) < -reach * 0.3 - 10.0) return;
    const PolylinePosition place =
        path->line.project(scene.position[other], along - 2.0 * kAbreast, along + reach);
    // who is narrow and waits for a gap from the far side of the lane beside is seen, too
    if (place.distance > own_half_width + scene.footprint[other].radius + margin &&
        (place.distance > kLaneBeside || !changes_into_way(view, row, other, place.along)))
      return;
    // of two abreast just one is ahead: close together the one with its nose ahead
    const bool close = near_each_other(scene, row, other);
    const double ahead_by = close ? nose_lead(scene, row, other) : place.along - along;
    const double abreast =
        close || (narrow && is_narrow(type_of(model.types, scene.type[other]).width)) ? kNoseAhead
                                                                                      : kAbreast;
    if (ahead_by < (scene.id[other] < scene.id[row] ? -abreast : abreast)) return;
    const Vec2 direction = path->line.direction_at(place.along);
    const double half_width = half_extent(scene, other, left_of(direction));
    // the body drifts to where it means to be beside its path: near ahead its own offset counts
    const double blend = std::clamp(1.0 - (place.along - along) / 15.0, 0.0, 1.0);
    const double swept = blend * own_offset + (1.0 - blend) * aim;
    const double rear = place.along - half_extent(scene, other, direction);
    const double gap = rear - along - own_half_length;
    // whoever is beside already, or waits at the kerb, is passed as close as it comes
    const bool at_kerb = waits_at_kerb(model, scene, other);
    const double kept = at_kerb ? -0.35 : gap < 0.0 ? 0.02 : margin;
    const bool on_foot =
        type_of(model.types, scene.type[other]).kinematics == Kinematics::Holonomic;
    const bool aligned = direction.dot(direction_of(scene.heading[other])) > 0.5;
    const double sides = own_half_width + half_width;
    // a narrow vehicle that means to pass is about to leave whoever is ahead of it now
    const double clearance = std::abs(place.offset - aim) - sides;
    const bool clear_aside = aligned && !on_foot && clearance > margin &&
                             (place.offset - aim) * (place.offset - own_offset) >= 0.0;
    const bool passes =
        clear_aside &&
        (narrow || (overtakes && is_narrow(2.0 * half_width)) ||
         stands_beside_lane(view, other, path->stretch_at(place.along).lane, place.offset));
    if (passes) {
      const double reach_aside =
          gap < 0.0 ? half_extent(scene, row, left_of(tangent)) : own_half_width;
      const double apart = own_offset - place.offset;
      const Passed passed{gap,
                          std::abs(apart) - half_width - reach_aside,
                          clearance,
                          std::copysign(1.0, apart) * cross(tangent, forward),
                          std::max(0.0, scene.velocity[other].dot(direction)),
                          taken,
                          narrow ? Manner{} : kOvertaking};
      cap_passing(passing_speed(passed, type), scene.id[other].value, ahead);
      if (narrow && gap > 0.0 && passed.aside() > 0.0)
        ahead.turning_way = std::min(ahead.turning_way, gap);
    }
    // two narrow ones make for the same gap: who is behind lets the other in
    if (narrow && aligned && !on_foot && is_narrow(2.0 * half_width) &&
        scene.held[other].standing < kHesitates &&
        std::abs(aim_beside(view, other, place.offset) - aim) < sides)
      cap_passing(std::max(0.0, scene.speed[other] + kCloses * (gap - type.min_gap)),
                  scene.id[other].value, ahead);
    const bool comes_back = returns && gap > 0.0 && std::abs(place.offset - wanted) - sides < kept;
    if (std::abs(place.offset - swept) > sides + kept && !comes_back) {
      const bool merges = changes_into_way(view, row, other, place.along);
      const bool halted = scene.held[other].standing > kHesitates;
      // who stands amid its change is passed like anybody else
      if (!merges || (passes && halted)) return;
      const bool on_its_way = is_changing(view, other);
      // two abreast want each other's lane: of them, too, who is ahead goes first, unless it has to
      // wait for this one to get out of its way
      const bool waits =
          halted && std::isfinite(traffic.gate[other]) && rear < along + own_half_length;
      const bool swaps = !waits && traffic.merge_to[row] != kNoLane &&
                         traffic.merge_to[row] == scene.lane[other].lane;
      const double front = 2.0 * place.along - rear;
      const double nose_from = front - nose_room(front - rear);
      // who is on its way already and has its middle ahead needs the room beside it, too
      const bool behind = on_its_way || swaps || rear > along + own_half_length + 1.0;
      const double kept_free =
          behind ? rear : nose_from - kHaltsBefore + type.min_gap;  // from here on
      if (behind || lets_nose_in(view, row, other, nose_from - along - own_half_length))
        note_merging({kept_free, front, std::max(0.0, scene.velocity[other].dot(direction)),
                      static_cast<std::int64_t>(scene.id[other].value), other},
                     on_its_way || swaps, ahead);
      return;
    }
    if (passes || gap < -own_half_length) return;
    const Vec2 velocity = scene.velocity[other];
    const double other_speed = std::max(0.0, velocity.dot(direction));
    // two vehicles across each other's way would wait for ever as leaders: that is for right of way
    // and avoidance. Somebody on foot in the way is waited for, once near
    if (!aligned && (!on_foot || gap > 2.0 * speed + 3.0)) return;
    // somebody on foot who waits in the way for long waits for this very vehicle as well as not:
    // who crawls goes round as close as avoidance lets it, and has the other step back
    if (on_foot && speed < kCrawl &&
        (scene.held[other].standing > kPatience || shuffles_before(view, row, other)))
      return;
    if (!on_foot)
      ahead.add({rear, 2.0 * place.along - rear, other_speed, scene.id[other].value, other});
    if (gap < leader.gap || (gap == leader.gap && scene.id[other].value < leader.id))
      leader = {gap, other_speed, scene.acceleration[other].dot(direction), rear,
                scene.id[other].value};
  });
  return leader;
}

void see_queue(const TrafficView& view, std::size_t row, double to, DrivingAhead& ahead) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const SpatialGrid& grid = view.grid;
  const Path* path = road.path(scene.path[row]);
  const double from = ahead.seen_to;
  if (path == nullptr || to <= from) return;
  ahead.seen_to = to;
  constexpr double kAside = 6.0;  // [m]
  const double half_width = half_extent(scene, row, left_of(direction_of(scene.heading[row])));
  const double margin = kept_aside(type_of(model.types, scene.type[row]), scene.speed[row]);
  const Vec2 middle = path->line.point_at(0.5 * (from + to));
  grid.visit_within(middle, 0.5 * (to - from) + kAside, [&](std::size_t other, double) {
    if (other == row || type_of(model.types, scene.type[other]).kinematics == Kinematics::Holonomic)
      return;
    const PolylinePosition place = path->line.project(scene.position[other], from, to);
    if (place.distance > kAside || place.along <= from || place.along >= to) return;
    const Vec2 direction = path->line.direction_at(place.along);
    const double sides = half_width + half_extent(scene, other, left_of(direction)) + margin;
    if (direction.dot(direction_of(scene.heading[other])) <= 0.5 ||
        std::abs(place.offset - traffic.lateral_aim[row]) > sides ||
        on_other_storey(model.road, scene, row, other))
      return;
    const auto begin = ahead.vehicles.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(ahead.count);
    if (std::any_of(begin, end, [&](const auto& seen) { return seen.row == other; })) return;
    const double half = half_extent(scene, other, direction);
    ahead.add({place.along - half, place.along + half,
               std::max(0.0, scene.velocity[other].dot(direction)), scene.id[other].value, other});
  });
}

}  // namespace sumogamma
