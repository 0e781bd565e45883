// Agents that SUMO moves, or has for a while: they are in the scene where SUMO says.

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/units.h"
#include "scene/behavior_draw.h"
#include "sumo/sumo_agents.h"
#include "sumo/sumo_world.h"
#include "sumo/waiting_place.h"

namespace sumogamma {

/// Without it nobody would know of an agent that SUMO drives whether it is on a bridge or under it,
/// or at a red light. Who has a path is found on that.
void SumoWorld::place_external(const SumoAgent& seen, Scene& scene, std::size_t row) const {
  if (scene.path[row] != kNoPath) return;
  const auto found = model_.road.lane_by_name.find(seen.lane);
  if (found == model_.road.lane_by_name.end()) {
    scene.lane[row] = {};
    return;
  }
  const Lane& lane = model_.road.lane(found->second);
  double along = 0.0, offset = 0.0;
  if (lane.kind != LaneKind::WalkingArea) {
    const double scale = lane.length > 0.0 ? lane.centerline.length() / lane.length : 1.0;
    const double behind = seen.is_person ? 0.0 : 0.5 * known_[scene.id[row].value].length;
    along = std::clamp(seen.lane_position * scale - behind, 0.0, lane.centerline.length());
    offset = cross(lane.centerline.direction_at(along),
                   scene.position[row] - lane.centerline.point_at(along));
  }
  scene.lane[row] = {found->second, along, offset};
  scene.height[row] = elevation_at(lane, along);
}

/// As outputs of SUMO's have it.
void SumoWorld::note_sumo_place(const SumoAgent& seen, KnownAgent& known) const {
  const auto lane = model_.road.lane_by_name.find(seen.lane);
  known.sumo_lane = lane == model_.road.lane_by_name.end() ? kNoLane : lane->second;
  known.sumo_along = seen.lane_position;
}

void SumoWorld::update_external(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  if (!external_arriving_.empty() || changes_hands()) ghosts_.rebuild(scene.position);
  for (const SumoAgent& seen : step_.agents) {
    // SUMO's invalid numbers (-2^30): between two places, as while it is teleported
    if (!(std::abs(seen.speed) < 1e4) || !(seen.position.norm() < 1e8)) continue;
    const SumoTraveller traveller{seen.is_person, seen.id};
    if (absent_.contains(traveller)) watch_absent(seen, scene);
    const auto arriving = external_arriving_.find(traveller);
    if (arriving != external_arriving_.end()) {
      PendingAgent pending = std::move(arriving->second);
      external_arriving_.erase(arriving);
      if (delay_insertion(seen, pending, scene)) continue;
      appear(seen, pending, scene, road);
      continue;
    }
    const auto external = external_ids_.find(traveller);
    if (external == external_ids_.end()) continue;
    const AgentId id = external->second;
    const std::size_t row = find_row(scene, id);
    if (row < scene.size()) follow(seen, id, row, scene, road, removed);
  }
  if (removed.empty()) return;
  removed.resize(scene.size(), false);
  remove_agents(scene, removed);
}

void SumoWorld::appear(const SumoAgent& seen, PendingAgent& pending, Scene& scene,
                       RoadState& road) {
  const SumoAgentDetails& details = pending.details;
  const AgentType& type = type_of(model_.types, pending.type);
  const SumoTraveller traveller{seen.is_person, seen.id};
  const AgentId id = register_agent(details, true, pending.type);
  KnownAgent& known = known_[id.value];
  known.resumes = pending.resumes;
  known.stages_left = seen.stages_left;
  if (pending.resumes && departs_at_stop(details)) known.service = StopService::Asked;
  known.asked_at = time_;
  if (is_out_of_sight(seen, known.length, scene)) {
    absent_.insert_or_assign(traveller, std::move(pending));
    return;
  }
  const double heading = heading_from_sumo(seen.angle);
  AgentState agent;
  agent.id = id;
  agent.type = pending.type;
  agent.footprint = details.is_person ? box_footprint(type.length, type.width)
                                      : box_footprint(details.length, details.width);
  agent.position = reference_point(seen.position, heading, -known.length);
  agent.heading = heading;
  agent.speed = seen.speed;
  agent.preferred_speed = details.max_speed;
  agent.behavior = draw_behavior(type, options_.seed, id.value);
  agent.control = Control::External;
  road.paths.resize(known_.size());
  if (pending.entry.path) {
    agent.path = static_cast<PathId>(id.value);
    road.paths[id.value] = pending.entry.path;
  }
  append_agent(scene, agent);
  note_sumo_place(seen, known);
  place_external(seen, scene, scene.size() - 1);
  external_ids_.insert_or_assign(traveller, id);
}

void SumoWorld::follow(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                       RoadState& road, std::vector<bool>& removed) {
  note_sumo_place(seen, known_[id.value]);
  const KnownAgent& known = known_[id.value];
  if (!known.external) {
    follow_service(seen, id, row, scene, road, removed);
    return;
  }
  if (is_out_of_sight(seen, known.length, scene)) {
    leave_sight(seen, id, row, scene, road, removed);
    return;
  }
  if (known.keeps_place) {
    scene.halt[row].left = options_.dt;  // by its plan
    step_to_kerb(model_, scene, row, options_.dt);
    take_back(seen, id, row, scene, road);
    return;
  }
  const double heading = heading_from_sumo(seen.angle);
  const Vec2 velocity = seen.speed * direction_of(heading);
  scene.acceleration[row] = (velocity - scene.velocity[row]) / options_.dt;
  scene.position[row] = reference_point(seen.position, heading, -known.length);
  scene.heading[row] = heading;
  scene.velocity[row] = velocity;
  scene.speed[row] = seen.speed;
  place_external(seen, scene, row);
  const Path* path = road.path(scene.path[row]);
  if (path != nullptr && scene.path_along[row] == 0.0)
    scene.path_along[row] = path->line.project(scene.position[row]).along;
  follow_lane(seen, id, row, scene, road);
  const bool stopped = stop_state::stopped(seen.stop_state);
  if (scene.halt[row].left > 0.0 && !stopped) ++scene.halt[row].next;
  scene.halt[row].left = stopped ? options_.dt : 0.0;
  const bool parks = stop_state::parked(seen.stop_state);
  const bool leaves = !parks && scene.control[row] == Control::Parked;
  if (known.resumes && take_back(seen, id, row, scene, road)) return;
  if (known.resumes && leaves && rejoin(seen, true)) {
    external_ids_.erase({seen.is_person, seen.id});
    forget(id, scene, road, removed, row);
    return;
  }
  scene.control[row] = parks ? Control::Parked : Control::External;
  if (known.hand_back.steps >= 0) watch_hand_back(seen, known_[id.value].hand_back);
  if (path != nullptr && !known.resumes && !stopped &&
      is_wanted(known, scene.position[row], false) && may_take(scene, row)) {
    take_over(id, scene, row);
    ++life_cycle_.taken_over;
  }
}

}  // namespace sumogamma
