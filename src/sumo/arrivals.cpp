// From the scene to the end of a journey.

#include <algorithm>

#include "scene/locate.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

void SumoWorld::forget(AgentId id, Scene& scene, RoadState& road, std::vector<bool>& removed,
                       std::size_t row) {
  if (removed.empty()) removed.assign(scene.size(), false);
  removed[row] = true;
  if (id.value < road.paths.size()) road.paths[id.value] = nullptr;
  written_.erase(known_[id.value].sumo_id);
}

void SumoWorld::record_arrival(const SumoTraveller& traveller) {
  const auto journey = journeys_.find(traveller);
  if (journey == journeys_.end()) return;
  const auto& [id, type, departed] = journey->second;
  ++life_cycle_.by_type[type_of(model_.types, type).name].arrived;
  life_cycle_.trips.push_back({id, type, departed, time_});
  journeys_.erase(journey);
}

/// SUMO has refused its pose: it vanished there between read and write.
void SumoWorld::take_refused(const std::string& sumo_id, Scene& scene, RoadState& road,
                             std::vector<bool>& removed) {
  std::erase_if(pending_,
                [&](const PendingAgent& pending) { return pending.details.id == sumo_id; });
  std::erase_if(delayed_, [&](const DelayedVehicle& delayed) {
    return delayed.pending.details.id == sumo_id;
  });
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const KnownAgent& known = known_[scene.id[row].value];
    if (known.external || known.sumo_id != sumo_id) continue;
    ++life_cycle_.removed["refused by SUMO"];
    journeys_.erase({known.is_person, sumo_id});
    forget(scene.id[row], scene, road, removed, row);
  }
}

void SumoWorld::take_arrived(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  auto arrived = [&](bool is_person, const std::string& sumo_id) {
    const SumoTraveller traveller{is_person, sumo_id};
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
  for (const std::string& lost : step_.lost) take_refused(lost, scene, road, removed);
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
    return next_stop(path, scene, row) == nullptr &&
           along + 0.5 * length + 0.3 + 2.0 * scene.speed[row] * dt >= path.arrival;
  return along + kOnFoot >= path.arrival ||
         (along + kInCrowd >= path.arrival && scene.held[row].standing > kStood);
}

}  // namespace

void SumoWorld::finish_driven(Scene& scene, RoadState& road) {
  std::vector<bool> removed;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (!is_ours(scene.control[row])) continue;
    const KnownAgent& known = known_[scene.id[row].value];
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

}  // namespace sumogamma
