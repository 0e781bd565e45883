#include "study/safety/conflicts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/units.h"

namespace sumogamma {

namespace {

constexpr double kHorizon = kSumoThresholds.time_to_collision;
constexpr double kTurnMemory = 0.5;  // time over which a turn rate is smoothed [s]
constexpr double kMostTurn = 1.5;    // more is a jump of the heading, no turn [rad/s]

ConflictKind kind_of_angle(double angle) {
  if (angle <= radians(30.0)) return ConflictKind::RearEnd;
  return angle < radians(85.0) ? ConflictKind::LaneChange : ConflictKind::Crossing;
}

std::string names_of(const AgentTypeTable& types, const Conflict& conflict) {
  const std::string &one = type_of(types, conflict.type_a).name,
                    &other = type_of(types, conflict.type_b).name;
  return std::min(one, other) + "-" + std::max(one, other);
}

}  // namespace

const char* name_of(ConflictKind kind) {
  switch (kind) {
    case ConflictKind::RearEnd:
      return "rear_end";
    case ConflictKind::LaneChange:
      return "lane_change";
    case ConflictKind::Crossing:
      return "crossing";
  }
  return "";
}

ConflictMonitor::ConflictMonitor(double step, const RoadNetwork* road)
    : step_(step),
      every_(std::max<std::int64_t>(1, std::llround(kPeriod / step))),
      road_(road),
      has_storeys_(road && has_storeys(*road)),
      encroachments_(step) {}

void ConflictMonitor::update_bodies(const Scene& scene, const AgentTypeTable& types) {
  track_.match(scene.id);
  bodies_.resize(scene.size());
  on_foot_.resize(scene.size());
  const double share = std::min(1.0, step_ / kTurnMemory);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    State& state = track_[row];
    const double heading = scene.heading[row];
    const double rate = state.known ? wrap_angle(heading - state.heading) / step_ : 0.0;
    const bool on_foot = type_of(types, scene.type[row]).kinematics == Kinematics::Holonomic;
    if (on_foot || std::abs(rate) > kMostTurn)
      state.turn_rate = 0.0;
    else
      state.turn_rate += share * (rate - state.turn_rate);
    state.known = true;
    state.heading = heading;
    on_foot_[row] = on_foot;
    bodies_[row] = {scene.footprint[row], scene.position[row], heading, scene.velocity[row],
                    state.turn_rate};
    driven_ += step_ * scene.velocity[row].norm();
  }
}

bool ConflictMonitor::counts(const Scene& scene, std::uint32_t a, std::uint32_t b) const {
  if (on_foot_[a] && on_foot_[b]) return false;
  if (scene.control[a] == Control::Parked || scene.control[b] == Control::Parked) return false;
  return !has_storeys_ || !on_other_storey(*road_, scene, a, b);
}

void ConflictMonitor::add(const Scene& scene, const AgentTypeTable& types) {
  update_bodies(scene, types);
  if (tick_++ % every_ == 0) look_at_pairs(scene);
  add_encroachments(scene);
  end_old(scene.time);
}

void ConflictMonitor::look_at_pairs(const Scene& scene) {
  reaches_.resize(scene.size());
  for (std::uint32_t row = 0; row < scene.size(); ++row) {
    const double reach = scene.footprint[row].radius + kHorizon * scene.velocity[row].norm();
    const double x = scene.position[row].x();
    reaches_[row] = {x - reach, x + reach, row};
  }
  std::sort(reaches_.begin(), reaches_.end(), [](const Reach& a, const Reach& b) {
    return std::tie(a.left, a.row) < std::tie(b.left, b.row);
  });
  for (std::size_t i = 0; i < reaches_.size(); ++i)
    for (std::size_t j = i + 1; j < reaches_.size() && reaches_[j].left < reaches_[i].right; ++j)
      look_at(scene, std::min(reaches_[i].row, reaches_[j].row),
              std::max(reaches_[i].row, reaches_[j].row));
  // also of those who have stopped, or part again
  for (auto& [pair, conflict] : open_) {
    const std::size_t a = find_row(scene, conflict.a), b = find_row(scene, conflict.b);
    if (a < scene.size() && b < scene.size())
      conflict.gap = std::min(conflict.gap, outline_gap(bodies_[a], bodies_[b]));
  }
}

void ConflictMonitor::look_at(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const MovingBody &one = bodies_[a], &other = bodies_[b];
  const Vec2 offset = other.position - one.position;
  const Vec2 relative = one.velocity - other.velocity;
  const double distance = offset.norm(), circles = one.footprint.radius + other.footprint.radius;
  const double speeds = one.velocity.norm() + other.velocity.norm();
  if (distance - circles > kHorizon * speeds) return;
  // who moves away, straight, doesn't meet
  const bool straight = one.turn_rate == 0.0 && other.turn_rate == 0.0;
  if (straight && distance > circles && relative.dot(offset) <= 0.0) return;
  if (!counts(scene, a, b)) return;
  const double time = time_to_collision(one, other, kHorizon);
  if (!(time < kHorizon)) return;
  Conflict& conflict = encounter(scene, a, b);
  conflict.until = scene.time;
  conflict.touched = conflict.touched || time <= 0.0;
  if (time < kFhwaThresholds.time_to_collision) exposed_ += static_cast<double>(every_) * step_;
  // of two that touch the relative speed tells no deceleration that would have avoided it
  if (time > 0.0) {
    const double speed = relative.norm();
    conflict.deceleration = std::max(conflict.deceleration, deceleration_to_avoid(speed, time));
    conflict.modified_deceleration =
        std::max(conflict.modified_deceleration, modified_deceleration_to_avoid(speed, time));
  }
  if (time >= conflict.time_to_collision) return;
  conflict.time_to_collision = time;
  conflict.time = scene.time;
  conflict.place = 0.5 * (one.position + other.position);
  conflict.relative_speed = relative.norm();
  conflict.kind = kind_of_angle(std::abs(wrap_angle(one.heading - other.heading)));
}

void ConflictMonitor::add_encroachments(const Scene& scene) {
  for (const Encroachment& found : encroachments_.add(scene)) {
    const std::size_t before = find_row(scene, found.before);
    // who left the map meanwhile has left the ground, too
    if (before >= scene.size()) continue;
    const auto a = std::min(found.row, static_cast<std::uint32_t>(before));
    const auto b = std::max(found.row, static_cast<std::uint32_t>(before));
    if (!counts(scene, a, b)) continue;
    const auto running = open_.find({scene.id[a].value, scene.id[b].value});
    if (running == open_.end() && found.time >= kSumoThresholds.post_encroachment) continue;
    Conflict& conflict = encounter(scene, a, b);
    conflict.until = scene.time;
    if (found.time >= conflict.post_encroachment) continue;
    conflict.post_encroachment = found.time;
    if (std::isfinite(conflict.time_to_collision)) continue;
    conflict.time = scene.time;
    conflict.place = found.place;
    conflict.relative_speed = (scene.velocity[a] - scene.velocity[b]).norm();
    conflict.kind = kind_of_angle(found.angle);
  }
}

Conflict& ConflictMonitor::encounter(const Scene& scene, std::uint32_t a, std::uint32_t b) {
  const auto [found, first] = open_.try_emplace({scene.id[a].value, scene.id[b].value});
  Conflict& conflict = found->second;
  if (first) {
    conflict.a = scene.id[a];
    conflict.b = scene.id[b];
    conflict.type_a = scene.type[a];
    conflict.type_b = scene.type[b];
    conflict.since = scene.time;
  }
  return conflict;
}

void ConflictMonitor::end_old(double now) {
  for (auto one = open_.begin(); one != open_.end();) {
    if (now - one->second.until <= kOver) {
      ++one;
      continue;
    }
    over_.push_back(one->second);
    one = open_.erase(one);
  }
}

std::vector<Conflict> ConflictMonitor::conflicts() const {
  std::vector<Conflict> all = over_;
  for (const auto& [pair, conflict] : open_) all.push_back(conflict);
  std::sort(all.begin(), all.end(), [](const Conflict& one, const Conflict& other) {
    return std::tie(one.since, one.a, one.b) < std::tie(other.since, other.a, other.b);
  });
  return all;
}

SafetyResult ConflictMonitor::result(const AgentTypeTable& types) const {
  SafetyResult result;
  for (const ConflictKind kind :
       {ConflictKind::RearEnd, ConflictKind::LaneChange, ConflictKind::Crossing})
    result.by_kind[name_of(kind)] = 0;
  for (const Conflict& conflict : conflicts()) {
    result.conflicts_sumo += conflict.is_beyond(kSumoThresholds) ? 1 : 0;
    result.near_misses += conflict.is_near_miss() ? 1 : 0;
    result.ttc_below_1_5 += conflict.time_to_collision < 1.5 ? 1 : 0;
    result.pet_below_2 += conflict.post_encroachment < 2.0 ? 1 : 0;
    result.drac_above_3 += conflict.deceleration > 3.0 ? 1 : 0;
    result.mdrac_above_3 += conflict.modified_deceleration > 3.0 ? 1 : 0;
    if (!conflict.touched && (result.least_gap_m < 0 || conflict.gap < result.least_gap_m))
      result.least_gap_m = conflict.gap;
    if (!conflict.is_beyond(kFhwaThresholds)) continue;
    ++result.conflicts_fhwa;
    ++result.by_types[names_of(types, conflict)];
    ++result.by_kind[name_of(conflict.kind)];
  }
  result.time_exposed_s = exposed_;
  if (driven_ > 0.0)
    result.conflicts_fhwa_per_100_km = static_cast<double>(result.conflicts_fhwa) / (driven_ / 1e5);
  return result;
}

}  // namespace sumogamma
