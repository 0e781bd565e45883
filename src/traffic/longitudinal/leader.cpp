#include "traffic/longitudinal/leader.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/extent.h"
#include "traffic/lateral/overtaking.h"
#include "traffic/lateral/passing.h"
#include "traffic/patience.h"
#include "traffic/perception.h"

namespace sumogamma {

namespace {

/// Somebody on foot who stands: at a kerb, as far as anyone can tell.
bool waits_at_kerb(const TrafficView& view, std::size_t row) {
  return stood(view, row) >= Patience::Waiting &&
         type_of(view.model.types, view.scene.type[row]).kinematics == Kinematics::Holonomic;
}

/// Do two bodies that head the same way, more or less, lie close together?
bool near_each_other(const TrafficView& view, std::size_t row, std::size_t other) {
  const Scene& scene = view.scene;
  const double reach =
      scene.footprint[row].radius + scene.footprint[other].radius + view.parameters.closed_up_gap;
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

/// Has somebody stood for long at its gate, waiting for a gap in the lane beside?
bool waits_long(const TrafficView& view, std::size_t row) {
  return std::isfinite(view.traffic.gate[row]) && stood(view, row) >= Patience::Pressing;
}

/// Has it been at that in a queue that creeps on?
bool creeps_long(const TrafficView& view, std::size_t row) {
  return std::isfinite(view.traffic.gate[row]) && waited(view, row) >= Patience::Pressing &&
         view.scene.speed[row] < view.parameters.queue_speed;
}

/// Has somebody on foot held up a vehicle for long who doesn't get on either?
bool shuffles_before(const TrafficView& view, std::size_t vehicle, std::size_t walker) {
  const LimitReason reason = view.scene.context[vehicle].reason;
  const bool no_rule = reason == LimitReason::Leader || reason == LimitReason::None;
  return no_rule && waited(view, vehicle) >= Patience::Pressing &&
         view.scene.velocity[walker].norm() < view.parameters.halting_speed;
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
  const LaneId lane = view.traffic.merge_to[other];
  if (lane == kNoLane || lane == view.scene.lane[row].lane) return lane != kNoLane;
  const auto& stretches = view.road.path(view.scene.path[row])->stretches;
  return (waits_long(view, other) || is_changing(view, other)) &&
         std::any_of(stretches.begin(), stretches.end(), [&](const PathStretch& stretch) {
           return stretch.lane == lane && stretch.to >= view.scene.path_along[row] &&
                  stretch.from <= along + view.parameters.soon_way;
         });
}

/// Does who is beside the tail of somebody that waits for long for a gap let its nose in, as who is
/// behind it does? In a dense queue beside a long body nobody is ever behind it. There is an end to
/// that, also for who has rolled on by a step meanwhile. `to_nose`: from the own nose to the way
/// that the other's needs [m].
bool lets_nose_in(const TrafficView& view, std::size_t row, std::size_t other, double to_nose) {
  return to_nose > 0.0 && (waits_long(view, other) || creeps_long(view, other)) &&
         stood(view, row) < Patience::Stuck && waited(view, row) < Patience::Desperate;
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
  return offset + view.traffic.lateral_aim[row] - view.perception.ego[row].offset;
}

/// Is somebody beside a vehicle, its middle ahead, where that means to be beside its path?
bool is_way_aside_taken(const TrafficView& view, std::size_t row) {
  const EgoOnPath& ego = view.perception.ego[row];
  const double aim = view.traffic.lateral_aim[row];
  if (std::abs(aim - ego.offset) < view.parameters.touching) return false;
  bool taken = false;
  visit_near(view, row, view.parameters.near, [&](std::size_t other) {
    if (taken) return;
    const Vec2 place = to_body(view.scene.position[other] - view.scene.position[row], ego.tangent);
    const double offset = ego.offset + place.y();
    taken = place.x() > 0.0 &&
            place.x() < ego.half_length + half_extent(view.scene, other, ego.tangent) &&
            place.y() * (aim - ego.offset) > 0.0 &&
            std::abs(offset - aim) <
                ego.half_width + half_extent(view.scene, other, left_of(ego.tangent));
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

/// A driver's own side of its look ahead.
struct Own : EgoOnPath {
  const TrafficView& view;
  std::size_t row;
  const Path& path;
  const AgentType& type;
  double aim, wanted;  ///< where beside its path it is on its way to, and means to be [m]
  double margin;       ///< kept to the sides [m]
  bool narrow, overtakes;
  bool returns;  ///< it gives up overtaking: falls back behind whoever it was about to pass
  bool taken;    ///< somebody is beside it where it means to be
};

Own own_side(const TrafficView& view, const Path& path, std::size_t row) {
  const Scene& scene = view.scene;
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const EgoOnPath& ego = view.perception.ego[row];
  const double wanted = view.traffic.passing_offset[row];
  const bool narrow = is_narrow(type.width);
  const bool overtakes = view.traffic.overtaking_room[row] > 0.0;
  return {ego,
          view,
          row,
          path,
          type,
          view.traffic.lateral_aim[row],
          wanted,
          kept_aside(type, scene.speed[row]),
          narrow,
          overtakes,
          !narrow && !overtakes && std::abs(ego.offset - wanted) > view.parameters.ample_side,
          narrow && stood(view, row) < Patience::Pressing && is_way_aside_taken(view, row)};
}

/// Somebody on a driver's way, as it sees it.
struct Seen {
  std::size_t other = 0;
  PolylinePosition place;  ///< on the driver's path
  Vec2 direction;          ///< of the path there
  double half_width = 0;   ///< across it [m]
  double rear = 0;         ///< along it [m]
  double gap = 0;          ///< from the own front to the rear [m]
  double speed = 0;        ///< along the path, >= 0 [m/s]
  double sides = 0;        ///< of both bodies [m]
  double clearance = 0;    ///< between them where the driver means to be [m]
  bool on_foot = false, aligned = false;
  bool passes = false;  ///< the driver means to pass it
  double front() const { return 2.0 * place.along - rear; }
};

/// Is somebody ahead? Of two abreast just one is: close together the one with its nose ahead.
bool is_ahead(const Own& own, std::size_t other, double along) {
  const Scene& scene = own.view.scene;
  const bool close = near_each_other(own.view, own.row, other);
  const double ahead_by = close ? nose_lead(scene, own.row, other) : along - own.along;
  const bool both_narrow =
      own.narrow && is_narrow(type_of(own.view.model.types, scene.type[other]).width);
  const double abreast =
      close || both_narrow ? own.view.parameters.line_tolerance : own.view.parameters.closed_up_gap;
  return ahead_by >= (scene.id[other] < scene.id[own.row] ? -abreast : abreast);
}

/// Where somebody is on the driver's way; none where it isn't ahead there.
std::optional<Seen> see(const Own& own, std::size_t other, double reach) {
  const Scene& scene = own.view.scene;
  // cheap rejection: well behind
  const double beyond = (scene.position[other] - scene.position[own.row]).dot(own.tangent);
  if (beyond < -reach * 0.3 - 10.0) return std::nullopt;
  Seen seen;
  seen.other = other;
  // who is narrow and waits for a gap from the far side of the lane beside is seen, too
  const double beside = own.half_width + scene.footprint[other].radius + own.margin;
  const double farthest = own.view.traffic.merge_to[other] == kNoLane
                              ? beside
                              : std::max(beside, own.view.parameters.near);
  seen.place = own.path.line.project_near(scene.position[other],
                                          own.along - 2.0 * own.view.parameters.closed_up_gap,
                                          own.along + reach, farthest);
  if (seen.place.distance > farthest) return std::nullopt;
  if (seen.place.distance > beside && !changes_into_way(own.view, own.row, other, seen.place.along))
    return std::nullopt;
  if (!is_ahead(own, other, seen.place.along)) return std::nullopt;
  seen.direction = own.path.line.direction_at(seen.place.along);
  seen.half_width = half_extent(own.view.scene, other, left_of(seen.direction));
  seen.rear = seen.place.along - half_extent(own.view.scene, other, seen.direction);
  seen.gap = seen.rear - own.along - own.half_length;
  seen.speed = std::max(0.0, scene.velocity[other].dot(seen.direction));
  seen.sides = own.half_width + seen.half_width;
  seen.clearance = std::abs(seen.place.offset - own.aim) - seen.sides;
  seen.on_foot =
      type_of(own.view.model.types, scene.type[other]).kinematics == Kinematics::Holonomic;
  seen.aligned = seen.direction.dot(direction_of(own.view.scene.heading[other])) > 0.5;
  // a narrow vehicle that means to pass is about to leave whoever is ahead of it now
  const bool clear_aside = seen.aligned && !seen.on_foot && seen.clearance > own.margin &&
                           (seen.place.offset - own.aim) * (seen.place.offset - own.offset) >= 0.0;
  seen.passes = clear_aside &&
                (own.narrow || (own.overtakes && is_narrow(2.0 * seen.half_width)) ||
                 stands_beside_lane(own.view, other, own.path.stretch_at(seen.place.along).lane,
                                    seen.place.offset));
  return seen;
}

/// Caps the speed at which the driver goes by somebody whom it passes, or lets into a gap for which
/// both make.
void pass(const Own& own, const Seen& seen, DrivingAhead& ahead) {
  const Scene& scene = own.view.scene;
  const std::int64_t id = scene.id[seen.other].value;
  if (seen.passes) {
    const double reach_aside = seen.gap < 0.0
                                   ? half_extent(own.view.scene, own.row, left_of(own.tangent))
                                   : own.half_width;
    const double apart = own.offset - seen.place.offset;
    const Passed passed{
        seen.gap,
        std::abs(apart) - seen.half_width - reach_aside,
        seen.clearance,
        std::copysign(1.0, apart) * cross(own.tangent, direction_of(scene.heading[own.row])),
        seen.speed,
        own.taken,
        own.narrow ? filtering_manner(own.view.parameters)
                   : overtaking_manner(own.view.parameters)};
    cap_passing(passing_speed(own.view.parameters, passed, own.type), id, ahead);
    if (own.narrow && seen.gap > 0.0 && passed.aside() > 0.0)
      ahead.turning_way = std::min(ahead.turning_way, seen.gap);
  }
  // two narrow ones make for the same gap: who is behind lets the other in
  if (own.narrow && seen.aligned && !seen.on_foot && is_narrow(2.0 * seen.half_width) &&
      stood(own.view, seen.other) < Patience::Waiting &&
      std::abs(aim_beside(own.view, seen.other, seen.place.offset) - own.aim) < seen.sides)
    cap_passing(std::max(0.0, scene.speed[seen.other] + own.view.parameters.gap_closing_rate *
                                                            (seen.gap - own.type.min_gap)),
                id, ahead);
}

/// Is somebody clear of what the driver's body sweeps? It drifts to where it means to be beside its
/// path: near ahead its own offset counts. Whoever is beside already, or waits at the kerb, is
/// passed as close as it comes.
bool is_clear_of_way(const Own& own, const Seen& seen) {
  const double blend = std::clamp(1.0 - (seen.place.along - own.along) / 15.0, 0.0, 1.0);
  const double swept = blend * own.offset + (1.0 - blend) * own.aim;
  const bool at_kerb = waits_at_kerb(own.view, seen.other);
  const double kept = at_kerb ? -0.35 : seen.gap < 0.0 ? 0.02 : own.margin;
  const bool comes_back =
      own.returns && seen.gap > 0.0 && std::abs(seen.place.offset - own.wanted) - seen.sides < kept;
  return std::abs(seen.place.offset - swept) > seen.sides + kept && !comes_back;
}

/// Somebody beside the driver's way who has to get into it.
void see_merging(const Own& own, const Seen& seen, DrivingAhead& ahead) {
  const TrafficState& traffic = own.view.traffic;
  const bool halted = stood(own.view, seen.other) >= Patience::Waiting;
  // who stands amid its change is passed like anybody else
  if (!changes_into_way(own.view, own.row, seen.other, seen.place.along) || (seen.passes && halted))
    return;
  const bool on_its_way = is_changing(own.view, seen.other);
  // two abreast want each other's lane: of them, too, who is ahead goes first, unless it has to
  // wait for this one to get out of its way
  const double own_front = own.along + own.half_length;
  const bool waits = halted && std::isfinite(traffic.gate[seen.other]) && seen.rear < own_front;
  const LaneId merge_to = traffic.merge_to[own.row];
  const bool swaps =
      !waits && merge_to != kNoLane && merge_to == own.view.scene.lane[seen.other].lane;
  const double front = seen.front(),
               nose_from = front - nose_room(own.view.parameters, front - seen.rear);
  // who is on its way already and has its middle ahead needs the room beside it, too
  const bool behind = on_its_way || swaps || seen.rear > own_front + 1.0;
  // from here on
  const double kept_free =
      behind ? seen.rear : nose_from - own.view.parameters.least_gap + own.type.min_gap;
  if (behind ||
      lets_nose_in(own.view, own.row, seen.other, nose_from - own.along - own.half_length))
    note_merging({kept_free, front, seen.speed,
                  static_cast<std::int64_t>(own.view.scene.id[seen.other].value), seen.other},
                 on_its_way || swaps, ahead);
}

/// Is somebody in the way a leader? Two vehicles across each other's way would wait for ever as
/// such: that is for right of way and avoidance. Somebody on foot is waited for, once near; who
/// waits in the way for long waits for this very vehicle as well as not: who crawls goes round as
/// close as avoidance lets it, and has the other step back.
bool is_followed(const Own& own, const Seen& seen) {
  if (seen.passes || seen.gap < -own.half_length) return false;
  if (!seen.aligned && (!seen.on_foot || seen.gap > 2.0 * own.speed + 3.0)) return false;
  return !(seen.on_foot && own.speed < own.view.parameters.crawling_speed &&
           (stood(own.view, seen.other) >= Patience::Impatient ||
            shuffles_before(own.view, own.row, seen.other)));
}

}  // namespace

double nose_room(const TrafficParameters& parameters, double length) {
  return std::min(parameters.near_line, parameters.nose_room_share * length);
}

Leader find_leader(const TrafficView& view, std::size_t row, double reach, DrivingAhead& ahead) {
  Leader leader;
  const Scene& scene = view.scene;
  const Path* path = view.road.path(scene.path[row]);
  if (path == nullptr) return leader;
  const Own own = own_side(view, *path, row);
  ahead.seen_to = own.along + reach;
  visit_near(view, row, reach, [&](std::size_t other) {
    const auto seen = see(own, other, reach);
    if (!seen) return;
    pass(own, *seen, ahead);
    if (is_clear_of_way(own, *seen)) return see_merging(own, *seen, ahead);
    if (!is_followed(own, *seen)) return;
    const std::int64_t id = scene.id[other].value;
    if (!seen->on_foot) ahead.add({seen->rear, seen->front(), seen->speed, id, other});
    if (seen->gap < leader.gap || (seen->gap == leader.gap && id < leader.id))
      leader = {seen->gap, seen->speed, scene.acceleration[other].dot(seen->direction), seen->rear,
                id};
  });
  return leader;
}

void see_queue(const TrafficView& view, std::size_t row, double to, DrivingAhead& ahead) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const Path* path = view.road.path(scene.path[row]);
  const double from = ahead.seen_to;
  if (path == nullptr || to <= from) return;
  ahead.seen_to = to;
  const double margin = kept_aside(type_of(model.types, scene.type[row]), scene.speed[row]);
  const Vec2 middle = path->line.point_at(0.5 * (from + to));
  visit_storey(view, row, middle, 0.5 * (to - from) + view.parameters.near, [&](std::size_t other) {
    if (type_of(model.types, scene.type[other]).kinematics == Kinematics::Holonomic) return;
    const PolylinePosition place = path->line.project(scene.position[other], from, to);
    if (place.distance > view.parameters.near || place.along <= from || place.along >= to) return;
    const Vec2 direction = path->line.direction_at(place.along);
    const double sides = view.perception.ego[row].half_width +
                         half_extent(view.scene, other, left_of(direction)) + margin;
    if (direction.dot(direction_of(view.scene.heading[other])) <= 0.5 ||
        std::abs(place.offset - view.traffic.lateral_aim[row]) > sides)
      return;
    const auto begin = ahead.vehicles.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(ahead.count);
    if (std::any_of(begin, end, [&](const auto& seen) { return seen.row == other; })) return;
    const double half = half_extent(view.scene, other, direction);
    ahead.add({place.along - half, place.along + half,
               std::max(0.0, scene.velocity[other].dot(direction)), scene.id[other].value, other});
  });
}

}  // namespace sumogamma
