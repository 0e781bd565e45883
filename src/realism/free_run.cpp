#include "realism/free_run.h"

#include <algorithm>
#include <utility>

#include "base/units.h"

namespace sumogamma {

namespace {

constexpr int kLongestRun = 3000;  // five minutes [steps]

/// Velocities of poses as they stand.
void find_velocities(RecordedAgent& agent) {
  const std::size_t count = agent.position.size();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = k > 0 ? k - 1 : 0, after = std::min(k + 1, count - 1);
    agent.velocity.emplace_back((agent.position[after] - agent.position[before]) /
                                (kScoreStep * static_cast<double>(after - before)));
  }
}

}  // namespace

int free_steps(const RecordedScene& scene) {
  return std::min(scene.last - scene.first, kLongestRun);
}

FreeRunNotes::FreeRunNotes(const RecordedScene& scene)
    : scene_(scene), driven_(scene.agents.size()), arrived_(scene.agents.size()) {}

void FreeRunNotes::note(std::size_t agent, int step, const Vec2& center, double heading) {
  RecordedAgent& one = driven_[agent];
  if (one.position.empty()) {
    const RecordedAgent& recorded = scene_.agents[agent];
    one.id = recorded.id;
    one.type = recorded.type;
    one.length = recorded.length;
    one.width = recorded.width;
    one.first = step;
  }
  one.position.push_back(center);
  // without jumps by a turn
  one.heading.push_back(one.heading.empty()
                            ? heading
                            : one.heading.back() + wrap_angle(heading - one.heading.back()));
}

void FreeRunNotes::note_arrival(std::size_t agent) { arrived_[agent] = true; }

FreeRun FreeRunNotes::result() && {
  FreeRun run;
  run.driven.name = scene_.name;
  run.driven.file = scene_.file;
  run.driven.types = scene_.types;
  run.driven.first = scene_.first;
  run.driven.last = scene_.first + free_steps(scene_);
  for (std::size_t agent = 0; agent < driven_.size(); ++agent) {
    if (driven_[agent].position.size() < kLeastPoints) continue;
    find_velocities(driven_[agent]);
    run.driven.agents.push_back(std::move(driven_[agent]));
    run.who.push_back(agent);
    run.arrived.push_back(arrived_[agent]);
  }
  return run;
}

FreeRun drive_freely(const RecordedScene& scene, WindowCast& cast, const FreeDriver& driver) {
  FreeRunNotes notes(scene);
  EntryCounts entries;
  const int last = scene.first + free_steps(scene);
  const auto agent_of = [&](std::size_t row) {
    return static_cast<std::size_t>(&cast.agent(row) - scene.agents.data());
  };
  std::vector<bool> gone;
  for (int step = scene.first;; ++step) {
    gone.assign(cast.scene().size(), false);
    for (std::size_t row = 0; row < gone.size(); ++row) {
      gone[row] = driver.has_come(row);
      if (gone[row]) notes.note_arrival(agent_of(row));
    }
    cast.let_go(gone);
    cast.let_enter(step, entries);
    for (std::size_t row = 0; row < cast.scene().size(); ++row)
      notes.note(agent_of(row), step, cast.scene().position[row], cast.scene().heading[row]);
    if (step == last) break;
    driver.move();
  }
  return std::move(notes).result();
}

}  // namespace sumogamma
