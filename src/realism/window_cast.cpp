#include "realism/window_cast.h"

#include <algorithm>
#include <utility>

namespace sumogamma {

namespace {

Vec2 size_of(const RecordedAgent& agent) { return {agent.length, agent.width}; }

}  // namespace

void EntryCounts::add(const EntryCounts& other) {
  entered += other.entered;
  delayed += other.delayed;
  shut_out += other.shut_out;
  unplaced += other.unplaced;
}

WindowCast::WindowCast(const RecordedScene& recorded, const ScoreWindow& window, Complete complete)
    : recorded_(recorded), complete_(std::move(complete)), scored_(window.agents.size()) {
  for (const std::size_t who : window.agents)
    append(recorded.agents[who], recorded.agents[who].known_at(window.start));
  for (const std::size_t who : window.entering) due_.push_back(&recorded.agents[who]);
}

WindowCast::WindowCast(const RecordedScene& recorded, Complete complete)
    : recorded_(recorded), complete_(std::move(complete)), free_(true) {
  for (const RecordedAgent& agent : recorded.agents) due_.push_back(&agent);
  std::stable_sort(due_.begin(), due_.end(), [](const RecordedAgent* a, const RecordedAgent* b) {
    return a->first < b->first;
  });
}

void WindowCast::let_leave(int step) {
  std::vector<bool> gone(scene_.size());
  for (std::size_t row = 0; row < scene_.size(); ++row) gone[row] = agent(row).last() < step;
  let_go(gone);
}

void WindowCast::let_go(const std::vector<bool>& gone) {
  if (std::find(gone.begin(), gone.end(), true) != gone.end()) remove_agents(scene_, gone);
}

void WindowCast::let_enter(int step, EntryCounts& entries) {
  std::erase_if(due_, [&](const RecordedAgent* who) {
    const bool is_due = free_ ? who->first <= step : who->present(step);
    if (!is_due || is_taken(who->at(who->first), size_of(*who))) return false;
    append(*who, who->at(who->first));
    ++entries.entered;
    entries.delayed += who->first < step;
    return true;
  });
}

void WindowCast::note(std::size_t step, Rollout& rollout) const {
  for (std::size_t row = 0; row < scene_.size(); ++row) {
    const std::size_t id = scene_.id[row].value;
    if (id >= scored_) break;
    rollout.poses.position[id * Poses::kSteps + step] = scene_.position[row];
    rollout.poses.heading[id * Poses::kSteps + step] = scene_.heading[row];
    for (std::size_t other = scene_.size(); other > 0; --other) {
      if (scene_.id[other - 1].value < scored_ || rollout.touches_entering[id]) break;
      rollout.touches_entering[id] =
          signed_distance(pose(row), size_of(agent(row)), pose(other - 1),
                          size_of(agent(other - 1))) < 0.0;
    }
  }
}

MotionState WindowCast::pose(std::size_t row) const {
  return {scene_.position[row], scene_.velocity[row], scene_.heading[row]};
}

bool WindowCast::is_taken(const MotionState& state, const Vec2& size) const {
  for (std::size_t row = 0; row < scene_.size(); ++row)
    if (signed_distance(state, size, pose(row), size_of(agent(row))) < 0.0) return true;
  return false;
}

void WindowCast::append(const RecordedAgent& who, const MotionState& state) {
  const AgentType& type = type_of(recorded_.types, who.type);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  AgentState row;
  row.id = {static_cast<std::uint32_t>(who_.size())};
  row.type = who.type;
  row.footprint = box_footprint(who.length, who.width);
  row.position = state.position;
  row.heading = state.heading;
  const double ahead = direction_of(state.heading).dot(state.velocity);
  row.speed = std::min(on_foot ? state.velocity.norm() : std::max(0.0, ahead), type.max_speed);
  complete_(who, state, row);
  append_agent(scene_, row);
  if (on_foot) scene_.velocity.back() = state.velocity;
  who_.push_back(&who);
}

}  // namespace sumogamma
