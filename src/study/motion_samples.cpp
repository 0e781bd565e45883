#include "study/motion_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "study/safety/pair_measures.h"

namespace sumogamma {

namespace {

constexpr double kMoving = 1.0;      // [m/s]
constexpr double kFarthest = 40.0;   // of nearest distances [m]
constexpr double kLookAhead = 60.0;  // of time gaps [m]
constexpr double kHorizon = 5.0;     // of times to collision [s]
constexpr double kNone = std::numeric_limits<double>::infinity();

MovingBody body_of(const Scene& scene, std::size_t row) {
  return {scene.footprint[row], scene.position[row], scene.heading[row], scene.velocity[row], 0.0};
}

/// Half the extents of an outline in body axes.
Vec2 half_extents(const Footprint& footprint) {
  Vec2 half = Vec2::Zero();
  for (const Vec2& vertex : footprint.outline()) half = half.cwiseMax(vertex.cwiseAbs());
  return half;
}

/// The gap along the own strip to who goes the same way ahead; infinite where it isn't in it.
double gap_ahead(const Scene& scene, std::size_t row, std::size_t other) {
  if (std::abs(wrap_angle(scene.heading[row] - scene.heading[other])) > radians(30.0)) return kNone;
  const Vec2& forward = direction_of(scene.heading[row]);
  const Vec2 offset = scene.position[other] - scene.position[row];
  const Vec2 own = half_extents(scene.footprint[row]), its = half_extents(scene.footprint[other]);
  const double along = offset.dot(forward), aside = std::abs(cross(forward, offset));
  if (along <= 0.0 || aside > own.y() + its.y()) return kNone;
  return std::max(0.0, along - own.x() - its.x());
}

}  // namespace

const std::array<MotionMeasureInfo, kMotionMeasures>& motion_measures() {
  static constexpr std::array<MotionMeasureInfo, kMotionMeasures> kMeasures{{
      {MotionMeasure::Speed, "speed", "Speed", "m/s", {0, 30, 60}},
      {MotionMeasure::Acceleration, "acceleration", "Acceleration over 1 s", "m/s²", {-6, 6, 48}},
      {MotionMeasure::YawRate, "yaw_rate", "Yaw rate over 1 s", "rad/s", {-1, 1, 50}},
      {MotionMeasure::NearestDistance,
       "nearest_distance",
       "Distance to the nearest other",
       "m",
       {0, kFarthest, 80}},
      {MotionMeasure::TimeGap, "time_gap", "Time gap to who is ahead", "s", {0, 10, 50}},
      {MotionMeasure::TimeToCollision, "ttc", "Time to collision", "s", {0, kHorizon, 50}},
      {MotionMeasure::PostEncroachment,
       "pet",
       "Post-encroachment time",
       "s",
       {0, EncroachmentMonitor::kLongest, 25}},
  }};
  return kMeasures;
}

void MotionSampler::begin_group(double period) {
  end_group();
  ++groups_;
  open_ = true;
  period_ = period;
  window_ = static_cast<std::size_t>(std::max(1.0, std::round(kWindow / period)));
  encroachments_.clear();
  encroachments_.emplace_back(period);
}

void MotionSampler::count(Counts& counts, MotionMeasure measure, double value) const {
  const std::size_t index = static_cast<std::size_t>(measure);
  const Bins& bins = motion_measures()[index].bins;
  if (!std::isfinite(value)) return;
  if (counts[index].empty()) counts[index].resize(bins.count, 0.0F);
  counts[index][bins.index(value)] += 1.0F;
}

void MotionSampler::sample_motion(const Scene& scene, std::size_t row, State& state) const {
  const double speed = scene.velocity[row].norm(), heading = scene.heading[row];
  count(state.counts, MotionMeasure::Speed, speed);
  if (state.speed.size() == window_) {
    const double time = static_cast<double>(window_) * period_;
    count(state.counts, MotionMeasure::Acceleration, (speed - state.speed.front()) / time);
    if (speed > kMoving && state.speed.front() > kMoving)
      count(state.counts, MotionMeasure::YawRate,
            wrap_angle(heading - state.heading.front()) / time);
    state.speed.erase(state.speed.begin());
    state.heading.erase(state.heading.begin());
  }
  state.speed.push_back(speed);
  state.heading.push_back(heading);
}

void MotionSampler::sample_neighbours(const Scene& scene, std::size_t row, State& state) const {
  const MovingBody own = body_of(scene, row);
  const double speed = own.velocity.norm();
  double nearest = kNone, ahead = kNone, soonest = kNone;
  grid_.visit_within(own.position, kLookAhead, [&](std::uint32_t other, double squared) {
    if (other == row) return;
    const MovingBody its = body_of(scene, other);
    const double circles = own.footprint.radius + its.footprint.radius;
    // centres tell already that it isn't the nearest
    if (std::sqrt(squared) - circles < std::min(nearest, kFarthest))
      nearest = std::min(nearest, outline_gap(own, its));
    if (speed > kMoving) ahead = std::min(ahead, gap_ahead(scene, row, other));
    const Vec2 relative = own.velocity - its.velocity;
    if (relative.dot(its.position - own.position) > 0.0)
      soonest = std::min(soonest, time_to_collision(own, its, kHorizon));
  });
  if (nearest <= kFarthest) count(state.counts, MotionMeasure::NearestDistance, nearest);
  if (std::isfinite(ahead)) count(state.counts, MotionMeasure::TimeGap, ahead / speed);
  count(state.counts, MotionMeasure::TimeToCollision, soonest);
}

void MotionSampler::sample_encroachments(const Scene& scene, const AgentTypeTable& types) {
  for (const Encroachment& found : encroachments_.front().add(scene)) {
    if (!only_.empty() && !only_.contains(type_of(types, scene.type[found.row]).name)) continue;
    const auto [pair, first] =
        least_.try_emplace({scene.id[found.row].value, found.before.value}, found.time);
    pair->second = std::min(pair->second, found.time);
  }
}

void MotionSampler::add(const Scene& scene, const AgentTypeTable& types) {
  track_.match(scene.id, [&](AgentId, State& state) { leave(state); });
  grid_.rebuild(scene.position);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] == Control::Parked) continue;
    if (!only_.empty() && !only_.contains(type_of(types, scene.type[row]).name)) continue;
    State& state = track_[row];
    if (!state.known) ++sampled_;
    state.known = true;
    sample_motion(scene, row, state);
    sample_neighbours(scene, row, state);
  }
  sample_encroachments(scene, types);
}

void MotionSampler::leave(State& state) {
  for (std::size_t k = 0; k < kMotionMeasures; ++k)
    if (!state.counts[k].empty())
      agents_[k].push_back({static_cast<std::uint32_t>(groups_ - 1), std::move(state.counts[k])});
}

void MotionSampler::end_group() {
  if (!open_) return;
  open_ = false;
  track_.match({}, [&](AgentId, State& state) { leave(state); });
  std::map<std::uint32_t, Counts> of_agent;
  for (const auto& [pair, time] : least_)
    count(of_agent[pair.first], MotionMeasure::PostEncroachment, time);
  constexpr auto kPet = static_cast<std::size_t>(MotionMeasure::PostEncroachment);
  for (auto& [id, counts] : of_agent)
    agents_[kPet].push_back({static_cast<std::uint32_t>(groups_ - 1), std::move(counts[kPet])});
  least_.clear();
}

}  // namespace sumogamma
