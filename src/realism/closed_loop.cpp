#include "realism/closed_loop.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "scene/behavior_draw.h"
#include "simulation/open_steps.h"

namespace sumogamma {

namespace {

constexpr double kStands = 0.5;         // [m/s]
constexpr double kFreeSpeed = 8.3;      // on open ground among others: 30 km/h [m/s]
constexpr double kSpeedSpread = 0.15;   // of desired speeds of one and the same agent
constexpr double kReached = 2.0;        // of a destination [m]
constexpr double kReachedWithin = 0.5;  // likewise, of who is faster [s]
constexpr double kOnward = 20.0;        // where who has reached it goes [m]

/// Towards everybody's destination, and on from there. `reached`: by id.
void set_goals(WindowCast& cast, std::vector<bool>& reached) {
  Scene& scene = cast.scene();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const MotionState end = cast.agent(row).at(cast.agent(row).last());
    const double speed = end.velocity.norm();
    const std::size_t id = scene.id[row].value;
    reached.resize(std::max(reached.size(), id + 1), false);
    const double near = std::max(kReached, kReachedWithin * scene.velocity[row].norm());
    if ((end.position - scene.position[row]).norm() < near) reached[id] = true;
    const bool onward = reached[id] && speed > kStands;
    scene.behavior[row].intention.goal =
        onward ? Vec2(scene.position[row] + kOnward / speed * end.velocity) : end.position;
  }
}

}  // namespace

double desired_speed(const AgentType& type, double speed, std::uint64_t seed, std::uint32_t id) {
  const double draw = std::clamp(random_normal(seed, id, 0, Draw::DesiredSpeed), -2.0, 2.0);
  const double share = random_uniform(seed, id, 1, Draw::DesiredSpeed);
  const double free = std::max(speed, std::min(type.preferred_speed, kFreeSpeed));
  const double usual = speed + share * share * (free - speed);
  return std::min(usual * (1.0 + kSpeedSpread * draw), type.max_speed);
}

ClosedLoop::ClosedLoop(const RecordedScene& scene, const ModelOptions& options,
                       const AgentTypeTable& behavior, Workers& workers)
    : scene_(scene), workers_(workers) {
  model_.types = behaving_as(scene.types, behavior);
  model_.kinematics = build_kinematic_tables(model_.types, workers);
  model_.options = options;
  model_.options.step = kModelStep;
  model_.road.obstacles = scene.obstacles;
  model_.obstacles = ObstacleIndex(scene.obstacles);
}

void ClosedLoop::complete(const RecordedAgent& who, const MotionState& state, std::uint64_t seed,
                          AgentState& row) const {
  const AgentType& type = type_of(model_.types, who.type);
  row.preferred_speed = desired_speed(type, state.velocity.norm(), seed, who.id);
  row.behavior = draw_behavior(type, seed, who.id);
  row.behavior.intention.kind = IntentionKind::Goal;
}

Rollout ClosedLoop::drive(const ScoreWindow& window, std::uint64_t seed,
                          EntryCounts& entries) const {
  Rollout rollout{Poses(window.agents.size()), std::vector<bool>(window.agents.size(), false)};
  EntryCounts counts;
  WindowCast cast(scene_, window,
                  [&](const RecordedAgent& who, const MotionState& state, AgentState& row) {
                    complete(who, state, seed, row);
                  });
  std::vector<bool> reached;
  OpenSteps steps(model_, workers_);
  for (std::size_t step = 0; step < Poses::kSteps; ++step) {
    const int now = window.start + static_cast<int>(step);
    cast.let_leave(now);
    cast.let_enter(now, counts);
    cast.note(step, rollout);
    if (step + 1 == Poses::kSteps) break;
    set_goals(cast, reached);
    for (int k = 0; k < kModelStepsAPose; ++k) steps.make(cast.scene().size(), cast.scene());
  }
  counts.shut_out = window.entering.size() - counts.entered;
  entries.add(counts);
  return rollout;
}

FreeRun ClosedLoop::drive_freely(std::uint64_t seed) const {
  WindowCast cast(scene_, [&](const RecordedAgent& who, const MotionState& state, AgentState& row) {
    complete(who, state, seed, row);
  });
  std::vector<bool> reached;
  OpenSteps steps(model_, workers_);
  const auto move = [&] {
    set_goals(cast, reached);
    for (int k = 0; k < kModelStepsAPose; ++k) steps.make(cast.scene().size(), cast.scene());
  };
  const auto has_come = [&](std::size_t row) {
    const std::size_t id = cast.scene().id[row].value;
    return cast.agent(row).last() < scene_.last && id < reached.size() && reached[id];
  };
  return sumogamma::drive_freely(scene_, cast, {move, has_come});
}

}  // namespace sumogamma
