#include "traffic/lateral/lane_choice.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/locate.h"
#include "traffic/junction/arbitration.h"
#include "traffic/lateral/exit_lane.h"
#include "traffic/lateral/gap_acceptance.h"
#include "traffic/lateral/overtaking.h"
#include "traffic/lateral/passing.h"
#include "traffic/patience.h"
#include "traffic/walking/walking_place.h"

namespace sumogamma {

namespace {

/// Way over which lanes are changed at some speed [m].
double way_of_change(const TrafficParameters& parameters, double speed) {
  return std::max(parameters.soon * speed, parameters.soon_way);
}

/// Does it halt before it would be back in its lane, if it left that? Whoever stands there, another
/// bus at the stop, is waited for: passing it leads past the stop, or to it askew.
bool halts_soon(const TrafficView& view, const Path& path, const Surroundings& around,
                std::size_t row) {
  const PathStop* stop = next_stop(path, view.scene, row);
  if (stop == nullptr || waited(view, row) >= Patience::Impatient) return false;
  return stop->along - stop->room - around.along <
         2.0 * way_of_change(view.parameters, around.speed);
}

/// As far as a driver looks for others [m]: where there is a lane beside, for those who come from
/// behind at full speed, too.
double driver_outlook(const TrafficView& view, const Path& path, std::size_t row) {
  const Scene& scene = view.scene;
  const TrafficParameters& parameters = view.parameters;
  const Lane& lane = view.model.road.lane(path.stretch_at(scene.path_along[row]).lane);
  const bool alone = lane.inner == kNoLane && lane.outer == kNoLane;
  const double speed = alone ? scene.speed[row] : std::max(scene.speed[row], lane.speed_limit);
  return std::min(parameters.junction_outlook + parameters.soon * speed, parameters.queue_outlook);
}

/// How far aside the middle of a neighbouring lane of the same edge lies [m, positive left].
double shift_to(const Model& model, const Lane& from, const Lane& to) {
  const double inner = model.road.left_hand ? -1.0 : 1.0;
  return (to.index > from.index ? inner : -inner) * 0.5 * (from.width + to.width);
}

/// Does a lane run into one with the lane of the path, soon after `along`? Who drives faster there
/// gains nothing by changing: it is let in at the end.
bool run_together_soon(const TrafficView& view, const Path& path, double along, LaneId other) {
  const auto link = path.link_from(along);
  if (link == path.links.end() || link->stop_line - along > view.parameters.queue_outlook)
    return false;
  const auto& outgoing = view.model.road.lane(other).outgoing;
  return std::any_of(outgoing.begin(), outgoing.end(), [&](ConnectionId id) {
    return runs_together(view.model, link->connection, id);
  });
}

/// Way from `along` to behind the last signal within `reach` [m], 0 where there is none.
double way_to_last_light(const RoadNetwork& network, const Path& path, double along, double reach) {
  double way = 0.0;
  for (auto link = path.link_from(along); link != path.links.end(); ++link) {
    if (link->end > along + reach) break;
    if (network.connection(link->connection).signal != kNoSignal) way = link->end - along;
  }
  return way;
}

/// The neighbouring lane on which this agent would rather be, kNoLane where it stays.
LaneId better_lane(const TrafficView& view, const LaneQueues& queues, const Path& path,
                   const Surroundings& around, std::size_t row) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const PathStretch& here = path.stretch_at(around.along);
  const double distance = way_of_change(view.parameters, around.speed);
  const Lane& lane = model.road.lane(here.lane);
  if (lane.kind != LaneKind::Normal || here.changing ||
      around.speed < view.parameters.queue_speed || std::abs(around.offset) > 1.2 ||
      here.to - around.along < distance + 2.0 || around.along - here.from < around.half_length)
    return kNoLane;
  const auto& options = path.trip->options[static_cast<std::size_t>(here.route_index)];
  const double on_lane = here.lane_from + around.along - here.from;
  const double free_speed = std::min(path.profile_at(around.along), scene.preferred_speed[row]);
  const double stay = hoped_speed(view.parameters, around, 0.0, free_speed, 0.3);
  const double left_here = options[static_cast<std::size_t>(lane.index)].drivable - on_lane;

  LaneId best = kNoLane;
  double most = stay + view.parameters.worthwhile_gain;
  for (const LaneId id : {lane.inner, lane.outer}) {
    if (id == kNoLane) continue;
    const Lane& other = model.road.lane(id);
    const LaneOption& option = options[static_cast<std::size_t>(other.index)];
    if (option.cost == std::numeric_limits<double>::infinity()) continue;
    // it must lead on for long enough to be worth it, or as far as this one
    const double left_there = option.drivable - on_lane;
    if (left_there < left_here - 1.0) {
      // who passes a queue has to get back into it; not at a light at which both lanes go on
      const double light = way_to_last_light(model.road, path, around.along, left_there);
      if (left_there - queue_ahead(queues, path, around.along + light, left_there - light) <
          std::max(150.0, 12.0 * around.speed))
        continue;
    }
    const double shift = shift_to(model, lane, other);
    const double there = hoped_speed(view.parameters, around, shift,
                                     std::min(free_speed, other.speed_limit * 1.2), 0.3);
    if (there <= most || there < view.parameters.queue_speed ||
        !is_gap(view, around, row, {.shift = shift, .middle = &other.centerline},
                view.parameters.easy_braking) ||
        run_together_soon(view, path, around.along, id))
      continue;
    most = there;
    best = id;
  }
  return best;
}

/// The next planned lane change of a path from `along` on; null where none begins within `reach`.
const PathStretch* next_change(const Path& path, double along, double reach) {
  for (const PathStretch& stretch : path.stretches) {
    if (stretch.from > along + reach) break;
    if (stretch.changing && stretch.from > along) return &stretch;
  }
  return nullptr;
}

/// Is a narrow vehicle on its way past somebody beside its lane? Then it stays on its path.
bool filters(const TrafficView& view, const Surroundings& around, std::size_t row) {
  return is_narrow(2.0 * around.half_width) &&
         std::abs(view.traffic.passing_offset[row] - view.scene.manners[row].path_offset) >
             view.parameters.side_clearance;
}

/// A lane change that the trip needs waits for its gap: says so to whoever may leave one, closes
/// the gate at its begin while there is none, and begins it over the way that its speed asks for.
void wait_for_gap(const TrafficView& view, const Path& path, const Surroundings& around,
                  std::size_t row, LaneIntent& intent) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const PathStretch& here = path.stretch_at(around.along);
  if (here.changing) {
    // who goes on between the lanes is in no lane's way until it has got past
    if (filters(view, around, row)) return;
    intent.merge_to = here.lane;
    if (is_beside(view, around, row)) intent.gate = around.along;
    const LimitReason reason = scene.context[row].reason;
    intent.abort = stood(view, row) >= Patience::Impatient &&
                   (reason == LimitReason::None || reason == LimitReason::Merge);
    return;
  }
  const double speed = around.speed;
  const PathStretch* change = next_change(path, around.along, 12.0 + 3.0 * speed);
  if (change == nullptr) return;
  const Lane &from = model.road.lane(here.lane), &to = model.road.lane(change->lane);
  if (from.edge != to.edge) return;
  intent.merge_to = change->lane;
  const LaneBeside beside{shift_to(model, from, to), change->from, change->to, &to.centerline};
  const double braking =
      speed < 2.0 ? view.parameters.pressed_braking : view.parameters.easy_braking;
  const bool due = change->from - around.along < 2.0 + 1.2 * speed;
  const bool let_in = speed < view.parameters.queue_speed && is_let_in(view, around, row, beside);
  if (!is_contested(view, around, row, change->lane, beside) &&
      is_gap(view, around, row, beside, braking)) {
    // planned over the way that it takes at full speed: in a queue, that long over two lanes
    if ((due || let_in) &&
        change->to - change->from > view.parameters.slack * way_of_change(view.parameters, speed))
      intent.wanted = change->lane;
    return;
  }
  // who is let in doesn't drive on past the gap
  if (let_in) {
    intent.gate = around.along;
    return;
  }
  intent.gate = change->from;
  intent.postpone = due;
}

/// Does a row look about at this tick? Who has just come looks before it does what its path begins
/// with.
bool looks_now(const TrafficView& view, std::size_t row, double dt) {
  return view.scene.control[row] == Control::Gamma &&
         (is_its_turn(view, row, dt) || !view.scene.context[row].active);
}

/// Moves the place aimed at within the lane, at walking pace, towards where it should be; swiftly
/// over the middle of the road and back.
void move_aim(const TrafficParameters& parameters, double wanted, bool overtakes, double dt,
              double& aim) {
  const double most = (overtakes ? parameters.swift_lateral_speed : parameters.lateral_speed) * dt;
  aim += std::clamp(wanted - aim, -most, most);
}

/// Looks around, and says where beside its path the row means to be and which lane it wants.
void look_about(const TrafficView& view, const Path& path, std::size_t row, LaneChoiceWork& work,
                std::size_t worker, TrafficState& traffic) {
  const Scene& scene = view.scene;
  Surroundings& around = work.around[worker];
  LaneIntent& intent = work.intents[row];
  if (path.walking) {
    look_around(view, row, view.parameters.soon_way, view.parameters.near, around);
    look_at_walls(view, path, row, view.parameters.near, view.parameters.near, around);
    look_at_red_crossings(view, path, row, around);
    const double place = walking_place(view, path, around, row);
    traffic.passing_offset[row] = place;
    traffic.overtaking_room[row] = room_off_the_way(view.parameters, path, around, place);
    return;
  }
  look_around(view, row, driver_outlook(view, path, row), 8.0, around);
  traffic.overtaking_room[row] = overtaking_room(view, around, row, work.far[worker]);
  traffic.passing_offset[row] = passing_offset(view, path, around, row);
  if (!path.trip) return;
  intent.entered = free_entry(view, work.queues, path, around);
  wait_for_gap(view, path, around, row, intent);
  if (intent.wanted == kNoLane && scene.halt[row].left <= 0.0 && !std::isfinite(intent.gate) &&
      !filters(view, around, row) && !halts_soon(view, path, around, row))
    intent.wanted = better_lane(view, work.queues, path, around, row);
}

/// The row's path with its lane change begun, put off or given up; none where it goes on as it is.
std::optional<Replanned> path_as_intended(const TrafficTick& tick, const LaneIntent& intent,
                                          std::size_t row) {
  const Replan from = replan(tick, row);
  const double speed = tick.scene.speed[row];
  if (intent.abort) return back_to_lane(from);
  if (intent.postpone) return stay_in_lane(from, std::max(speed, 3.0));
  if (intent.entered != kNoLane) return enter_beside(from, intent.entered);
  return change_lane(from, intent.wanted, way_of_change(tick.parameters, speed));
}

/// What others look at changes only here, one after the other.
void do_as_intended(const TrafficTick& tick, const LaneIntent& intent, std::size_t row) {
  TrafficState& traffic = tick.traffic;
  traffic.merge_to[row] = intent.merge_to;
  traffic.gate[row] = intent.gate;
  if (intent.wanted == kNoLane && intent.entered == kNoLane && !intent.postpone && !intent.abort)
    return;
  auto changed = path_as_intended(tick, intent, row);
  // no room left to change in: who gets on by its own lane nearly as well doesn't wait for a gap
  if (!changed && intent.postpone) {
    changed = keep_lane(replan(tick, row), tick.parameters.nearly_as_well);
    if (changed) traffic.merge_to[row] = kNoLane;
  }
  if (!changed) return;
  // who comes there now already reckons with it
  if (intent.wanted != kNoLane) traffic.merge_to[row] = intent.wanted;
  go_on_by(tick, std::move(*changed), row);
}

}  // namespace

double outlook(const TrafficView& view, std::size_t row, double dt) {
  const Path* path = view.road.path(view.scene.path[row]);
  if (path == nullptr || !looks_now(view, row, dt)) return 0.0;
  return path->walking ? view.parameters.soon_way : driver_outlook(view, *path, row);
}

void choose_lanes(const TrafficTick& tick, LaneChoiceWork& work) {
  const TrafficView view = tick.view();
  const Scene& scene = tick.scene;
  TrafficState& traffic = tick.traffic;
  work.around.resize(tick.workers.count());
  work.far.resize(tick.workers.count());
  work.intents.assign(scene.size(), {});
  measure_queues(view, work.queues);
  tick.workers.for_each_range(
      scene.size(), [&](std::size_t worker, std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row) {
          const Path* path = view.road.path(scene.path[row]);
          if (path == nullptr || scene.control[row] != Control::Gamma) continue;
          const bool looks = looks_now(view, row, tick.dt);
          work.intents[row].fresh = looks && !path->walking;
          if (looks) look_about(view, *path, row, work, worker, traffic);
          move_aim(tick.parameters, traffic.passing_offset[row], traffic.overtaking_room[row] > 0.0,
                   tick.dt, traffic.lateral_aim[row]);
        }
      });
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (work.intents[row].fresh) do_as_intended(tick, work.intents[row], row);
}

void forget_lane_change(TrafficState& traffic, std::size_t row) { traffic.merge_to[row] = kNoLane; }

}  // namespace sumogamma
