// From SUMO's insertion into the scene: newcomers, who waits for room, who enters.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "sumo/scenario_inventory.h"
#include "sumo/sumo_agents.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

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

/// Most with which it may start, by its id or its flow's [m/s].
double depart_speed_of(const SumoWorldOptions& options, const SumoAgentDetails& details) {
  for (const std::string& name : {details.id, flow_of(details.id)})
    if (const auto found = options.depart_speeds.find(name);
        found != options.depart_speeds.end() && !details.is_person)
      return found->second;
  return std::numeric_limits<double>::infinity();
}

/// Why nobody but SUMO can move an agent; empty: we can.
std::string_view sumos_own(const AgentType& type, const SumoAgentDetails& details) {
  if (type.guided) return "on rails or water";
  if (details.is_taxi) return "a taxi: SUMO's dispatch sends it";
  return "";
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
  PendingAgent pending;
  pending.details = std::move(details);
  pending.type = *type;
  pending.since = time_;
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
    pending.entry.path = path_of(model_, pending.details, *type, why, limits_.limits);
    if (driven && !pending.entry.path) {
      driven = pending.resumes = false;
      ++life_cycle_.left_to_sumo[why];
      spdlog::warn("{}: left to SUMO: {}", pending.details.id, why);
    }
  }
  if (driven && !pending.resumes) {
    pending.depart_speed = depart_speed_of(options_, pending.details);
    if (!pending.details.is_person) backend_.take_over(pending.details.id, 0.0);
    pending_.push_back(std::move(pending));
    return;
  }
  backend_.watch(pending.details.id, pending.details.is_person);
  SumoTraveller traveller{pending.details.is_person, pending.details.id};
  external_arriving_.insert_or_assign(std::move(traveller), std::move(pending));
}

AgentId SumoWorld::register_agent(const SumoAgentDetails& details, bool external,
                                  AgentTypeId type) {
  const AgentId id{static_cast<std::uint32_t>(known_.size())};
  KnownAgent known;
  known.sumo_id = details.id;
  known.is_person = details.is_person;
  known.external = external;
  known.length = details.is_person ? 0.0 : details.length;
  known.min_gap = details.type.min_gap;
  known.max_speed = details.max_speed;
  known.speed_factor = details.speed_factor;
  known.bicycle = details.vehicle_class == "bicycle";
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
    const bool is_person = pending->details.is_person;
    const bool held_back = options_.max_vehicles > 0 && !is_person &&
                           vehicles >= options_.max_vehicles && pending->details.id != options_.ego;
    const PathStretch& start = pending->entry.path->stretches.front();
    const double place_length = is_person ? 1.0 : 10.0;
    const std::pair place(start.lane, static_cast<int>(start.lane_from / place_length));
    if (held_back || full.contains(place)) {
      ++pending;
      continue;
    }
    const AgentId id{static_cast<std::uint32_t>(known_.size())};
    auto entrant = find_room({model_, road, scene, ghosts_}, *pending, id, options_.seed);
    if (entrant) {
      enter(*pending, std::move(*entrant), scene, road);
      vehicles += is_person ? 0 : 1;
      pending = pending_.erase(pending);
    } else {
      full.insert(place);
      ++pending;
    }
  }
  life_cycle_.waiting = pending_.size();
}

void SumoWorld::enter(const PendingAgent& pending, Entrant entrant, Scene& scene, RoadState& road) {
  const SumoAgentDetails& details = pending.details;
  const AgentId id = register_agent(details, false, pending.type);
  if (pending.since >= 0.0) known_[id.value].waited = std::max(0.0, time_ - pending.since);
  if (!details.is_person) backend_.take_over(details.id, entrant.state.speed);
  road.paths.resize(known_.size());
  road.paths[id.value] = std::move(entrant.path);
  append_agent(scene, entrant.state);
  scene.height.back() = entrant.height;
  // spread over the run, a few ghosts at a time are read back
  if (written_.size() >= options_.watched) return;
  backend_.watch(details.id, details.is_person);
  written_.emplace(details.id, std::pair(id, Vec2(Vec2::Constant(std::nan("")))));
}

}  // namespace sumogamma
