// What plans hold besides ways: stops, parking places, rides. While an agent is at one SUMO has it,
// so that its duration, `until`, triggers, boarding and dispatch are SUMO's own; it is ours again
// as soon as it moves on (docs/coupling.md).

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/units.h"
#include "road/lane_locator.h"
#include "scene/extent.h"
#include "sumo/ghosts.h"
#include "sumo/sumo_agents.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();

bool same_stop(const SumoAgentDetails::Stop& a, const SumoAgentDetails::Stop& b) {
  constexpr double kSame = 0.01;  // [m]
  return a.lane == b.lane && std::abs(a.end - b.end) < kSame && a.place == b.place;
}

/// Are the last stops of `before` those of `now`?
bool same_plan(const std::vector<SumoAgentDetails::Stop>& before,
               const std::vector<SumoAgentDetails::Stop>& now) {
  return now.size() <= before.size() &&
         std::equal(now.rbegin(), now.rend(), before.rbegin(), same_stop);
}

}  // namespace

/// What SUMO knows of one agent; nothing where it is gone.
std::optional<SumoAgentDetails> SumoWorld::details_of(const std::string& id, bool is_person) {
  const std::string ids[] = {id};
  auto all = is_person ? backend_.details({}, ids) : backend_.details(ids, {});
  if (all.empty() || all.front().type_id.empty()) return std::nullopt;
  return std::move(all.front());
}

/// The way of somebody whom we are going to drive, at a pace and with habits of its own, which are
/// put into `details`. Null, with a word, where it stays SUMO's.
std::shared_ptr<const Path> SumoWorld::way_of(SumoAgentDetails& details, AgentTypeId type) {
  choose_pace(model_.road, details);
  choose_speed_factor(type_of(model_.types, type), options_.seed, details);
  choose_mid_block(type_of(model_.types, type), options_.seed, details);
  std::string why;
  auto path = path_of(model_, details, type, why, limits_.limits);
  if (path) return path;
  ++life_cycle_.left_to_sumo[why];
  spdlog::warn("{}: left to SUMO: {}", details.id, why);
  return nullptr;
}

bool SumoWorld::is_out_of_sight(const SumoAgent& seen, double length, const Scene& scene) const {
  if (seen.is_person) return !seen.rides.empty();
  if (!stop_state::parked(seen.stop_state)) return false;
  const auto own = external_ids_.find({false, seen.id});
  // beside a lane SUMO has one place for all who park at a stop: the first is seen there
  constexpr double kSamePlace = 3.0;  // [m]
  const Vec2 center = seen.position - 0.5 * length * direction_of(heading_from_sumo(seen.angle));
  for (std::size_t row = 0; row < scene.size(); ++row)
    if (scene.control[row] == Control::Parked &&
        (own == external_ids_.end() || scene.id[row].value != own->second.value) &&
        (scene.position[row] - center).norm() < kSamePlace)
      return true;
  // SUMO's places beside a lane may lie on its neighbours, where nobody of SUMO's minds them
  const Vec2 forward = direction_of(heading_from_sumo(seen.angle));
  std::vector<LaneHit> hits;
  for (const double share : {0.0, 0.5, 1.0}) {
    locator_.find_containing(seen.position - share * length * forward, hits);
    if (!hits.empty()) return true;
  }
  return false;
}

void SumoWorld::leave_sight(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                            RoadState& road, std::vector<bool>& removed) {
  const KnownAgent& known = known_[id.value];
  PendingAgent absent;
  absent.details.id = seen.id;
  absent.details.is_person = seen.is_person;
  absent.details.length = known.length;
  absent.type = scene.type[row];
  absent.resumes = known.resumes;
  if (!seen.rides.empty()) ++life_cycle_.rides;
  external_ids_.erase({seen.is_person, seen.id});
  absent_.insert_or_assign({seen.is_person, seen.id}, std::move(absent));
  forget(id, scene, road, removed, row);
}

void SumoWorld::watch_absent(const SumoAgent& seen, const Scene& scene) {
  const auto absent = absent_.find({seen.is_person, seen.id});
  if (is_out_of_sight(seen, absent->second.details.length, scene)) return;
  PendingAgent pending = std::move(absent->second);
  absent_.erase(absent);
  if (pending.resumes && rejoin(seen, !seen.is_person)) return;
  // SUMO moves it on, or it waits for its next ride
  auto details = details_of(seen.id, seen.is_person);
  if (!details) return;
  pending.details = std::move(*details);
  external_arriving_.insert_or_assign({seen.is_person, seen.id}, std::move(pending));
}

/// A person or vehicle whom SUMO has had for a while and who goes on by its own means, from where
/// there is room: true. False where it does not.
bool SumoWorld::rejoin(const SumoAgent& seen, bool parked) {
  auto details = details_of(seen.id, seen.is_person);
  if (!details || (seen.is_person && details->stage != StageKind::Walking)) return false;
  const auto type = agent_type_of(model_.types, *details);
  if (!type) return false;
  PendingAgent pending;
  pending.type = rows_.row_of(*type, *details);
  pending.entry.path = way_of(*details, pending.type);
  if (!pending.entry.path) return false;
  if (parked) {
    pending.waits_at = seen.position;
    pending.waiting_angle = seen.angle;
  }
  pending.details = std::move(*details);
  backend_.unwatch(seen.id, seen.is_person);
  if (!seen.is_person) backend_.take_over(seen.id, 0.0);
  pending_.push_back(std::move(pending));
  return true;
}

/// The next walk of a person who has just ended one where it stands.
bool SumoWorld::walk_on(Scene& scene, RoadState& road, std::size_t row) {
  const AgentId id = scene.id[row];
  auto details = details_of(known_[id.value].sumo_id, true);
  auto path = details ? way_of(*details, scene.type[row]) : nullptr;
  if (!path) {
    ++life_cycle_.removed["next walk impossible"];
    return false;
  }
  scene.path[row] = static_cast<PathId>(id.value);
  scene.path_along[row] = path->line.project(scene.position[row]).along;
  road.paths[id.value] = std::move(path);
  return true;
}

/// A person whose walk is over and who waits now, for a time or for a ride: SUMO tells where.
void SumoWorld::hand_over_person(AgentId id, std::size_t row, Scene& scene, RoadState& road) {
  KnownAgent& known = known_[id.value];
  known.external = known.resumes = known.keeps_place = true;
  known.stages_left = 0;
  written_.erase(known.sumo_id);
  road.paths[id.value] = nullptr;
  scene.path[row] = kNoPath;
  scene.control[row] = Control::External;
  scene.velocity[row] = scene.acceleration[row] = Vec2::Zero();
  scene.speed[row] = 0.0;
  backend_.watch(known.sumo_id, true);
  external_ids_.insert_or_assign({true, known.sumo_id}, id);
}

/// From SUMO to us where it stands or drives: somebody whose wait is over, a vehicle of a loaded
/// state. False: not yet.
bool SumoWorld::take_back(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                          RoadState& road) {
  constexpr double kPatience = 5.0;  // [s]
  KnownAgent& known = known_[id.value];
  if (seen.is_person) {
    const int before = std::exchange(known.stages_left, seen.stages_left);
    if (before == 0 || before == seen.stages_left) return false;
  } else {
    if (stop_state::stopped(seen.stop_state)) known.service = StopService::Standing;
    const bool to_stop = known.service == StopService::Asked && time_ < known.asked_at + kPatience;
    if (stop_state::stopped(seen.stop_state) || to_stop || scene.control[row] == Control::Parked)
      return false;
    const auto lane = model_.road.lane_by_name.find(seen.lane);
    if (lane == model_.road.lane_by_name.end() ||
        model_.road.lane(lane->second).kind != LaneKind::Normal)
      return false;
  }
  auto details = details_of(seen.id, seen.is_person);
  if (!details || (seen.is_person && details->stage != StageKind::Walking)) return false;
  if (!seen.is_person && touches(scene, row)) return false;
  auto path = way_of(*details, scene.type[row]);
  if (!path) {
    known.resumes = false;
    return false;
  }
  known.stops = std::move(details->stops);
  known.route = std::move(details->route);
  scene.path[row] = static_cast<PathId>(id.value);
  scene.path_along[row] = path->line.project(scene.position[row]).along;
  scene.halt[row].next = 0;
  road.paths[id.value] = std::move(path);
  take_over(id, scene, row);
  return true;
}

/// Vehicles of ours that have come to stand at a stop of their plan are put onto SUMO's lane there.
void SumoWorld::begin_services(Scene& scene, const RoadState& road) {
  constexpr double kBefore = 0.1;  // SUMO refuses a stop that a vehicle has passed [m]
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.halt[row].left != kForever || scene.control[row] != Control::Gamma) continue;
    const AgentId id = scene.id[row];
    KnownAgent& known = known_[id.value];
    if (known.service != StopService::None) continue;
    const Path& path = *road.path(scene.path[row]);
    const auto plan =
        static_cast<std::size_t>(path.stops[static_cast<std::size_t>(scene.halt[row].next)].plan);
    const SumoAgentDetails::Stop& stop = known.stops[plan];
    const Lane& lane = model_.road.lane(model_.road.lane_by_name.at(stop.lane));
    const Vec2 forward = direction_of(scene.heading[row]);
    SumoPose pose{&known.sumo_id, scene.position[row] + 0.5 * known.length * forward,
                  sumo_from_heading(scene.heading[row])};
    // its own pose where that is in the stop's lane and not beyond its end, else the place there
    const PolylinePosition place = lane.centerline.project(pose.position);
    const double scale = lane.length > 0.0 ? lane.centerline.length() / lane.length : 1.0;
    const double last = scale * stop.end - kBefore;
    if (std::abs(place.offset) > 0.5 * lane.width || place.along > last)
      pose.position = lane.centerline.point_at(std::min(place.along, last));
    const auto details = details_of(known.sumo_id, false);
    const bool listed =
        details && std::any_of(details->stops.begin(), details->stops.end(),
                               [&](const auto& other) { return same_stop(stop, other); });
    backend_.put_on_lane(pose, stop.lane, 0.0);
    backend_.release(known.sumo_id);
    // SUMO changes lanes before it looks for stops
    backend_.allow_lane_changes(known.sumo_id, false);
    // SUMO forgets the stops of the edge on which a vehicle is taken over
    if (!listed) backend_.add_stop(known.sumo_id, stop);
    backend_.watch(known.sumo_id, false);
    external_ids_.insert_or_assign({false, known.sumo_id}, id);
    written_.erase(known.sumo_id);
    known.service = StopService::Asked;
    known.asked_at = time_;
    spdlog::debug("{:.2f} s: {} halts on {} for its stop, {}", time_, known.sumo_id, stop.lane,
                  listed ? "which SUMO has" : "which SUMO is told again");
  }
}

/// A vehicle of ours at a stop of its plan: it keeps its pose until SUMO lets it go on.
void SumoWorld::follow_service(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                               RoadState& road, std::vector<bool>& removed) {
  constexpr double kSettles = 2.0, kPatience = 10.0;  // [s]
  constexpr double kDrivesOn = 0.3;                   // [m/s]
  KnownAgent& known = known_[id.value];
  if (stop_state::stopped(seen.stop_state)) {
    if (known.service == StopService::Asked) ++life_cycle_.stops_served;
    known.service = StopService::Standing;
    if (!stop_state::parked(seen.stop_state)) return;
    backend_.allow_lane_changes(known.sumo_id, true);
    known.external = known.resumes = true;
    road.paths[id.value] = nullptr;
    scene.path[row] = kNoPath;
    scene.lane[row] = {};
    scene.control[row] = Control::Parked;
    follow(seen, id, row, scene, road, removed);
    return;
  }
  if (known.service == StopService::Asked) {
    // until SUMO counts it as there; who finds its parking place full may wait, or be sent on
    if (seen.speed < kDrivesOn && time_ < known.asked_at + kPatience) return;
    if (time_ < known.asked_at + kSettles) return;
    const auto details = details_of(known.sumo_id, false);
    const std::size_t next = static_cast<std::size_t>(scene.halt[row].next);
    const auto plan = static_cast<std::size_t>(road.path(scene.path[row])->stops[next].plan);
    if (seen.speed < kDrivesOn && details && !details->stops.empty() &&
        same_stop(details->stops.front(), known.stops[plan])) {
      known.asked_at = time_;
      return;
    }
  }
  end_service(id, row, scene, road);
}

void SumoWorld::end_service(AgentId id, std::size_t row, Scene& scene, RoadState& road) {
  KnownAgent& known = known_[id.value];
  spdlog::debug("{:.2f} s: {} goes on {}", time_, known.sumo_id,
                known.service == StopService::Standing ? "from its stop" : "without its stop");
  known.service = StopService::None;
  backend_.unwatch(known.sumo_id, false);
  backend_.allow_lane_changes(known.sumo_id, true);
  backend_.take_over(known.sumo_id, 0.0);
  external_ids_.erase({false, known.sumo_id});
  scene.halt[row].left = 0.0;
  ++scene.halt[row].next;
  auto details = details_of(known.sumo_id, false);
  if (!details) return;
  const Path& path = *road.path(scene.path[row]);
  // else SUMO has sent it elsewhere: another parking place, a new route
  if (!same_plan(known.stops, details->stops) || !same_way(path, scene.path_along[row], *details))
    follow_sumos_route(*details, id, row, scene, road);
}

}  // namespace sumogamma
