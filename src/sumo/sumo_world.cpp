#include "sumo/sumo_world.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

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
      locator_(model.road),
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
  read_links();
  edge_speeds_ = EdgeSpeeds(model_.road);
  for (const std::string& name : options_.rerouter_edges) {
    const auto edge = model_.road.edge_by_name.find(name);
    if (edge == model_.road.edge_by_name.end()) continue;
    at_rerouter_.resize(model_.road.edges.size(), false);
    at_rerouter_[index_of(edge->second)] = true;
  }
  for (const std::string& name : options_.sign_lanes) {
    const auto lane = model_.road.lane_by_name.find(name);
    if (lane != model_.road.lane_by_name.end()) limited_.push_back(lane->second);
  }
  if (options_.others_steer) {
    limited_.clear();
    for (std::size_t i = 0; i < model_.road.lanes.size(); ++i)
      if (model_.road.lanes[i].kind == LaneKind::Normal) limited_.push_back(static_cast<LaneId>(i));
  }
  if (limited_.empty()) return;
  limits_ = std::make_shared<std::vector<double>>();
  for (const Lane& lane : model_.road.lanes) limits_->push_back(lane.speed_limit);
}

void SumoWorld::read_detectors() {
  for (const SumoBackend::Detector& detector : backend_.detectors()) {
    const auto lane = model_.road.lane_by_name.find(detector.lane);
    if (lane == model_.road.lane_by_name.end()) continue;
    detectors_[lane->second].push_back({detector_ages_.size(), detector.position, time_});
    detector_ages_.emplace_back(detector.id, 0.0);
  }
}

/// Actuated signals don't see ghosts: they are told when a vehicle was last on each of their loops.
void SumoWorld::feed_detectors(const Scene& scene) {
  if (detectors_.empty()) return;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    // an override hides SUMO's own vehicles from the loop: they are reported, too
    if (scene.control[row] == Control::Parked || known_[scene.id[row].value].is_person) continue;
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

void SumoWorld::observe(Scene& scene, RoadState& road) {
  scene.time = time_;
  road_ = &road;
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
  read_speed_limits(scene, road);
  take_departed();
  find_centers(scene);
  read_wishes();
  update_external(scene, road);
  hand_back(scene);
  follow_rerouters(scene, road);
  look_for_faster_routes(scene, road);
  tell_routes(scene, road);
  begin_services(scene, road);
  insert_pending(scene, road);
  insert_delayed(scene);
  // each event is handled once
  step_.departed_vehicles.clear();
  step_.departed_persons.clear();
  step_.arrived_vehicles.clear();
  step_.arrived_persons.clear();
  step_.lost.clear();
  step_.gone.clear();
}

void SumoWorld::take_departed() {
  if (!observed_) {
    // of a loaded state, or of a SUMO that has run before us
    observed_ = true;
    for (SumoAgentDetails& details :
         backend_.details(backend_.present_vehicles(), backend_.present_persons()))
      take_newcomer(std::move(details), true);
  }
  if (step_.departed_vehicles.empty() && step_.departed_persons.empty()) return;
  for (SumoAgentDetails& details :
       backend_.details(step_.departed_vehicles, step_.departed_persons))
    take_newcomer(std::move(details), false);
}

namespace {

/// Why nobody but SUMO can move an agent; empty: we can.
std::string_view sumos_own(const AgentType& type, const SumoAgentDetails& details) {
  if (type.guided) return "on rails or water";
  if (details.is_taxi) return "a taxi: SUMO's dispatch sends it";
  return "";
}

/// Does a vehicle depart at the first stop of its plan?
bool departs_at_stop(const SumoAgentDetails& details) {
  constexpr double kAt = 0.1;  // [m]
  if (details.is_person || details.stops.empty()) return false;
  if (stop_state::stopped(details.stop_state)) return true;
  const SumoAgentDetails::Stop& first = details.stops.front();
  return first.lane == details.lane && first.speed <= 0.0 &&
         details.lane_position > first.start - kAt && details.lane_position < first.end + kAt;
}

}  // namespace

void SumoWorld::take_newcomer(SumoAgentDetails details, bool moves_already) {
  auto type = agent_type_of(model_.types, details);
  if (!type) {
    ++life_cycle_.left_to_sumo["of no known class"];
    return;
  }
  type = rows_.row_of(*type, details);
  const AgentType& kind = type_of(model_.types, *type);
  Pending pending;
  pending.details = std::move(details);
  pending.type = *type;
  choose_pace(model_.road, pending.details);
  const std::uint32_t rules = rules_for(pending.details, *type);
  bool driven = is_always_ours(rules);
  const std::string_view sumos = sumos_own(kind, pending.details);
  if (rules != 0 && !sumos.empty()) {
    driven = false;
    ++life_cycle_.left_to_sumo[std::string(sumos)];
  }
  if (rules != 0 && sumos.empty()) choose_speed_factor(kind, options_.seed, pending.details);
  if (driven) choose_mid_block(kind, options_.seed, pending.details);
  const bool walks = pending.details.stage == StageKind::Walking;
  const bool later = pending.details.is_person ? !walks : departs_at_stop(pending.details);
  pending.resumes = driven && (later || moves_already);
  if (options_.control.any() && !pending.details.route.empty()) {
    std::string why;
    pending.path = path_of(model_, pending.details, *type, why, limits_);
    if (driven && !pending.path) {
      driven = pending.resumes = false;
      ++life_cycle_.left_to_sumo[why];
      spdlog::warn("{}: left to SUMO: {}", pending.details.id, why);
    }
  }
  if (driven && !pending.resumes) {
    if (!pending.details.is_person) backend_.take_over(pending.details.id, 0.0);
    pending_.push_back(std::move(pending));
    return;
  }
  backend_.watch(pending.details.id, pending.details.is_person);
  Traveller traveller{pending.details.is_person, pending.details.id};
  external_arriving_.insert_or_assign(std::move(traveller), std::move(pending));
}

AgentId SumoWorld::register_agent(const SumoAgentDetails& details, bool external,
                                  AgentTypeId type) {
  const AgentId id{static_cast<std::uint32_t>(known_.size())};
  Known known;
  known.sumo_id = details.id;
  known.is_person = details.is_person;
  known.external = external;
  known.length = details.is_person ? 0.0 : details.length;
  known.stops = details.stops;
  known.stages_left = details.stages_left;
  known.type_id = details.type_id;
  known.rules = rules_for(details, type);
  known.sumos_own = !sumos_own(type_of(model_.types, type), details).empty();
  known.route = details.route;
  known.reroute_period = details.reroute_period;
  known.next_reroute = time_ + details.reroute_period;
  if (details.reroute_period > 0.0) has_rerouting_ = true;
  // who departs on an edge with rerouters has been seen by them
  const auto edge = details.route.empty() ? model_.road.edge_by_name.end()
                                          : model_.road.edge_by_name.find(details.route.front());
  if (edge != model_.road.edge_by_name.end()) known.edge = edge->second;
  known_.push_back(std::move(known));
  names_.push_back(details.id);
  const bool first =
      journeys_.try_emplace({details.is_person, details.id}, Journey{id, type, time_}).second;
  if (first) ++life_cycle_.by_type[type_of(model_.types, type).name].inserted;
  return id;
}

void SumoWorld::forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
                       std::size_t row) {
  if (removed.empty()) removed.assign(scene.size(), false);
  removed[row] = true;
  if (id.value < road.paths.size()) road.paths[id.value] = nullptr;
  written_.erase(known_[id.value].sumo_id);
}

void SumoWorld::record_arrival(const Traveller& traveller) {
  const auto journey = journeys_.find(traveller);
  if (journey == journeys_.end()) return;
  const auto& [id, type, departed] = journey->second;
  ++life_cycle_.by_type[type_of(model_.types, type).name].arrived;
  life_cycle_.trips.push_back({id, type, departed, time_});
  journeys_.erase(journey);
}

void SumoWorld::take_arrived(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  auto arrived = [&](bool is_person, const std::string& sumo_id) {
    const Traveller traveller{is_person, sumo_id};
    external_arriving_.erase(traveller);
    absent_.erase(traveller);
    record_arrival(traveller);
    const auto external = external_ids_.find(traveller);
    if (external == external_ids_.end()) return;
    const AgentId id = external->second;
    const std::size_t row = find_row(scene, id);
    external_ids_.erase(external);
    if (row < scene.size()) forget(id, scene, road, removed, row);
  };
  for (const std::string& id : step_.arrived_vehicles) arrived(false, id);
  for (const std::string& id : step_.arrived_persons) arrived(true, id);
  // who sat in a vehicle of ours that has arrived got out there: SUMO lists that before its step
  for (const auto& [is_person, id] : step_.gone) arrived(is_person, id);
  // refused by SUMO: it vanished there between read and write
  for (const std::string& lost : step_.lost) {
    std::erase_if(pending_, [&](const Pending& pending) { return pending.details.id == lost; });
    std::erase_if(delayed_,
                  [&](const Delayed& delayed) { return delayed.pending.details.id == lost; });
    for (std::size_t row = 0; row < scene.size(); ++row) {
      const Known& known = known_[scene.id[row].value];
      if (known.external || known.sumo_id != lost) continue;
      ++life_cycle_.removed["refused by SUMO"];
      journeys_.erase({known.is_person, lost});
      forget(scene.id[row], scene, road, removed, row);
    }
  }
  if (!removed.empty()) remove_agents(scene, removed);
}

namespace {

/// Is a driven agent at the end of its path? Vehicles arrive with their front, before it crosses
/// whatever line is there (the place on the path is that of a tick ago), walkers when they are
/// there within a step or two, and where others wait for a ride, too, behind those.
bool is_at_end(const Path& path, const Scene& scene, std::size_t row, double length, double dt) {
  constexpr double kOnFoot = 0.7, kInCrowd = 3.0;  // [m]
  constexpr double kStood = 2.0;                   // [s]
  const double along = scene.path_along[row];
  if (!path.walking)
    return static_cast<std::size_t>(scene.halt[row].next) >= path.stops.size() &&
           along + 0.5 * length + 0.3 + 2.0 * scene.speed[row] * dt >= path.arrival;
  return along + kOnFoot >= path.arrival ||
         (along + kInCrowd >= path.arrival && scene.held[row].standing > kStood);
}

}  // namespace

void SumoWorld::finish_driven(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    const Known& known = known_[scene.id[row].value];
    if (!is_at_end(*road.path(scene.path[row]), scene, row, known.length, options_.dt)) continue;
    if (known.is_person) {
      const StageKind next = backend_.finish_stage(known.sumo_id);
      if (next == StageKind::Walking && walk_on(scene, road, row)) continue;
      if (next != StageKind::None && next != StageKind::Walking) {
        hand_over_person(scene.id[row], row, scene, road);
        continue;
      }
      if (next == StageKind::Walking) {
        journeys_.erase({true, known.sumo_id});
        forget(scene.id[row], scene, road, removed, row);
        continue;
      }
    } else {
      backend_.remove_vehicle(known.sumo_id);
    }
    record_arrival({known.is_person, known.sumo_id});
    forget(scene.id[row], scene, road, removed, row);
  }
  if (!removed.empty()) remove_agents(scene, removed);
}

void SumoWorld::insert_pending(Scene& scene, RoadState& road) {
  life_cycle_.waiting = pending_.size();
  if (pending_.empty()) return;
  ghosts_.rebuild(scene.position);
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
  agent.manners = draw_manners(type.compliance, options_.seed, id.value);
  agent.manners.path_offset = draw_path_offset(model_, type, options_.seed, id);
  const PathStretch& stretch = path.stretches.front();
  const double half_width = 0.5 * width;
  const double offset =
      std::clamp(agent.manners.path_offset, std::min(0.0, half_width + 0.1 - stretch.room_right),
                 std::max(0.0, stretch.room_left - half_width - 0.1));
  agent.position = path.line.point_at(0.0) + offset * left_of(direction);
  agent.heading = heading_of(direction);
  agent.preferred_speed =
      details.max_speed > 0.0
          ? std::min(details.max_speed * (details.is_person ? details.speed_factor : 1.0),
                     type.max_speed)
          : type.preferred_speed;
  agent.behavior = draw_behavior(type, options_.seed, id);
  agent.path = static_cast<PathId>(id.value);
  return agent;
}

bool SumoWorld::insert(Pending& pending, Scene& scene, RoadState& road) {
  if (insert_on(pending, pending.path, pending.blocker, scene, road)) return true;
  if (!pending.path->trip) return false;
  if (!std::exchange(pending.looked_besides, true))
    for (auto& path : paths_besides(model_, pending.details, pending.type, *pending.path))
      pending.besides.push_back({std::move(path), {}});
  for (Pending::Beside& beside : pending.besides)
    if (insert_on(pending, beside.path, beside.blocker, scene, road)) return true;
  return false;
}

bool SumoWorld::insert_on(const Pending& pending, const std::shared_ptr<const Path>& path,
                          std::optional<AgentId>& blocker, Scene& scene, RoadState& road) {
  const SumoAgentDetails& details = pending.details;
  const AgentId id{static_cast<std::uint32_t>(known_.size())};
  AgentState agent = newcomer(pending, *path, id);
  const PathStretch& stretch = path->stretches.front();
  const Ground ground{stretch.lane, stretch.lane_from,
                      elevation_at(model_.road.lane(stretch.lane), stretch.lane_from)};
  const EntryView view{model_, road, scene, ghosts_};
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
      speed = entry_speed(view, *path, agent, ground, blocker);
      if (speed) break;
    }
  } else {
    speed = entry_speed(view, *path, agent, ground, blocker);
  }
  if (!speed) return false;
  agent.speed = *speed;

  register_agent(details, false, pending.type);
  if (!details.is_person) backend_.take_over(details.id, agent.speed);
  road.paths.resize(known_.size());
  road.paths[id.value] = path;
  append_agent(scene, agent);
  scene.height.back() = ground.height;
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
  std::vector<bool> removed;
  if (!external_arriving_.empty() || changes_hands()) ghosts_.rebuild(scene.position);
  for (const SumoAgent& seen : step_.agents) {
    // SUMO's invalid numbers (-2^30): between two places, as while it is teleported
    if (!(std::abs(seen.speed) < 1e4) || !(seen.position.norm() < 1e8)) continue;
    const Traveller traveller{seen.is_person, seen.id};
    if (absent_.contains(traveller)) watch_absent(seen, scene);
    const auto arriving = external_arriving_.find(traveller);
    if (arriving != external_arriving_.end()) {
      Pending pending = std::move(arriving->second);
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

void SumoWorld::appear(const SumoAgent& seen, Pending& pending, Scene& scene, RoadState& road) {
  const SumoAgentDetails& details = pending.details;
  const AgentType& type = type_of(model_.types, pending.type);
  const Traveller traveller{seen.is_person, seen.id};
  const AgentId id = register_agent(details, true, pending.type);
  Known& known = known_[id.value];
  known.resumes = pending.resumes;
  known.stages_left = seen.stages_left;
  if (pending.resumes && departs_at_stop(details)) known.service = Service::Asked;
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
  agent.behavior = draw_behavior(type, options_.seed, id);
  agent.control = Control::External;
  road.paths.resize(known_.size());
  if (pending.path) {
    agent.path = static_cast<PathId>(id.value);
    road.paths[id.value] = pending.path;
  }
  append_agent(scene, agent);
  place_external(seen, scene, scene.size() - 1);
  external_ids_.insert_or_assign(traveller, id);
}

void SumoWorld::follow(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                       RoadState& road, std::vector<bool>& removed) {
  const Known& known = known_[id.value];
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
  if (known.watched_steps >= 0) watch_hand_back(seen, known_[id.value]);
  if (path != nullptr && !known.resumes && !stopped &&
      is_wanted(known, scene.position[row], false) && may_take(scene, row)) {
    take_over(id, scene, row);
    ++life_cycle_.taken_over;
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
    hold_drivers(scene);
    feed_detectors(scene);
  }
  vehicle_poses_.clear();
  person_poses_.clear();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    const Known& known = known_[scene.id[row].value];
    if (known.service != Service::None) continue;  // SUMO has it
    SumoPose pose{&known.sumo_id,
                  reference_point(scene.position[row], scene.heading[row], known.length),
                  sumo_from_heading(scene.heading[row])};
    pose.speed = speeds_.update(scene, row, pose.position, options_.dt);
    if (!known.is_person && enters_rerouter(scene, row)) {
      backend_.put_on_lane(pose, model_.road.lane(scene.lane[row].lane).name, pose.speed);
      shown_.push_back(scene.id[row]);
      continue;
    }
    (known.is_person ? person_poses_ : vehicle_poses_).push_back(pose);
    const auto watched = written_.find(known.sumo_id);
    if (watched != written_.end()) watched->second.second = pose.position;
  }
  const Vec2 waiting_place = lobby(model_.road);
  for (Pending& pending : pending_) {
    const bool parked = pending.waits_at.allFinite();
    // once off its lane a vehicle stays off it, unseen, until it is moved again; for each that is
    // moved SUMO searches its backlog
    if (std::exchange(pending.off_lane, true) && !parked && !pending.details.is_person) continue;
    const SumoPose pose{&pending.details.id, parked ? pending.waits_at : waiting_place,
                        parked ? pending.waiting_angle : 0.0};
    (pending.details.is_person ? person_poses_ : vehicle_poses_).push_back(pose);
  }
  for (Delayed& delayed : delayed_)
    if (!std::exchange(delayed.off_lane, true))
      vehicle_poses_.push_back({&delayed.pending.details.id, waiting_place, 0.0});
  backend_.step(vehicle_poses_, person_poses_, step_);
  time_ = step_.time;
  coupling_.teleports += step_.teleports;
  coupling_.emergency_stops += step_.emergency_stops;
  coupling_.sumo_collisions += step_.collisions;
  compare_poses();
}

bool SumoWorld::finished() const { return false; }

}  // namespace sumogamma
