#include "sumo/sumo_world.h"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "base/units.h"
#include "sumo/entry.h"
#include "sumo/sumo_agents.h"

namespace sumogamma {

namespace {

/// Off the map: where agents wait that SUMO has inserted and that have no room yet.
Vec2 lobby(const RoadNetwork& network) { return network.upper_corner + Vec2(100.0, 100.0); }

/// SUMO's reference point of a footprint centre and back: front bumper for vehicles, centre for
/// persons.
Vec2 reference_point(const Vec2& center, double heading, double length) {
  return center + 0.5 * length * direction_of(heading);
}

}  // namespace

SumoWorld::SumoWorld(Model& model, SumoBackend& backend, SumoWorldOptions options)
    : model_(model),
      backend_(backend),
      options_(std::move(options)),
      rows_(model, options_.type_keys),
      time_(backend.time()) {
  for (const std::string& id : backend_.signal_ids()) {
    const auto signal = model_.road.signal_by_name.find(id);
    signal_order_.push_back(signal == model_.road.signal_by_name.end() ? kNoSignal
                                                                       : signal->second);
  }
  read_detectors();
}

void SumoWorld::read_detectors() {
  for (const SumoBackend::Detector& detector : backend_.detectors()) {
    const auto lane = model_.road.lane_by_name.find(detector.lane);
    if (lane == model_.road.lane_by_name.end()) continue;
    detectors_[lane->second].push_back({detector_ages_.size(), detector.position, time_});
    detector_ages_.emplace_back(detector.id, 0.0);
  }
}

/// Actuated signals don't see ghosts: they are told when one of ours was last on each of their
/// loops.
void SumoWorld::feed_detectors(const Scene& scene) {
  if (detectors_.empty()) return;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma || known_[scene.id[row].value].is_person) continue;
    const auto lane = detectors_.find(scene.lane[row].lane);
    if (lane == detectors_.end()) continue;
    const double half = 0.5 * known_[scene.id[row].value].length;
    for (LaneDetector& detector : lane->second)
      if (std::abs(detector.position - scene.lane[row].along) <= half) detector.last_seen = time_;
  }
  for (const auto& [lane, list] : detectors_)
    for (const LaneDetector& detector : list)
      detector_ages_[detector.index].second = time_ - detector.last_seen;
  backend_.override_detectors(detector_ages_);
}

bool SumoWorld::wants_control(const SumoAgentDetails& details, AgentTypeId type) const {
  const ControlChoice& control = options_.control;
  return control.all || control.names.contains(type_of(model_.types, type).name) ||
         control.names.contains(details.type_id) || control.names.contains(details.id);
}

void SumoWorld::observe(Scene& scene, RoadState& road) {
  scene.time = time_;
  road.signal_states.resize(model_.road.signals.size());
  road.signal_since.resize(model_.road.signals.size(), time_);
  road.amber_until.resize(model_.road.signals.size(), time_);
  for (std::size_t i = 0; i < signal_order_.size() && i < step_.signal_states.size(); ++i) {
    if (signal_order_[i] == kNoSignal) continue;
    const std::size_t signal = index_of(signal_order_[i]);
    if (road.signal_states[signal] == step_.signal_states[i]) continue;
    road.signal_states[signal] = step_.signal_states[i];
    road.signal_since[signal] = time_;
    if (std::any_of(step_.signal_states[i].begin(), step_.signal_states[i].end(), is_amber))
      road.amber_until[signal] = backend_.next_switch(i);
  }
  take_arrived(scene, road);
  finish_driven(scene, road);
  take_departed(scene);
  update_external(scene, road);
  insert_pending(scene, road);
  // each event is handled once
  step_.departed_vehicles.clear();
  step_.departed_persons.clear();
  step_.arrived_vehicles.clear();
  step_.arrived_persons.clear();
  step_.lost.clear();
}

void SumoWorld::take_departed(Scene&) {
  if (step_.departed_vehicles.empty() && step_.departed_persons.empty()) return;
  for (SumoAgentDetails& details :
       backend_.details(step_.departed_vehicles, step_.departed_persons)) {
    auto type = agent_type_of(model_.types, details);
    if (!type) {
      ++life_cycle_.left_to_sumo["rail or water"];
      continue;
    }
    type = rows_.row_of(*type, details);
    Pending pending{std::move(details), *type, nullptr, {}, false};
    choose_pace(model_.road, pending.details);
    bool driven = options_.control.any() && wants_control(pending.details, *type);
    if (driven || options_.control.has_region)
      choose_speed_factor(type_of(model_.types, *type), options_.seed, pending.details);
    if (driven) choose_mid_block(type_of(model_.types, *type), options_.seed, pending.details);
    if (options_.control.any()) {
      std::string why = "a person who does not walk";
      if (!pending.details.route.empty())
        pending.path = path_of(model_, pending.details, *type, why);
      if (driven && !pending.path) {
        driven = false;
        ++life_cycle_.left_to_sumo[why];
        spdlog::warn("{}: left to SUMO: {}", pending.details.id, why);
      }
    }
    if (driven) {
      if (!pending.details.is_person) backend_.take_over(pending.details.id, 0.0);
      pending_.push_back(std::move(pending));
    } else {
      backend_.watch(pending.details.id, pending.details.is_person);
      std::string id = pending.details.id;
      external_arriving_.insert_or_assign(std::move(id), std::move(pending));
    }
  }
}

AgentId SumoWorld::register_agent(const SumoAgentDetails& details, bool external, double time) {
  const AgentId id{static_cast<std::uint32_t>(known_.size())};
  known_.push_back({details.id, details.is_person, external, false, time,
                    details.is_person ? 0.0 : details.length});
  names_.push_back(details.id);
  return id;
}

void SumoWorld::forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
                       std::size_t row) {
  if (removed.empty()) removed.assign(scene.size(), false);
  removed[row] = true;
  if (id.value < road.paths.size()) road.paths[id.value] = nullptr;
  written_.erase(known_[id.value].sumo_id);
}

void SumoWorld::record_arrival(const Scene& scene, std::size_t row) {
  const AgentTypeId type = scene.type[row];
  ++life_cycle_.by_type[type_of(model_.types, type).name].arrived;
  life_cycle_.trips.push_back({scene.id[row], type, known_[scene.id[row].value].departed, time_});
}

void SumoWorld::take_arrived(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  auto arrived = [&](const std::string& sumo_id) {
    external_arriving_.erase(sumo_id);
    const auto external = external_ids_.find(sumo_id);
    if (external == external_ids_.end()) return;
    const AgentId id = external->second;
    const std::size_t row = find_row(scene, id);
    external_ids_.erase(external);
    if (row == scene.size()) return;
    record_arrival(scene, row);
    forget(id, scene, road, removed, row);
  };
  for (const std::string& id : step_.arrived_vehicles) arrived(id);
  for (const std::string& id : step_.arrived_persons) arrived(id);
  // refused by SUMO: it vanished there between read and write
  for (const std::string& lost : step_.lost)
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const AgentId id = scene.id[row];
      if (known_[id.value].external || known_[id.value].sumo_id != lost) continue;
      ++life_cycle_.removed["refused by SUMO"];
      forget(id, scene, road, removed, row);
    }
  if (!removed.empty()) remove_agents(scene, removed);
}

void SumoWorld::finish_driven(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    const Path* path = road.path(scene.path[row]);
    const Known& known = known_[scene.id[row].value];
    // vehicles arrive with their front, before it crosses whatever line is there (the place on the
    // path is that of a tick ago), walkers when they are there within a step or two
    const double reached =
        scene.path_along[row] +
        (known.is_person ? 0.7 : 0.5 * known.length + 0.3 + 2.0 * scene.speed[row] * options_.dt);
    if (reached < path->arrival) continue;
    if (known.is_person) {
      const std::vector<std::string> next = backend_.finish_stage(known.sumo_id);
      if (!next.empty()) {
        const std::string one[] = {known.sumo_id};
        auto details = backend_.details({}, one);
        std::string why = "it is gone";
        if (!details.empty()) {
          const AgentType& type = type_of(model_.types, scene.type[row]);
          choose_speed_factor(type, options_.seed, details.front());
          choose_mid_block(type, options_.seed, details.front());
        }
        auto next_path =
            details.empty() ? nullptr : path_of(model_, details.front(), scene.type[row], why);
        if (next_path) {
          scene.path_along[row] = next_path->line.project(scene.position[row]).along;
          road.paths[scene.id[row].value] = std::move(next_path);
          continue;
        }
        ++life_cycle_.removed["next walk impossible: " + why];
        forget(scene.id[row], scene, road, removed, row);
        continue;
      }
    } else {
      backend_.remove_vehicle(known.sumo_id);
    }
    record_arrival(scene, row);
    forget(scene.id[row], scene, road, removed, row);
  }
  if (!removed.empty()) remove_agents(scene, removed);
}

void SumoWorld::insert_pending(Scene& scene, RoadState& road) {
  // in order of departure; one that finds no room holds up only those who start at its place,
  // people no more than those who would stand on the same metre
  std::set<std::pair<LaneId, int>> full;
  std::size_t vehicles = 0;
  for (const AgentId id : scene.id) vehicles += known_[id.value].is_person ? 0 : 1;
  for (auto pending = pending_.begin(); pending != pending_.end();) {
    // as SUMO's --max-num-vehicles, which holds back nobody who walks
    if (options_.max_vehicles > 0 && !pending->details.is_person &&
        vehicles >= options_.max_vehicles) {
      ++pending;
      continue;
    }
    const PathStretch& start = pending->path->stretches.front();
    const double place_length = pending->details.is_person ? 1.0 : 10.0;
    const std::pair place(start.lane, static_cast<int>(start.lane_from / place_length));
    if (full.contains(place)) {
      ++pending;
    } else if (insert(*pending, scene, road)) {
      vehicles += pending->details.is_person ? 0 : 1;
      pending = pending_.erase(pending);
    } else {
      full.insert(place);
      ++pending;
    }
  }
  life_cycle_.waiting = pending_.size();
}

AgentState SumoWorld::newcomer(const Pending& pending, const Path& path, AgentId id) const {
  const SumoAgentDetails& details = pending.details;
  const AgentType& type = type_of(model_.types, pending.type);
  AgentState agent;
  agent.id = id;
  agent.type = pending.type;
  const bool own_size = details.is_person;
  const double length = details.length > 0.0 && !own_size ? details.length : type.length;
  const double width = details.width > 0.0 && !own_size ? details.width : type.width;
  agent.footprint = box_footprint(length, width);
  const Vec2 direction = path.line.direction_at(0.0);
  agent.path_offset = draw_path_offset(model_, type, options_.seed, id);
  const PathStretch& stretch = path.stretches.front();
  const double half_width = 0.5 * width;
  const double offset =
      std::clamp(agent.path_offset, std::min(0.0, half_width + 0.1 - stretch.room_right),
                 std::max(0.0, stretch.room_left - half_width - 0.1));
  agent.position = path.line.point_at(0.0) + offset * left_of(direction);
  agent.heading = heading_of(direction);
  agent.preferred_speed =
      details.max_speed > 0.0
          ? std::min(details.max_speed * (details.is_person ? details.speed_factor : 1.0),
                     type.max_speed)
          : type.preferred_speed;
  agent.behavior = draw_behavior(type, options_.seed, id);
  agent.manners = draw_manners(type.compliance, options_.seed, id.value);
  agent.path = static_cast<PathId>(id.value);
  return agent;
}

bool SumoWorld::insert(Pending& pending, Scene& scene, RoadState& road) {
  if (insert_on(pending, pending.path, scene, road)) return true;
  if (!pending.path->trip) return false;
  if (!pending.looked_besides) {
    pending.looked_besides = true;
    pending.besides = paths_besides(model_, pending.details, pending.type, *pending.path);
  }
  for (const auto& path : pending.besides)
    if (insert_on(pending, path, scene, road)) return true;
  return false;
}

bool SumoWorld::insert_on(const Pending& pending, const std::shared_ptr<const Path>& path,
                          Scene& scene, RoadState& road) {
  const SumoAgentDetails& details = pending.details;
  const AgentId id{static_cast<std::uint32_t>(known_.size())};
  AgentState agent = newcomer(pending, *path, id);
  const PathStretch& stretch = path->stretches.front();
  const Ground ground{stretch.lane, stretch.lane_from,
                      elevation_at(model_.road.lane(stretch.lane), stretch.lane_from)};
  std::optional<double> speed;
  if (details.is_person) {
    const Vec2 left = left_of(path->line.direction_at(0.0)), middle = path->line.point_at(0.0);
    const double half_width = agent.footprint.vertices[1].y();
    std::vector<double> places =
        entry_offsets((agent.position - middle).dot(left), half_width + 0.1 - stretch.room_right,
                      stretch.room_left - half_width - 0.1);
    auto put_at = [&](double offset) { agent.position = middle + offset * left; };
    std::erase_if(places, [&](double offset) {
      put_at(offset);
      return is_walled_off(model_, agent, middle);
    });
    // where walls leave nothing else, amid the way
    if (places.empty()) places.push_back(0.0);
    for (const double offset : places) {
      put_at(offset);
      speed = entry_speed(model_, *path, agent, ground, road, scene);
      if (speed) break;
    }
  } else {
    speed = entry_speed(model_, *path, agent, ground, road, scene);
  }
  if (!speed) return false;
  agent.speed = *speed;

  register_agent(details, false, time_);
  if (!details.is_person) backend_.take_over(details.id, agent.speed);
  road.paths.resize(known_.size());
  road.paths[id.value] = path;
  append_agent(scene, agent);
  scene.height.back() = ground.height;
  ++life_cycle_.by_type[type_of(model_.types, pending.type).name].inserted;
  // spread over the run, a few ghosts at a time are read back
  if (written_.size() < options_.watched) {
    backend_.watch(details.id, details.is_person);
    written_.emplace(details.id, std::pair(id, Vec2(Vec2::Constant(std::nan("")))));
  }
  return true;
}

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

void SumoWorld::update_external(Scene& scene, RoadState& road) {
  for (const SumoAgent& seen : step_.agents) {
    // SUMO's invalid numbers (-2^30): between two places, as while it is teleported
    if (!(std::abs(seen.speed) < 1e4) || !(seen.position.norm() < 1e8)) continue;
    const auto arriving = external_arriving_.find(seen.id);
    const double heading = heading_from_sumo(seen.angle);
    if (arriving != external_arriving_.end()) {
      const SumoAgentDetails& details = arriving->second.details;
      const AgentType& type = type_of(model_.types, arriving->second.type);
      const AgentId id = register_agent(details, true, time_);
      AgentState agent;
      agent.id = id;
      agent.type = arriving->second.type;
      agent.footprint = details.is_person ? box_footprint(type.length, type.width)
                                          : box_footprint(details.length, details.width);
      agent.position = reference_point(seen.position, heading, -known_[id.value].length);
      agent.heading = heading;
      agent.speed = seen.speed;
      agent.preferred_speed = details.max_speed;
      agent.behavior = draw_behavior(type, options_.seed, id);
      agent.control = Control::External;
      road.paths.resize(known_.size());
      if (arriving->second.path) {
        agent.path = static_cast<PathId>(id.value);
        road.paths[id.value] = arriving->second.path;
      }
      append_agent(scene, agent);
      place_external(seen, scene, scene.size() - 1);
      ++life_cycle_.by_type[type.name].inserted;
      external_ids_.emplace(seen.id, id);
      external_arriving_.erase(arriving);
      continue;
    }
    const auto external = external_ids_.find(seen.id);
    if (external == external_ids_.end()) continue;
    const AgentId id = external->second;
    const std::size_t row = find_row(scene, id);
    if (row == scene.size()) continue;
    const Vec2 velocity = seen.speed * direction_of(heading);
    scene.acceleration[row] = (velocity - scene.velocity[row]) / options_.dt;
    scene.position[row] = reference_point(seen.position, heading, -known_[id.value].length);
    scene.heading[row] = heading;
    scene.velocity[row] = velocity;
    scene.speed[row] = seen.speed;
    place_external(seen, scene, row);
    const Path* path = road.path(scene.path[row]);
    if (path != nullptr && scene.path_along[row] == 0.0)
      scene.path_along[row] = path->line.project(scene.position[row]).along;
    if (path != nullptr && in_region(scene.position[row])) take_over(id, scene, row);
  }
}

bool SumoWorld::in_region(const Vec2& position) const {
  const ControlChoice& control = options_.control;
  return control.has_region && (position.array() >= control.region_low.array()).all() &&
         (position.array() <= control.region_high.array()).all();
}

/// From SUMO to us, in motion: the pose stays, only who decides on the next one changes. It stays
/// ours until it arrives.
void SumoWorld::take_over(AgentId id, Scene& scene, std::size_t row) {
  Known& known = known_[id.value];
  backend_.unwatch(known.sumo_id, known.is_person);
  if (!known.is_person) backend_.take_over(known.sumo_id, scene.speed[row]);
  known.external = known.speed_held = false;
  scene.control[row] = Control::Gamma;
  scene.manners[row] =
      draw_manners(type_of(model_.types, scene.type[row]).compliance, options_.seed, id.value);
  scene.steering[row] = 0.0;
  external_ids_.erase(known.sumo_id);
}

/// SUMO is blind to ghosts: a vehicle that it drives is slowed by us where a ghost binds it, and
/// given back after.
void SumoWorld::hold_followers(const Scene& scene) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::External) continue;
    Known& known = known_[scene.id[row].value];
    if (known.is_person) continue;
    const RoadContext& context = scene.context[row];
    const std::size_t foe = foe_row(scene, row);
    const bool bound = foe < scene.size() && scene.control[foe] == Control::Gamma &&
                       context.allowed_speed < scene.speed[row] + 1.0;
    if (bound)
      backend_.set_speed(known.sumo_id, context.allowed_speed);
    else if (known.speed_held)
      backend_.set_speed(known.sumo_id, -1.0);
    known.speed_held = bound;
  }
}

void SumoWorld::compare_poses() {
  for (const SumoAgent& seen : step_.agents) {
    const auto sent = written_.find(seen.id);
    if (sent != written_.end() && coupling_.compare && sent->second.second.allFinite())
      coupling_.compare(sent->second.second, seen.position);
  }
}

void SumoWorld::advance(const Scene& scene) {
  if (options_.control.any()) {
    hold_followers(scene);
    feed_detectors(scene);
  }
  vehicle_poses_.clear();
  person_poses_.clear();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    const Known& known = known_[scene.id[row].value];
    SumoPose pose{&known.sumo_id,
                  reference_point(scene.position[row], scene.heading[row], known.length),
                  sumo_from_heading(scene.heading[row])};
    pose.speed = speeds_.update(scene, row, pose.position, options_.dt);
    (known.is_person ? person_poses_ : vehicle_poses_).push_back(pose);
    const auto watched = written_.find(known.sumo_id);
    if (watched != written_.end()) watched->second.second = pose.position;
  }
  const Vec2 waiting_place = lobby(model_.road);
  for (const Pending& pending : pending_) {
    const SumoPose pose{&pending.details.id, waiting_place, 0.0};
    (pending.details.is_person ? person_poses_ : vehicle_poses_).push_back(pose);
  }
  backend_.step(vehicle_poses_, person_poses_, step_);
  time_ = step_.time;
  coupling_.teleports += step_.teleports;
  coupling_.emergency_stops += step_.emergency_stops;
  coupling_.sumo_collisions += step_.collisions;
  compare_poses();
}

bool SumoWorld::finished() const { return false; }

}  // namespace sumogamma
