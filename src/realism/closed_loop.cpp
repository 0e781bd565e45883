#include "realism/closed_loop.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "scene/behavior_draw.h"
#include "simulation/open_steps.h"

namespace sumogamma {

namespace {

constexpr double kStep = 0.05;          // of the model [s]
constexpr int kStepsAPose = 2;          // of these from one pose to the next
constexpr double kStands = 0.5;         // [m/s]
constexpr double kFreeSpeed = 8.3;      // on open ground among others: 30 km/h [m/s]
constexpr double kSpeedSpread = 0.15;   // of desired speeds of one and the same agent
constexpr double kReached = 2.0;        // of a destination [m]
constexpr double kReachedWithin = 0.5;  // likewise, of who is faster [s]
constexpr double kOnward = 20.0;        // where who has reached it goes [m]
constexpr std::size_t kSteps = Poses::kSteps;

Vec2 size_of(const RecordedAgent& agent) { return {agent.length, agent.width}; }

/// One rollout while it goes on. The first ids of the scene are the scored rows.
class Drive {
 public:
  Drive(const RecordedScene& recorded, const Model& model, const ScoreWindow& window,
        std::uint64_t seed)
      : model_(model), scored_(window.agents.size()), seed_(seed) {
    for (const std::size_t who : window.agents)
      append(recorded.agents[who], recorded.agents[who].known_at(window.start));
    for (const std::size_t who : window.entering) due_.push_back(&recorded.agents[who]);
  }

  Scene& scene() { return scene_; }

  /// Who is seen no more leaves.
  void let_leave(int step) {
    std::vector<bool> gone(scene_.size());
    for (std::size_t row = 0; row < scene_.size(); ++row) gone[row] = agent(row).last() < step;
    if (std::find(gone.begin(), gone.end(), true) != gone.end()) remove_agents(scene_, gone);
  }

  /// Who is due comes, where nobody is in its place.
  void let_enter(int step, EntryCounts& entries) {
    std::erase_if(due_, [&](const RecordedAgent* who) {
      if (!who->present(step) || is_taken(who->at(who->first), size_of(*who))) return false;
      append(*who, who->at(who->first));
      ++entries.entered;
      entries.delayed += who->first < step;
      return true;
    });
  }

  /// Towards everybody's destination, and on from there.
  void set_goals() {
    for (std::size_t row = 0; row < scene_.size(); ++row) {
      const MotionState end = agent(row).at(agent(row).last());
      const double speed = end.velocity.norm();
      const std::uint32_t id = scene_.id[row].value;
      const double near = std::max(kReached, kReachedWithin * scene_.velocity[row].norm());
      if ((end.position - scene_.position[row]).norm() < near) reached_[id] = true;
      const bool onward = reached_[id] && speed > kStands;
      scene_.behavior[row].intention.goal =
          onward ? Vec2(scene_.position[row] + kOnward / speed * end.velocity) : end.position;
    }
  }

  void note(std::size_t step, Rollout& rollout) const {
    for (std::size_t row = 0; row < scene_.size(); ++row) {
      const std::size_t id = scene_.id[row].value;
      if (id >= scored_) break;
      rollout.poses.position[id * kSteps + step] = scene_.position[row];
      rollout.poses.heading[id * kSteps + step] = scene_.heading[row];
      for (std::size_t other = scene_.size(); other > 0; --other) {
        if (scene_.id[other - 1].value < scored_ || rollout.touches_entering[id]) break;
        rollout.touches_entering[id] =
            signed_distance(pose(row), size_of(agent(row)), pose(other - 1),
                            size_of(agent(other - 1))) < 0.0;
      }
    }
  }

 private:
  const RecordedAgent& agent(std::size_t row) const { return *who_[scene_.id[row].value]; }

  MotionState pose(std::size_t row) const {
    return {scene_.position[row], scene_.velocity[row], scene_.heading[row]};
  }

  bool is_taken(const MotionState& state, const Vec2& size) const {
    for (std::size_t row = 0; row < scene_.size(); ++row)
      if (signed_distance(state, size, pose(row), size_of(agent(row))) < 0.0) return true;
    return false;
  }

  void append(const RecordedAgent& who, const MotionState& state) {
    const AgentType& type = type_of(model_.types, who.type);
    const bool on_foot = type.kinematics == Kinematics::Holonomic;
    AgentState row;
    row.id = {static_cast<std::uint32_t>(who_.size())};
    row.type = who.type;
    row.footprint = box_footprint(who.length, who.width);
    row.position = state.position;
    row.heading = state.heading;
    const double speed = state.velocity.norm();
    const double ahead = direction_of(state.heading).dot(state.velocity);
    row.speed = std::min(on_foot ? speed : std::max(0.0, ahead), type.max_speed);
    row.preferred_speed = desired_speed(type, speed, seed_, who.id);
    row.behavior = draw_behavior(type, seed_, who.id);
    row.behavior.intention.kind = IntentionKind::Goal;
    append_agent(scene_, row);
    if (on_foot) scene_.velocity.back() = state.velocity;
    who_.push_back(&who);
    reached_.push_back(false);
  }

  const Model& model_;
  std::size_t scored_;
  std::uint64_t seed_;
  Scene scene_;
  std::vector<const RecordedAgent*> who_;  ///< by id
  std::vector<bool> reached_;              ///< its destination, by id
  std::vector<const RecordedAgent*> due_;  ///< who has yet to come
};

}  // namespace

void EntryCounts::add(const EntryCounts& other) {
  entered += other.entered;
  delayed += other.delayed;
  shut_out += other.shut_out;
}

double desired_speed(const AgentType& type, double speed, std::uint64_t seed, std::uint32_t id) {
  const double draw = std::clamp(random_normal(seed, id, 0, Draw::DesiredSpeed), -2.0, 2.0);
  const double share = random_uniform(seed, id, 1, Draw::DesiredSpeed);
  const double free = std::max(speed, std::min(type.preferred_speed, kFreeSpeed));
  const double usual = speed + share * share * (free - speed);
  return std::min(usual * (1.0 + kSpeedSpread * draw), type.max_speed);
}

ClosedLoop::ClosedLoop(const RecordedScene& scene, const ModelOptions& options, Workers& workers)
    : scene_(scene), workers_(workers) {
  model_.types = scene.types;
  model_.kinematics = build_kinematic_tables(scene.types, workers);
  model_.options = options;
  model_.options.step = kStep;
  model_.road.obstacles = scene.obstacles;
  model_.obstacles = ObstacleIndex(scene.obstacles);
}

Rollout ClosedLoop::drive(const ScoreWindow& window, std::uint64_t seed,
                          EntryCounts& entries) const {
  Rollout rollout{Poses(window.agents.size()), std::vector<bool>(window.agents.size(), false)};
  EntryCounts counts;
  Drive drive(scene_, model_, window, seed);
  OpenSteps steps(model_, workers_);
  for (std::size_t step = 0; step < kSteps; ++step) {
    const int now = window.start + static_cast<int>(step);
    drive.let_leave(now);
    drive.let_enter(now, counts);
    drive.note(step, rollout);
    if (step + 1 == kSteps) break;
    drive.set_goals();
    for (int k = 0; k < kStepsAPose; ++k) steps.make(drive.scene().size(), drive.scene());
  }
  counts.shut_out = window.entering.size() - counts.entered;
  entries.add(counts);
  return rollout;
}

}  // namespace sumogamma
