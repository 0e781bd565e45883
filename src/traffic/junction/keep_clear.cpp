#include "traffic/junction/keep_clear.h"

#include <algorithm>

#include "traffic/junction/turning_room.h"
#include "traffic/patience.h"

namespace sumogamma {

namespace {

/// Where the next queue behind a link may have its head [m along the path]: before the next link
/// at which somebody might have to wait, infinite where none is near.
double next_queue_head(const TrafficView& view, const Course& course, const PathLink& link) {
  for (const PathLink& next : course.path.links) {
    if (next.stop_line <= link.stop_line) continue;
    if (next.stop_line > link.end + view.parameters.queue_outlook) break;
    const Connection& connection = view.model.road.connection(next.connection);
    if (!has_right_of_way(connection, view.road.signal(connection)) &&
        has_crossing_traffic(view.model, next.connection))
      return next.halt;
  }
  return std::numeric_limits<double>::infinity();
}

/// Where the road ends that a link leads into, or as far as a queue is looked at [m along the
/// path].
double end_of_road(const TrafficParameters& parameters, const Course& course,
                   const PathLink& link) {
  const auto next = course.path.link_after(link.stop_line);
  const double farthest = link.end + parameters.queue_outlook;
  return next != course.path.links.end() ? std::min(next->stop_line, farthest) : farthest;
}

/// From where on a body that stands on a link's junction, or behind it, leaves the junction clear
/// [m along the path]. From the junction's end on; where a light follows at once, though, from the
/// last place on where others cross: who joins the same road there waits for that light anyway.
double clear_from(const TrafficView& view, const Course& course, const PathLink& link) {
  const RoadNetwork& network = view.model.road;
  const auto next = course.path.link_after(link.stop_line);
  if (next == course.path.links.end() || next->stop_line > link.end + view.parameters.near ||
      network.connection(next->connection).signal == kNoSignal ||
      network.connection(link.connection).signal != kNoSignal)
    return link.end;
  const auto road_behind = [&](ConnectionId id) {
    return network.lane(network.connection(id).to).edge;
  };
  double clear = link.stop_line;
  for (const ConflictZone& zone : view.model.conflicts[index_of(link.connection)])
    if (road_behind(zone.foe) != road_behind(link.connection))
      clear = std::max(clear, link.stop_line + zone.end);
  return std::min(clear, link.end);
}

/// Calls `visit` for everybody who has halted at its line, to give way to the row for the lane that
/// `link` leads into, and isn't past it.
template <typename Visit>
void visit_joining(const TrafficView& view, const Course& course, const PathLink& link,
                   Visit visit) {
  const LaneId to = view.model.road.connection(link.connection).to;
  for (const ConflictZone& zone : view.model.conflicts[index_of(link.connection)]) {
    if (zone.yields || view.model.road.connection(zone.foe).to != to) continue;
    for (const Approach& foe : view.approaches.of(zone.foe)) {
      const Waiting& waiting = view.approaches.waiting(foe.row);
      if (foe.row != course.row && foe.has_halted && foe.front < view.parameters.line_tolerance)
        visit(foe, waiting);
    }
  }
}

/// Is somebody with that id on a link, past its line?
bool is_past_line(const TrafficView& view, const PathLink& link, std::int64_t id) {
  const auto row = view.approaches.of(link.connection);
  return std::any_of(row.begin(), row.end(), [&](const Approach& one) {
    return one.front > 0.0 && view.scene.id[one.row].value == id;
  });
}

/// Length [m] of who has stood for long at its line and waits to join; of the longest there, 0
/// where nobody does.
double waits_to_join(const TrafficView& view, const Course& course, const PathLink& link) {
  double length = 0.0;
  visit_joining(view, course, link, [&](const Approach& foe, const Waiting& waiting) {
    const bool gives_way = waiting.reason == LimitReason::Yield ||
                           waiting.reason == LimitReason::Crossing ||
                           waiting.reason == LimitReason::BlockedJunction;
    if (foe.stands && gives_way && halted(view, foe.row) >= Patience::Stuck)
      length = std::max(length, foe.length);
  });
  return length;
}

/// Keep clear: is there room behind a link for the body, should everybody ahead close up and stop?
/// Into a full road drivers let one in who has waited for long, and count its body as well. Where
/// not, for whom it waits; where to halt is left open. Sorts `ahead`.
LinkDecision decide_exit(const TrafficView& view, DrivingAhead& ahead, const Course& course,
                         const PathLink& link) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  // all of the road that the link leads into: the few metres that following needs don't tell
  // whether a long queue goes on
  see_queue(view, course.row, end_of_road(view.parameters, course, link), ahead);
  if (ahead.count == 0) return {};
  const auto begin = ahead.vehicles.begin(), end = begin + static_cast<std::ptrdiff_t>(ahead.count);
  std::sort(begin, end, [](const auto& a, const auto& b) {
    return a.rear != b.rear ? a.rear > b.rear : a.id < b.id;
  });
  // where each comes to rest at the least, from the far end of the queue
  const double head = next_queue_head(view, course, link);
  double rest = kNever;
  for (auto vehicle = begin; vehicle != end; ++vehicle) {
    // who drives and has nobody slow ahead goes on, as far as to the next place where it may have
    // to wait
    const LimitReason why = view.approaches.waiting(vehicle->row).reason;
    const bool starts = rest == kNever && vehicle->speed > view.parameters.crawling_speed &&
                        (why == LimitReason::None || why == LimitReason::Leader);
    const double alone = vehicle->speed > view.parameters.queue_speed || starts
                             ? kNever
                             : vehicle->rear + vehicle->speed * vehicle->speed /
                                                   (2.0 * view.parameters.pressed_braking);
    if (vehicle->front < head) rest = std::min(rest, head + view.parameters.closed_up_gap);
    rest = std::min(alone, rest - view.parameters.closed_up_gap - (vehicle->front - vehicle->rear));
  }
  if (rest == kNever) return {};
  const double joining = waits_to_join(view, course, link);
  const double needed = clear_from(view, course, link) + 2.0 * course.half_length +
                        course.type.min_gap + 0.3 +
                        (joining > 0.0 ? joining + view.parameters.closed_up_gap : 0.0);
  if (rest >= needed) return {};
  return {true, 0.0, LimitReason::BlockedJunction, (end - 1)->id};
}

/// Keep clear of junctions that follow each other closely: who would have to wait before the next
/// one with its rear still on this one, or has no room behind that one, waits here already, for
/// some time, and for a light before which there is no room at all as long as it takes, unless one
/// here may end meanwhile.
LinkDecision decide_beyond(const TrafficView& view, const Course& course,
                           const Traveller& traveller, const PathLink& link, DrivingAhead& ahead) {
  // who has set out from a place short of the line doesn't halt again
  if (traveller.front > link.halt + view.parameters.line_tolerance &&
      link.stop_line > link.halt + view.parameters.line_tolerance)
    return {};
  const bool patient = waited(view, course.row) < Patience::Stuck;
  const bool waits_for_light = view.model.road.connection(link.connection).signal == kNoSignal;
  double room_from = clear_from(view, course, link);
  for (PathLink next : course.path.links) {
    // who waits with its rear on a junction already goes as far as it can
    if (next.stop_line < link.stop_line &&
        next.end > link.halt - view.parameters.stop_margin - traveller.length)
      return {};
    if (next.stop_line <= link.stop_line) continue;
    const bool near = patient && next.stop_line <= link.stop_line + view.parameters.nearby;
    // its line may be drawn well before the end of its lane, on a crossing that is there
    next.halt = halt_for_long_bodies(view, traveller, next);
    const bool no_room = waits_for_light && next.halt < room_from + view.parameters.near_line;
    if (next.halt - view.parameters.stop_margin - traveller.length > room_from ||
        !(near || no_room))
      break;
    const LinkDecision decision = decide_link(view, traveller, next);
    if (decision.must_stop && (near || decision.reason == LimitReason::Signal)) return decision;
    if (near && has_crossing_traffic(view.model, next.connection)) {
      const LinkDecision exit = decide_exit(view, ahead, course, next);
      if (exit.must_stop) return exit;
    }
    room_from = clear_from(view, course, next);
  }
  return {};
}

}  // namespace

LinkDecision keep_clear(const TrafficView& view, const Course& course, const Traveller& traveller,
                        const PathLink& link, DrivingAhead& ahead) {
  // who waits on the junction goes no further, either
  const double front = course.along + course.half_length;
  if (std::max(link.stop_line, link.inside) <= front - 0.3 ||
      kept_clear(view, course.row) >= Patience::Desperate ||
      !has_crossing_traffic(view.model, link.connection))
    return {};
  LinkDecision decision = decide_exit(view, ahead, course, link);
  if (!decision.must_stop) decision = decide_beyond(view, course, traveller, link, ahead);
  if (!decision.must_stop) return {};
  const double line = link.halt > front              ? link.halt
                      : link.stop_line > front - 0.3 ? link.stop_line
                                                     : link.inside;
  return {true, line - view.parameters.stop_margin, decision.reason, decision.foe};
}

LinkDecision let_one_in(const TrafficView& view, const Course& course, const Traveller& traveller,
                        const PathLink& link) {
  const Connection& connection = view.model.road.connection(link.connection);
  const Patience own_wait = waited(view, course.row);
  if (traveller.front > link.stop_line + 0.3 ||
      traveller.front < link.halt - view.parameters.near || own_wait < Patience::Waiting ||
      own_wait == Patience::Hopeless || connection.signal != kNoSignal ||
      next_queue_head(view, course, link) < link.end + view.parameters.junction_outlook)
    return {};
  const Waiting& own = view.approaches.waiting(course.row);
  const bool has_halted = own.halted_for == halt_counts_for(view.model.road, course.path, link,
                                                            2.0 * course.half_length);
  const double came = has_halted ? own.halted_at : view.scene.time;
  const auto id = static_cast<std::int64_t>(view.scene.id[course.row].value);
  LinkDecision decision;
  visit_joining(view, course, link, [&](const Approach& foe, const Waiting& waiting) {
    const Patience their_wait = halted(view, foe.row);
    const bool first = waiting.halted_at <= came && their_wait >= Patience::Pressing;
    // not for somebody who has others to wait for, but for those whom we follow after a long wait;
    // who follows somebody may be the first at its line
    const bool comes =
        waiting.reason == LimitReason::None ||
        (waiting.reason == LimitReason::Leader && foe.front > -view.parameters.near_line) ||
        waiting.reason == LimitReason::BlockedJunction ||
        (waiting.reason == LimitReason::Yield &&
         (waiting.foe == id ||
          (their_wait >= Patience::Stuck && is_past_line(view, link, waiting.foe))));
    if (foe.front > -view.parameters.near && first && comes)
      decision = {true, link.halt - view.parameters.stop_margin, LimitReason::LetsIn,
                  static_cast<std::int64_t>(view.scene.id[foe.row].value)};
  });
  return decision;
}

bool takes_turning_room(const TrafficView& view, const Course& course, const PathLink& link) {
  const bool signalled = view.model.road.connection(link.connection).signal != kNoSignal;
  return kept_clear(view, course.row) >= Patience::Desperate &&
         (!signalled || waited(view, course.row) >= Patience::Hopeless);
}

void forget_keeping_clear(TrafficState& traffic, std::size_t row) {
  traffic.keeps_clear[row] = 0.0;
}

void note_keeping_clear(const TrafficView& view, const Course& course, const RoadContext& context,
                        double dt, TrafficState& traffic) {
  double& kept = traffic.keeps_clear[course.row];
  const auto patience = [&] { return patience_after(view.parameters, kept); };
  const bool for_others =
      context.reason == LimitReason::BlockedJunction || context.reason == LimitReason::TurningRoom;
  if (for_others && course.speed < 0.3) {
    kept += dt;
    // who waits for itself, in the end, gains nothing by the room that it leaves
    if (patience() >= Patience::Desperate ||
        (patience() >= Patience::Pressing && view.waits.in_ring(course.row)))
      kept = view.parameters.desperate + view.parameters.pressing;
  } else if (patience() >= Patience::Desperate) {
    kept -= dt;
    if (patience() < Patience::Desperate) kept = 0.0;
  } else if (traffic.waiting_time[course.row] == 0.0) {
    kept = 0.0;
  }
}

}  // namespace sumogamma
