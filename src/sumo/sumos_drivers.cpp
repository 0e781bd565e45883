// SUMO's drivers don't see ghosts: what would have them drive into one is kept from them by us, by
// speed, by lane changes and at their insertion (docs/coupling.md).

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/units.h"
#include "road/replan.h"
#include "scene/extent.h"
#include "scene/locate.h"
#include "sumo/ghosts.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

}  // namespace

/// Has SUMO inserted a vehicle into the way of a ghost, or over it? Then it waits off the map until
/// there is room.
bool SumoWorld::delay_insertion(const SumoAgent& seen, PendingAgent& pending, const Scene& scene) {
  if (seen.is_person || !options_.control.any() || pending.resumes || pending.was_delayed ||
      stop_state::stopped(seen.stop_state))
    return false;
  const auto lane = model_.road.lane_by_name.find(seen.lane);
  if (lane == model_.road.lane_by_name.end()) return false;
  DelayedVehicle delayed;
  delayed.front = seen.position;
  delayed.angle = seen.angle;
  delayed.speed = seen.speed;
  delayed.lane = lane->second;
  if (fits(delayed, pending.details, delayed.speed, scene, true)) return false;
  backend_.unwatch(seen.id, false);
  backend_.take_over(seen.id, 0.0);
  delayed.pending = std::move(pending);
  delayed.pending.was_delayed = true;
  delayed_.push_back(std::move(delayed));
  ++life_cycle_.insertions_delayed;
  return true;
}

bool SumoWorld::fits(const DelayedVehicle& delayed, const SumoAgentDetails& details, double speed,
                     const Scene& scene, bool ghosts_only) const {
  const Lane& lane = model_.road.lane(delayed.lane);
  const Vec2 forward = direction_of(heading_from_sumo(delayed.angle));
  const OrientedBox body{delayed.front - 0.5 * details.length * forward, forward,
                         Vec2(0.5 * details.length, 0.5 * details.width)};
  const double height = elevation_at(lane, lane.centerline.project(delayed.front).along);
  return has_room(scene, ghosts_, body, height, speed,
                  [&](std::uint32_t row) { return !ghosts_only || is_ours(scene.control[row]); });
}

/// SUMO goes on with those for whom there is room now.
void SumoWorld::insert_delayed(const Scene& scene) {
  if (delayed_.empty()) return;
  ghosts_.rebuild(scene.position);
  std::set<LaneId> taken;  // one a lane and step
  std::erase_if(delayed_, [&](DelayedVehicle& delayed) {
    const SumoAgentDetails& details = delayed.pending.details;
    if (taken.contains(delayed.lane)) return false;
    double speed = delayed.speed;
    if (!fits(delayed, details, speed, scene, false)) speed = 0.0;
    if (!fits(delayed, details, speed, scene, false)) return false;
    taken.insert(delayed.lane);
    const SumoPose pose{&details.id, delayed.front, delayed.angle};
    backend_.put_on_lane(pose, model_.road.lane(delayed.lane).name, speed);
    backend_.release(details.id);
    backend_.watch(details.id, false);
    external_arriving_.insert_or_assign({false, details.id}, std::move(delayed.pending));
    return true;
  });
}

/// The path of a vehicle that SUMO drives is that of the lane on which SUMO has it: where SUMO has
/// changed lanes, or not yet where the path does, another one.
void SumoWorld::follow_lane(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                            RoadState& road) {
  constexpr double kBack = 20.0;  // [m]
  constexpr double kNear = 2.0;   // [m]
  constexpr double kAgain = 1.0;  // between two looks at the same lane [s]
  KnownAgent& known = known_[id.value];
  const bool same = seen.lane == known.lane_name;
  if (!same) {
    known.lane_name = seen.lane;
    const auto found = model_.road.lane_by_name.find(seen.lane);
    known.lane = found == model_.road.lane_by_name.end() ? kNoLane : found->second;
  }
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr || !path->trip || known.lane == kNoLane) return;
  const double along = scene.path_along[row];
  // at a lane's end the two may disagree for a step: a path made anew there would have lost what
  // the tail is still on
  const auto is_there = [&](double by) {
    const PathStretch& here = path->stretch_at(along + 0.5 * known.length + by);
    return here.lane == known.lane && !here.changing;
  };
  if (is_there(0.0) || is_there(-kNear) || is_there(kNear)) return;
  if (same && time_ < known.looked_at + kAgain) return;
  known.looked_at = time_;
  const Lane& lane = model_.road.lane(known.lane);
  double on_lane = lane.centerline.project(scene.position[row]).along;
  LaneId from = known.lane;
  const LinkPiece& piece = link_pieces_[index_of(known.lane)];
  if (piece.link != kNoConnection) {
    from = model_.road.connection(piece.link).from;
    on_lane = model_.road.lane(from).centerline.length() + piece.before +
              lane.centerline.project(seen.position).along - 0.5 * known.length;
  } else if (lane.kind != LaneKind::Normal) {
    return;
  }
  auto other = go_on_from({model_.road, *path, along, kBack}, {from, piece.link, on_lane});
  if (!other) return;
  scene.path_along[row] = other->along;
  scene.halt[row].next = 0;
  road.paths[id.value] = std::make_shared<const Path>(std::move(other->path));
}

/// Nobody whom SUMO moves is faster than ghosts on its way allow, or changes into a lane where one
/// is. Where there is none near it is given back to SUMO.
void SumoWorld::hold_drivers(const Scene& scene) {
  constexpr double kNear = 12.0, kSight = 3.0;  // [m], [s]
  if (std::find(scene.control.begin(), scene.control.end(), Control::External) ==
      scene.control.end())
    return;
  ghosts_.rebuild(scene.position);
  std::vector<std::uint32_t> near;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::External) continue;
    KnownAgent& known = known_[scene.id[row].value];
    near.clear();
    ghosts_.visit_within(scene.position[row],
                         kNear + 0.5 * known.length + kSight * scene.speed[row],
                         [&](std::uint32_t other, double) {
                           if (is_ours(scene.control[other])) near.push_back(other);
                         });
    const bool aside = !known.is_person && overtakes(scene, row);
    hold_speed(scene, row, aside, near);
    if (known.is_person) continue;
    if (!aside) hold_overtaking(scene, row);
    // who overtakes has to get back
    const bool barred =
        time_ < known.hold.keeps_lane_until ||
        (!aside && known.lane != kNoLane &&
         bars_lane_changes(model_.road, model_.road.lane(known.lane), scene, row, near));
    if (barred != known.hold.lane) backend_.allow_lane_changes(known.sumo_id, !barred);
    known.hold.lane = barred;
  }
}

void SumoWorld::hold_speed(const Scene& scene, std::size_t row, bool aside,
                           std::span<const std::uint32_t> near) {
  constexpr double kPatience = 30.0;  // [s]
  // SUMO's people walk around nobody whom SUMO doesn't see
  constexpr double kStands = 5.0;  // [s]
  // for 0 SUMO finds a person no way over the next junction
  constexpr double kSlowest = 0.01;  // [m/s]
  KnownAgent& known = known_[scene.id[row].value];
  const RoadContext& context = scene.context[row];
  const std::size_t foe = foe_row(scene, row);
  const bool bound = !known.is_person && !aside && foe < scene.size() &&
                     is_ours(scene.control[foe]) && context.allowed_speed < scene.speed[row] + 1.0;
  double most = bound ? context.allowed_speed : kForever;
  const bool straight_on = aside || known.is_person;
  const Path* path = straight_on ? nullptr : road_->path(scene.path[row]);
  // where both have waited for long, SUMO's driver goes as if there were nobody
  if (!near.empty() && scene.held[row].standing < kPatience && (straight_on || path != nullptr))
    most = std::min(most, speed_behind_ghosts(scene, row, known.is_person, path, near));
  known.blocked = known.is_person && most < kForever && scene.held[row].standing > kStands;
  if (most < kForever)
    backend_.set_speed(known.sumo_id, known.is_person,
                       known.is_person ? std::max(most, kSlowest) : most);
  else if (known.hold.speed)
    backend_.set_speed(known.sumo_id, known.is_person, -1.0);
  known.hold.speed = most < kForever;
}

/// Is a vehicle on the lane of those who come the other way?
bool SumoWorld::overtakes(const Scene& scene, std::size_t row) const {
  const LaneId on = known_[scene.id[row].value].lane;
  return on != kNoLane && goes_against(model_.road.lane(on), scene, row);
}

/// SUMO's lane change mode doesn't stop overtaking on the opposite lane; the driver's eagerness for
/// it does (vType attribute lcOpposite).
void SumoWorld::hold_overtaking(const Scene& scene, std::size_t row) {
  constexpr const char* kEagerness = "laneChangeModel.lcOpposite";
  KnownAgent& known = known_[scene.id[row].value];
  const bool may_overtake =
      known.lane != kNoLane && model_.road.lane(known.lane).opposite != kNoLane;
  const bool held = may_overtake && meets_ghosts(scene, ghosts_, row);
  if (held == known.hold.overtaking) return;
  if (held && known.hold.eagerness.empty()) {
    const std::string ids[] = {known.sumo_id};
    const std::vector<std::string> own = backend_.parameters(ids, kEagerness);
    known.hold.eagerness = own.empty() || own.front().empty() ? "1" : own.front();
  }
  backend_.set_parameter(known.sumo_id, kEagerness, held ? "0" : known.hold.eagerness);
  known.hold.overtaking = held;
}

}  // namespace sumogamma
