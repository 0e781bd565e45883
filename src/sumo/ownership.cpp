// Whose an agent is, and how that changes. docs/coupling.md, "Whose an agent is", draws it. Whom a
// rule wants always is ours from departure on, but for what plans.cpp hands to SUMO for a while;
// here are those who change hands in motion.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "scene/extent.h"
#include "sumo/ghosts.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

namespace {
constexpr double kSlack = 10.0;   ///< outside a place before who is ours is given back [m]
constexpr double kSettles = 2.0;  ///< before SUMO may change its lane, which is a jump [s]
constexpr int kWatched = 5;       ///< steps after a hand-back that are looked at
}  // namespace

std::uint32_t SumoWorld::rules_for(const SumoAgentDetails& details, AgentTypeId type) const {
  std::uint32_t bits = 0;
  const std::string& name = type_of(model_.types, type).name;
  for (std::size_t i = 0; i < options_.control.rules.size(); ++i)
    if (concerns(options_.control.rules[i], name, details.type_id, details.id, options_.seed))
      bits |= 1u << i;
  return bits;
}

bool SumoWorld::is_always_ours(std::uint32_t rules) const {
  for (std::size_t i = 0; i < options_.control.rules.size(); ++i)
    if ((rules >> i & 1u) != 0 && !options_.control.rules[i].changes()) return true;
  return false;
}

/// Can somebody change hands in motion at all?
bool SumoWorld::changes_hands() const {
  return options_.control.changes() || options_.others_steer;
}

/// Does a rule, or another client, want an agent at a place now? `ours`: it is already; else only
/// rules count that depend on place or time.
bool SumoWorld::is_wanted(const KnownAgent& known, const Vec2& position, bool ours) const {
  if (known.sumos_own) return false;
  if (known.blocked) return true;
  if (!known.wish.empty()) return known.wish == "take";
  for (std::size_t i = 0; i < options_.control.rules.size(); ++i) {
    const ControlRule& rule = options_.control.rules[i];
    if ((known.rules >> i & 1u) != 0 && (ours || rule.changes()) &&
        holds(rule, position, centers_[i], time_, ours ? kSlack : 0.0))
      return true;
  }
  return false;
}

/// Where the agents are whom circles follow.
void SumoWorld::find_centers(const Scene& scene) {
  const std::vector<ControlRule>& rules = options_.control.rules;
  centers_.assign(rules.size(), Vec2::Constant(std::nan("")));
  for (std::size_t i = 0; i < rules.size(); ++i) {
    if (rules[i].around.empty()) continue;
    for (std::size_t row = 0; row < scene.size(); ++row)
      if (known_[scene.id[row].value].sumo_id == rules[i].around) centers_[i] = scene.position[row];
  }
}

/// Another client may set a vehicle's parameter "sumo-gamma.control" to "take" or "release" while
/// the simulation runs; "" leaves it to the rules.
void SumoWorld::read_wishes() {
  constexpr double kInterval = 0.5;  // [s]
  if (!options_.others_steer || time_ < next_wishes_) return;
  next_wishes_ = time_ + kInterval;
  std::vector<std::string> ids;
  std::vector<KnownAgent*> whose;
  for (KnownAgent& known : known_) {
    if (known.is_person || !journeys_.contains({false, known.sumo_id})) continue;
    ids.push_back(known.sumo_id);
    whose.push_back(&known);
  }
  const std::vector<std::string> wishes = backend_.parameters(ids, "sumo-gamma.control");
  for (std::size_t i = 0; i < whose.size() && i < wishes.size(); ++i)
    whose[i]->wish = wishes[i] == "take" || wishes[i] == "release" ? wishes[i] : "";
}

/// Is an agent in no conflict that the driver before has to solve?
bool SumoWorld::may_take(const Scene& scene, std::size_t row) const {
  const KnownAgent& known = known_[scene.id[row].value];
  if (touches(scene, row)) return false;
  if (known.is_person) return true;
  const bool on_lane =
      known.lane == kNoLane || model_.road.lane(known.lane).kind == LaneKind::Normal;
  return on_lane && !overtakes(scene, row) && has_room_for(scene, ghosts_, row);
}

/// Is a vehicle of ours where SUMO can go on with it as it drives: on the middle of a lane, along
/// that, with room about it?
bool SumoWorld::may_give(const Scene& scene, std::size_t row) const {
  constexpr double kOffset = 0.1, kAngle = 0.03, kBeforeEnd = 8.0;  // [m], [rad], [m]
  const KnownAgent& known = known_[scene.id[row].value];
  const LanePosition& place = scene.lane[row];
  if (place.lane == kNoLane || known.service != StopService::None) return false;
  const Lane& lane = model_.road.lane(place.lane);
  const double half = 0.5 * known.length;
  if (lane.kind != LaneKind::Normal || place.along < half ||
      place.along + half + kBeforeEnd > lane.centerline.length())
    return false;
  const PolylinePosition now = lane.centerline.project(scene.position[row]);
  const Vec2 forward = direction_of(scene.heading[row]);
  const Vec2 along = lane.centerline.direction_at(now.along);
  const Vec2 before = lane.centerline.direction_at(std::max(now.along - half, 0.0));
  const Vec2 ahead = lane.centerline.direction_at(now.along + half);
  const PathStretch& stretch = road_->path(scene.path[row])->stretch_at(scene.path_along[row]);
  return now.distance < kOffset && std::abs(cross(forward, along)) < kAngle &&
         std::abs(cross(before, ahead)) < kAngle && along.dot(forward) > 0.0 &&
         stretch.lane == place.lane && !stretch.changing && has_room_for(scene, ghosts_, row);
}

/// Gives back those whom no rule wants any more, once they may be.
void SumoWorld::hand_back(Scene& scene) {
  if (!changes_hands()) return;
  ghosts_.rebuild(scene.position);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::Gamma) continue;
    const AgentId id = scene.id[row];
    KnownAgent& known = known_[id.value];
    if (is_wanted(known, scene.position[row], true)) {
      if (std::exchange(known.leaves, false)) scene.manners[row].path_offset = known.liked_offset;
      continue;
    }
    if (known.is_person) {
      if (!std::exchange(known.was_kept, true) && ++life_cycle_.kept_on_foot == 1)
        spdlog::warn(
            "{}: people stay driven by GAMMA to the end of their walk: SUMO freezes those who are "
            "handed back",
            known.sumo_id);
      continue;
    }
    if (!std::exchange(known.leaves, true)) {
      known.liked_offset = scene.manners[row].path_offset;
      scene.manners[row].path_offset = 0.0;
    }
    if (may_give(scene, row)) give(id, scene, row);
  }
}

void SumoWorld::give(AgentId id, Scene& scene, std::size_t row) {
  KnownAgent& known = known_[id.value];
  const Vec2 forward = direction_of(scene.heading[row]);
  const Vec2 front = scene.position[row] + 0.5 * known.length * forward;
  const SumoPose pose{&known.sumo_id, front, sumo_from_heading(scene.heading[row])};
  backend_.put_on_lane(pose, model_.road.lane(scene.lane[row].lane).name, scene.speed[row]);
  backend_.release(known.sumo_id);
  backend_.watch(known.sumo_id, false);
  external_ids_.insert_or_assign({false, known.sumo_id}, id);
  written_.erase(known.sumo_id);
  known.external = true;
  known.leaves = false;
  known.lane_name.clear();
  known.lane = kNoLane;
  known.hold.keeps_lane_until = time_ + kSettles;
  known.hand_back = {0, {}, front, scene.heading[row], scene.speed[row]};
  scene.control[row] = Control::External;
  ++life_cycle_.handed_back;
  spdlog::debug("{:.2f} s: {} is SUMO's again", time_, known.sumo_id);
}

/// The step in which it was put onto its lane shows the very pose that was written.
void SumoWorld::watch_hand_back(const SumoAgent& seen, HandBackWatch& watch) {
  const double heading = heading_from_sumo(seen.angle);
  if (watch.steps > 0) {
    const Vec2 led = watch.last_front + 0.5 * (watch.last_speed + seen.speed) * options_.dt *
                                            direction_of(watch.last_heading);
    HandBack& most = watch.seen;
    most.position = std::max(most.position, (seen.position - led).norm());
    most.heading =
        std::max(most.heading, std::abs(std::remainder(heading - watch.last_heading, 2.0 * kPi)));
    const double change = std::abs(seen.speed - watch.last_speed);
    most.speed = std::max(most.speed, change);
    most.acceleration = std::max(most.acceleration, change / options_.dt);
  }
  watch.last_front = seen.position;
  watch.last_heading = heading;
  watch.last_speed = seen.speed;
  if (++watch.steps <= kWatched) return;
  watch.steps = -1;
  coupling_.hand_backs.push_back(watch.seen);
}

/// From SUMO to us, in motion: the pose stays, only who decides on the next one changes. It stays
/// ours until it arrives, but for its halts.
void SumoWorld::take_over(AgentId id, Scene& scene, std::size_t row) {
  KnownAgent& known = known_[id.value];
  backend_.unwatch(known.sumo_id, known.is_person);
  if (!known.is_person) backend_.take_over(known.sumo_id, scene.speed[row]);
  known.external = known.hold.speed = known.hold.lane = known.resumes = known.keeps_place = false;
  known.service = StopService::None;
  known.hand_back.steps = -1;
  scene.halt[row].left = 0.0;
  scene.control[row] = Control::Gamma;
  const double liked = scene.manners[row].path_offset;
  scene.manners[row] =
      draw_manners(type_of(model_.types, scene.type[row]).compliance, options_.seed, id.value);
  scene.manners[row].path_offset = liked;
  scene.steering[row] = 0.0;
  external_ids_.erase({known.is_person, known.sumo_id});
}

}  // namespace sumogamma
