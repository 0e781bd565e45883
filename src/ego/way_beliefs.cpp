#include "ego/way_beliefs.h"

#include <algorithm>
#include <cmath>

#include "scene/behavior_draw.h"

namespace sumogamma {

namespace {
constexpr std::uint64_t kStranger = 1;  // seed of what nobody knows of anybody

constexpr std::size_t kOn = 0;  // of ways on foot; the last one is to stop

/// Where the belief about somebody is, or would be.
template <typename Beliefs>
auto place_of(Beliefs& beliefs, AgentId id) {
  return std::lower_bound(beliefs.begin(), beliefs.end(), id,
                          [](const WayBelief& belief, AgentId other) { return belief.id < other; });
}

/// Did a walker take another way than on or to a halt?
bool has_turned(const WayBelief& belief) {
  const auto likeliest = static_cast<std::size_t>(
      std::max_element(belief.weights.begin(), belief.weights.end()) - belief.weights.begin());
  return likeliest != kOn && likeliest + 1 != belief.weights.size();
}

std::vector<double> uniform(std::size_t ways) {
  return std::vector<double>(ways, 1.0 / static_cast<double>(ways));
}
}  // namespace

double likelihood(const Vec2& predicted, const Vec2& seen) {
  constexpr double kTurn = 5.0 * M_PI / 180.0, kWay = 0.1, kFloor = 0.001;
  constexpr double kStill = 0.05;  // shorter ways have no direction [m]
  const double way = (seen.norm() - predicted.norm()) / kWay;
  double turn = 0;
  if (seen.norm() > kStill && predicted.norm() > kStill)
    turn = std::atan2(cross(predicted, seen), predicted.dot(seen)) / kTurn;
  return (std::exp(-0.5 * turn * turn) + kFloor) * (std::exp(-0.5 * way * way) + kFloor);
}

void advance_at_constant_speed(const RoadState& road, std::size_t ego, double dt, Scene& scene) {
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (row == ego) continue;
    const Intention& intention = scene.behavior[row].intention;
    if (intention.kind == IntentionKind::Stop) {
      scene.speed[row] = 0;
      scene.velocity[row] = Vec2::Zero();
      continue;
    }
    const Path* path = road.path(scene.path[row]);
    if (path == nullptr) {
      if (intention.kind == IntentionKind::Velocity) {
        scene.velocity[row] = intention.goal;
        scene.speed[row] = intention.goal.norm();
      }
      scene.position[row] += dt * scene.velocity[row];
      continue;
    }
    const double from = scene.path_along[row];
    const double to = from + dt * scene.speed[row];
    const Vec2 beside = left_of(path->line.direction_at(from));
    const double aside = beside.dot(scene.position[row] - path->line.point_at(from));
    const Vec2 direction = path->line.direction_at(to);
    const double beyond = std::max(to - path->line.length(), 0.0);
    scene.position[row] = path->line.point_at(to) + aside * left_of(direction) + beyond * direction;
    scene.heading[row] = heading_of(direction);
    scene.velocity[row] = scene.speed[row] * direction;
    scene.path_along[row] = to;
  }
  scene.time += dt;
}

Fork seen_fork(const EgoView& view, std::size_t& ego) {
  const Scene& scene = view.world.scene;
  std::vector<std::size_t> rows = rows_seen(view);
  rows.push_back(view.row);
  Fork fork = fork_of(view.world, std::move(rows));
  ego = find_row(fork.scene, scene.id[view.row]);
  const auto own = view.world.scene.path[view.row] == kNoPath
                       ? nullptr
                       : view.world.road.paths[static_cast<std::size_t>(scene.path[view.row])];
  fork.road.paths.assign(1, own);
  for (std::size_t row = 0; row < fork.scene.size(); ++row) {
    if (row == ego) {
      fork.scene.control[row] = Control::Planned;
      fork.scene.path[row] = own == nullptr ? kNoPath : PathId{0};
      continue;
    }
    fork.scene.path[row] = kNoPath;
    fork.scene.halt[row] = {};
    const AgentType& type = type_of(view.world.model.types, fork.scene.type[row]);
    // what is in its head isn't seen
    fork.scene.behavior[row] = draw_behavior(type, kStranger, fork.scene.id[row].value);
    fork.scene.behavior[row].intention.kind = IntentionKind::KeepVelocity;
    fork.scene.manners[row] = draw_manners(type.compliance, kStranger, fork.scene.id[row].value);
    // who is under way and doesn't speed up drives as fast as it wants to, for all that one sees
    constexpr double kUnderWay = 2.0, kSpeedsUp = 0.3;  // [m/s], [m/s^2]
    const double speed = fork.scene.speed[row];
    const double speeds_up =
        fork.scene.acceleration[row].dot(direction_of(fork.scene.heading[row]));
    const bool steady = speed > kUnderWay && speeds_up < kSpeedsUp;
    fork.scene.preferred_speed[row] = steady ? speed : std::max(speed, type.preferred_speed);
  }
  return fork;
}

std::vector<WayOn> ways_on_foot(const AgentType& type, const Vec2& velocity, double heading) {
  constexpr double kStands = 0.3;  // [m/s]
  const bool stands = velocity.norm() < kStands;
  const Vec2 on = stands ? Vec2(type.preferred_speed * direction_of(heading)) : velocity;
  const Vec2 left = left_of(on);
  std::vector<WayOn> ways;
  for (const Vec2& way : {on, left, Vec2(-left), Vec2(-on)})
    ways.push_back({nullptr, {IntentionKind::Velocity, way}});
  ways.push_back({nullptr, {IntentionKind::Stop}});
  return ways;
}

void send_along(const WayOn& way, std::size_t row, Fork& fork) {
  if (way.path == nullptr) {
    fork.scene.behavior[row].intention = way.intention;
    return;
  }
  fork.scene.path[row] = static_cast<PathId>(fork.road.paths.size());
  fork.scene.path_along[row] = way.path->line.project(fork.scene.position[row]).along;
  fork.scene.behavior[row].intention.kind = IntentionKind::Path;
  fork.road.paths.push_back(way.path);
}

const WayBelief* WayBeliefs::of(AgentId id) const {
  const auto found = place_of(beliefs_, id);
  return found == beliefs_.end() || found->id != id ? nullptr : &*found;
}

void WayBeliefs::observe(const EgoView& view, ForwardModel& forward) {
  forward.follow(view.world.model);
  if (network_ != &view.world.model.road) {
    network_ = &view.world.model.road;
    candidates_ = std::make_unique<CandidateWays>(*network_);
    beliefs_.clear();
    before_ = {};
  }
  if (before_.scene.size() > 0) weigh(view, forward);
  take_in(view);
  before_ = seen_fork(view, before_ego_);
}

/// Eq. 8 for all rows at once, a scene-step for each number of a hypothesis.
void WayBeliefs::weigh(const EgoView& view, ForwardModel& forward) {
  constexpr double kLeast = 1e-4;  // of a weight: nobody is sure for ever
  const Scene& now = view.world.scene;
  const double elapsed = now.time - before_.scene.time;
  std::size_t most = 0;
  for (const WayBelief& belief : beliefs_) most = std::max(most, belief.weights.size());
  for (std::size_t h = 0; h < most; ++h) {
    trial_ = before_;
    for (std::size_t row = 0; row < trial_.scene.size(); ++row) {
      const WayBelief* belief = row == before_ego_ ? nullptr : of(trial_.scene.id[row]);
      if (belief == nullptr || h >= belief->weights.size()) continue;
      send_along(belief->ways[h], row, trial_);
    }
    if (model_ == OthersModel::Gamma) {
      forward.advance(trial_, view.rules, [](const TrafficView& world, std::size_t row) {
        return world.scene.velocity[row];
      });
    } else {
      advance_at_constant_speed(trial_.road, before_ego_, ForwardModel::kStep, trial_.scene);
    }
    for (WayBelief& belief : beliefs_) {
      const std::size_t then = find_row(before_.scene, belief.id), row = find_row(now, belief.id);
      if (h >= belief.weights.size() || then == before_.scene.size() || row == now.size()) continue;
      const Vec2 from = before_.scene.position[then];
      const Vec2 predicted = elapsed / ForwardModel::kStep * (trial_.scene.position[then] - from);
      belief.weights[h] *= likelihood(predicted, now.position[row] - from);
    }
  }
  for (WayBelief& belief : beliefs_) {
    double sum = 0;
    for (const double weight : belief.weights) sum += weight;
    double clipped = 0;
    for (double& weight : belief.weights)
      clipped += weight = std::max(sum > 0 ? weight / sum : 1.0, kLeast);
    for (double& weight : belief.weights) weight /= clipped;
  }
}

/// Who came, left, is on another lane now, or walks.
void WayBeliefs::take_in(const EgoView& view) {
  constexpr double kForgotten = 2.0;  // [s]
  const Scene& scene = view.world.scene;
  std::vector<std::size_t> rows = rows_seen(view);
  std::sort(rows.begin(), rows.end());
  for (const std::size_t row : rows) {
    const AgentId id = scene.id[row];
    auto found = place_of(beliefs_, id);
    const bool known = found != beliefs_.end() && found->id == id;
    if (known) found->seen = scene.time;
    const AgentType& type = type_of(view.world.model.types, scene.type[row]);
    if (type.kinematics == Kinematics::Holonomic) {
      if (!known) found = beliefs_.insert(found, {id, kNoLane, {}, {}, scene.time});
      found->ways = ways_on_foot(type, scene.velocity[row], scene.heading[row]);
      if (!known || has_turned(*found)) found->weights = uniform(found->ways.size());
      continue;
    }
    const LaneId lane = scene.lane[row].lane;
    const bool on_junction = lane == kNoLane || network_->lane(lane).kind != LaneKind::Normal;
    if (known && (on_junction || lane == found->lane)) continue;
    if (!known) found = beliefs_.insert(found, WayBelief{});
    *found = {id, lane, {}, {}, scene.time};
    for (const auto& path : candidates_->ways(type, scene.type[row], lane))
      found->ways.push_back({path, {IntentionKind::Path}});
    if (found->ways.empty()) continue;  // it goes on as it does
    found->ways.push_back({nullptr, {IntentionKind::Stop}});
    found->weights = uniform(found->ways.size());
  }
  std::erase_if(beliefs_,
                [&](const WayBelief& belief) { return scene.time - belief.seen > kForgotten; });
}

}  // namespace sumogamma
