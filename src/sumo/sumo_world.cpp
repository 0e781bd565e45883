#include "sumo/sumo_world.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "base/units.h"
#include "sumo/signals.h"
#include "sumo/sumo_agents.h"

namespace sumogamma {

namespace {

/// Off the map: where agents wait that SUMO has inserted and that have no room yet.
Vec2 lobby(const RoadNetwork& network) { return network.upper_corner + Vec2(100.0, 100.0); }

}  // namespace

SumoWorld::SumoWorld(Model& model, SumoBackend& backend, SumoWorldOptions options)
    : model_(model),
      backend_(backend),
      options_(std::move(options)),
      locator_(model.road),
      rows_(model, options_.type_keys),
      time_(backend.time()),
      detectors_(find_loop_detectors(model.road, backend, time_)),
      signal_order_(signals_in_order(model.road, backend)),
      link_pieces_(find_link_pieces(model.road)),
      limits_(find_changing_limits(model.road, options_.sign_lanes, options_.others_steer)),
      edge_speeds_(model.road) {
  for (const std::string& name : options_.rerouter_edges) {
    const auto edge = model_.road.edge_by_name.find(name);
    if (edge == model_.road.edge_by_name.end()) continue;
    at_rerouter_.resize(model_.road.edges.size(), false);
    at_rerouter_[index_of(edge->second)] = true;
  }
}

void SumoWorld::observe(Scene& scene, RoadState& road) {
  scene.time = time_;
  road_ = &road;
  road.signal_states.resize(model_.road.signals.size());
  road.signal_since.resize(model_.road.signals.size(), time_);
  road.amber_until.resize(model_.road.signals.size(), time_);
  show_signals(signal_order_, step_, time_, backend_, road);
  take_arrived(scene, road);
  finish_driven(scene, road);
  follow_limits(scene, road);
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
  for (auto* const list : {&step_.departed_vehicles, &step_.departed_persons,
                           &step_.arrived_vehicles, &step_.arrived_persons, &step_.lost})
    list->clear();
  step_.gone.clear();
}

void SumoWorld::advance(const Scene& scene) {
  send(scene);
  receive();
}

void SumoWorld::send(const Scene& scene) {
  if (options_.control.any()) {
    hold_drivers(scene);
    note_passages(scene, known_, time_, detectors_);
    if (!detectors_.ages.empty()) backend_.override_detectors(detectors_.ages);
  }
  vehicle_poses_.clear();
  person_poses_.clear();
  collect_poses(scene);
  collect_waiting();
  backend_.send(vehicle_poses_, person_poses_);
}

void SumoWorld::receive() {
  backend_.receive(step_);
  note_step();
  compare_poses();
}

/// Poses of those whom we drive. Who enters an edge with rerouters is shown to them instead.
void SumoWorld::collect_poses(const Scene& scene) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (!is_ours(scene.control[row])) continue;
    const KnownAgent& known = known_[scene.id[row].value];
    if (known.service != StopService::None) continue;  // SUMO has it
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
}

/// Poses of those who wait to enter.
void SumoWorld::collect_waiting() {
  const Vec2 waiting_place = lobby(model_.road);
  for (PendingAgent& pending : pending_) {
    const bool parked = pending.waits_at.allFinite();
    // once off its lane a vehicle stays off it, unseen, until it is moved again; for each that is
    // moved SUMO searches its backlog
    if (std::exchange(pending.off_lane, true) && !parked && !pending.details.is_person) continue;
    const SumoPose pose{&pending.details.id, parked ? pending.waits_at : waiting_place,
                        parked ? pending.waiting_angle : 0.0};
    (pending.details.is_person ? person_poses_ : vehicle_poses_).push_back(pose);
  }
  for (DelayedVehicle& delayed : delayed_)
    if (!std::exchange(delayed.off_lane, true))
      vehicle_poses_.push_back({&delayed.pending.details.id, waiting_place, 0.0});
}

void SumoWorld::note_step() {
  time_ = step_.time;
  coupling_.teleports += step_.teleports;
  coupling_.emergency_stops += step_.emergency_stops;
  coupling_.sumo_collisions += step_.collisions;
}

void SumoWorld::compare_poses() {
  for (const SumoAgent& seen : step_.agents) {
    const auto sent = written_.find(seen.id);
    if (sent != written_.end() && coupling_.compare && sent->second.second.allFinite())
      coupling_.compare(sent->second.second, seen.position);
  }
}

std::size_t SumoWorld::riding() const {
  return static_cast<std::size_t>(std::count_if(
      absent_.begin(), absent_.end(), [](const auto& absent) { return absent.first.first; }));
}

bool SumoWorld::finished() const { return false; }

}  // namespace sumogamma
