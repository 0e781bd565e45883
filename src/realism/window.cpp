#include "realism/window.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"

namespace sumogamma {

namespace {

constexpr int kLeadIn = 10, kEvery = 100;        // before the first window; between two [steps]
constexpr int kSeenBefore = 2, kSeenAfter = 15;  // of who is scored [steps]

ScoreWindow window_at(const RecordedScene& scene, int start) {
  ScoreWindow window;
  window.start = start;
  for (std::size_t row = 0; row < scene.agents.size(); ++row) {
    const RecordedAgent& agent = scene.agents[row];
    if (agent.first <= start - kSeenBefore && agent.last() >= start + kSeenAfter)
      window.agents.push_back(row);
    if (agent.first > start && agent.first < start + kWindowSteps) window.entering.push_back(row);
  }
  std::stable_sort(
      window.entering.begin(), window.entering.end(),
      [&](std::size_t a, std::size_t b) { return scene.agents[a].first < scene.agents[b].first; });
  window.log = Poses(window.agents.size());
  for (std::size_t row = 0; row < window.agents.size(); ++row) {
    const RecordedAgent& agent = scene.agents[window.agents[row]];
    const auto left = static_cast<std::size_t>(agent.last() - start) + 1;
    window.bodies.size.emplace_back(agent.length, agent.width);
    window.bodies.present.push_back(std::min(left, Poses::kSteps));
    for (std::size_t k = 0; k < window.bodies.present.back(); ++k) {
      const MotionState state = agent.at(start + static_cast<int>(k));
      window.log.position[row * Poses::kSteps + k] = state.position;
      window.log.heading[row * Poses::kSteps + k] = state.heading;
    }
  }
  return window;
}

}  // namespace

Windows find_windows(const RecordedScene& scene) {
  Windows found;
  for (int start = scene.first + kLeadIn; start < scene.last - kWindowSteps; start += kEvery) {
    ScoreWindow window = window_at(scene, start);
    if (window.agents.size() < 2)
      ++found.left_out;
    else
      found.windows.push_back(std::move(window));
  }
  return found;
}

Windows windows_of(const RecordedScene& scene) {
  Windows found = find_windows(scene);
  if (found.windows.empty() && found.left_out == 0)
    throw Error(scene.file, fmt::format("lasts {:.1f} s, expected 9.2 s at the least: a window is "
                                        "8 s and begins after one second",
                                        scene.duration()));
  if (found.windows.empty())
    throw Error(scene.file, fmt::format("has {} windows of 8 s and in none of them two agents for "
                                        "1.5 s at its beginning",
                                        found.left_out));
  return found;
}

}  // namespace sumogamma
