#include "traffic/junction/arbitration.h"

#include <algorithm>
#include <optional>

#include "geometry/oriented_box.h"
#include "scene/extent.h"
#include "traffic/junction/laws.h"
#include "traffic/junction/signals.h"
#include "traffic/junction/turning_room.h"
#include "traffic/junction/waiting_place.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// What a link asks of a traveller, whoever comes.
struct LinkDuty {
  double stop_at = 0;  ///< where its front comes to rest before it [m along its path]
  SignalDuty signal = SignalDuty::None;
  bool wide = false;  ///< see is_wide
};

LinkDuty duty_of(const TrafficView& view, const Traveller& traveller, const PathLink& link) {
  const AgentType& type = type_of(view.model.types, view.scene.type[traveller.row]);
  // where a front that waits comes to rest: short of the line where others turn by close, at the
  // line where it has come too far or is too fast for that
  const bool stops_short = traveller.front < link.halt &&
                           stops_at_ease(traveller.speed, link.halt - traveller.front, type);
  const double halt = stops_short ? link.halt : link.stop_line;
  const Light signal = view.road.signal(view.model.road.connection(link.connection));
  const double drawn = is_amber(signal) ? drawn_line(view, traveller, link) : halt;
  return {halt - view.parameters.stop_margin, signal_duty(view, traveller, link, halt, drawn),
          is_wide(view.scene, traveller.row)};
}

/// How far somebody has rolled on by now from where it halted at red [m]: in the end as far over
/// the line as it halted before it; nowhere where others turn by close.
double crept(const TrafficView& view, const Traveller& traveller, const PathLink& link) {
  const std::size_t row = traveller.row;
  if (view.traffic.halted_for[row] != link.connection || link.halt < link.stop_line ||
      !creeps(view, row, link.connection))
    return 0.0;
  const double since = view.scene.time - view.traffic.halted_at[row];
  return std::min(view.parameters.halting_speed * since, 2.0 * view.parameters.stop_margin);
}

/// Who has to halt first, at a stop sign or before it goes at red, and hasn't.
bool has_to_halt_first(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                       bool at_red) {
  const Connection& connection = view.model.road.connection(link.connection);
  const Path& path = *view.road.path(view.scene.path[traveller.row]);
  const bool stop_sign =
      halts_first(connection.priority) && view.road.signal(connection) == Light::None;
  const bool has_to_halt = stop_sign || (at_red && !path.walking && connection.storage == 0.0);
  return has_to_halt && link.stop_line - traveller.front > -0.2 &&
         view.traffic.halted_for[traveller.row] !=
             halt_counts_for(view.model.road, path, link, traveller.length);
}

/// Does somebody ride so far beside the middle of its lane that on the junction it might wait where
/// a foe's long body sweeps? Whether that one turns isn't asked.
bool is_aside_for(const Encounter& e, const Party& one, const Party& foe) {
  return foe.at.length > kLongBody &&
         std::abs(e.traffic.passing_offset[one.row()]) >= e.parameters.ample_side;
}

/// Where the first party halts for the other [m along its path]: at its line, inside the junction
/// where there is a place for that, or before the area where its body is past the line already.
/// None where it is too late for that.
std::optional<double> line_before(const Encounter& e, const Traveller& traveller, double stop_at) {
  const Party& one = e.a;
  const double stop_line = one.on_path.stop_line;
  const WaitingPlace place = waiting_place(e.parameters, one.on_path, one.area.begin);
  const bool has_place =
      place.inside && !one.at_red && (one.link.signal != kNoSignal || !is_aside_for(e, one, e.b));
  const double line = has_place && traveller.front < place.along + 0.3 ? place.along
                      : stop_line - traveller.front > -0.2
                          ? stop_at
                          : stop_line + one.area.begin - e.parameters.stop_margin;
  // on foot one halts at the kerb still
  const double last = one.on_foot ? std::max(line, stop_line) : line;
  const double hardest = 0.8 * one.type.max_deceleration;
  if (deceleration_to_stop(traveller.speed, last - traveller.front) <= hardest ||
      traveller.speed <= 1.0)
    return line;
  // too late to halt there, but not for driving on towards who is in the way already
  if (one.on_foot || !e.b.inside) return std::nullopt;
  return traveller.front + traveller.speed * traveller.speed / (2.0 * hardest);
}

/// Looks at all who come to one conflict zone, foremost first, and tightens the decision for those
/// who block.
void decide_zone(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                 const LinkDuty& duty, const ConflictZone& of_table, LinkDecision& decision) {
  for (const Approach& foe : view.approaches.of(of_table.foe)) {
    if (foe.row == traveller.row) continue;
    const auto zone = zone_for(of_table, duty.wide || foe.wide);
    if (!zone) continue;
    const Encounter e = meet(view, traveller, link, *zone, foe);
    const Verdict verdict = judge(e);
    // who comes behind a vehicle that lets us go can't get past it
    if (verdict == Verdict::Held && !is_narrow(e.b.type.width)) return;
    if (verdict != Verdict::Blocks) continue;
    const auto line = line_before(e, traveller, duty.stop_at);
    if (!line || (decision.must_stop && *line >= decision.stop_at)) continue;
    decision = {true, *line, zone->foe_is_crossing ? LimitReason::Crossing : LimitReason::Yield,
                static_cast<std::int64_t>(view.scene.id[foe.row].value)};
  }
}

}  // namespace

LinkDecision decide_link(const TrafficView& view, const Traveller& traveller,
                         const PathLink& link) {
  const Model& model = view.model;
  const LinkDuty duty = duty_of(view, traveller, link);
  if (duty.signal == SignalDuty::Stop)
    return {true, duty.stop_at + crept(view, traveller, link), LimitReason::Signal, -1};
  const bool at_red = duty.signal == SignalDuty::GoAtRed;
  LinkDecision decision;
  if (has_to_halt_first(view, traveller, link, at_red))
    decision = {true, duty.stop_at, at_red ? LimitReason::Signal : LimitReason::Yield, -1};

  for (const ConflictZone& zone : model.conflicts[index_of(link.connection)])
    if (!runs_together(model, link.connection, zone.foe))
      decide_zone(view, traveller, link, duty, zone, decision);
  if (decision.must_stop && decision.stop_at > link.stop_line &&
      waited(view, traveller.row) < Patience::Stuck)
    keep_zones_free(view, traveller, link, decision);
  return decision;
}

bool stands_beside(const TrafficView& view, const Traveller& traveller, const PathLink& link,
                   double begin, double end, const Approach& foe) {
  const Scene& scene = view.scene;
  const std::size_t row = traveller.row;
  const Polyline& way = view.road.path(scene.path[row])->line;
  const OrientedBox body = box_of(scene, foe.row);
  Vec2 half = box_of(scene, row).half;
  // on foot one steps back from a body that swings
  if (type_of(view.model.types, scene.type[foe.row]).kinematics == Kinematics::Holonomic)
    half.x() = 0.0;
  // the middle follows the way, the rear axle the middle: in a bend the nose swings out
  const double axle = type_of(view.model.types, scene.type[row]).rear_axle_to_center;
  double along = scene.path_along[row];
  double heading = scene.heading[row];
  const double settles = link.stop_line + begin - 2.0 * traveller.length;
  if (along < settles) {
    along = settles;
    heading = heading_of(way.direction_at(settles));
  }
  for (; along <= link.stop_line + end; along += view.parameters.sampling_step) {
    const Vec2 forward = direction_of(heading);
    if (along >= link.stop_line + begin &&
        separation({way.point_at(along), forward, half}, body) < view.parameters.side_clearance)
      return false;
    heading += view.parameters.sampling_step * cross(forward, way.direction_at(along)) /
               std::max(axle, view.parameters.sampling_step);
  }
  return true;
}

bool runs_together(const Model& model, ConnectionId a, ConnectionId b) {
  const Connection &own = model.road.connection(a), &other = model.road.connection(b);
  return own.to == other.to && own.from != other.from &&
         model.road.lane(own.from).edge == model.road.lane(other.from).edge;
}

bool has_crossing_traffic(const Model& model, ConnectionId link) {
  const auto& zones = model.conflicts[index_of(link)];
  return std::any_of(zones.begin(), zones.end(), [&](const ConflictZone& zone) {
    return !runs_together(model, link, zone.foe);
  });
}

ZipperLeader find_zipper_leader(const TrafficView& view, const Traveller& traveller,
                                const PathLink& link) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const ApproachTable& approaches = view.approaches;
  ZipperLeader leader;
  for (const ConflictZone& zone : model.conflicts[index_of(link.connection)]) {
    if (!runs_together(model, link.connection, zone.foe)) continue;
    const double own_way = link.stop_line + zone.end - traveller.front;
    if (own_way < 0.0) continue;
    for (const Approach& foe : approaches.of(zone.foe)) {
      const double their_way = zone.foe_end - foe.front;
      if (foe.row == traveller.row || their_way < -foe.length) continue;
      const bool first = their_way < own_way ||
                         (their_way == own_way && scene.id[foe.row] < scene.id[traveller.row]);
      if (!first) continue;
      const double gap = own_way - their_way - foe.length;
      if (leader.id < 0 || gap < leader.gap)
        leader = {gap, foe.speed, static_cast<std::int64_t>(scene.id[foe.row].value)};
    }
  }
  return leader;
}

}  // namespace sumogamma
