#pragma once

#include <cstddef>
#include <vector>

#include "realism/recorded_scene.h"

namespace sumogamma {

/// Steps of a window: 8 s.
inline constexpr int kWindowSteps = 80;

/// Where some bodies are at the steps 0 to kWindowSteps of a window; row by row.
struct Poses {
  static constexpr std::size_t kSteps = kWindowSteps + 1;
  std::vector<Vec2> position;   ///< of the boxes' centres [rows x kSteps, m]
  std::vector<double> heading;  ///< [rows x kSteps, rad]

  explicit Poses(std::size_t rows = 0)
      : position(rows * kSteps, Vec2::Zero()), heading(rows * kSteps, 0.0) {}
  std::size_t rows() const { return position.size() / kSteps; }
};

/// The bodies of some poses.
struct Bodies {
  std::vector<Vec2> size;            ///< length and width by row [m]
  std::vector<std::size_t> present;  ///< steps for which each is there, from step 0 on
};

/// Eight seconds of a recording: who is there at the beginning is scored for as long as the
/// recording has it.
struct ScoreWindow {
  int start = 0;                      ///< step of the recording
  std::vector<std::size_t> agents;    ///< scored: rows of RecordedScene::agents
  std::vector<std::size_t> entering;  ///< who comes later, in order of time
  Bodies bodies;                      ///< of those scored
  Poses log;                          ///< what they did, smoothed
};

/// The windows of a recording, one every 10 s from one second after its first step on.
struct Windows {
  std::vector<ScoreWindow> windows;
  std::size_t left_out = 0;  ///< with fewer than two agents to score
};

/// Scored is who has been there for 0.2 s at the start of a window and stays for 1.5 s at least.
/// Throws Error naming the recording where there is no window.
Windows windows_of(const RecordedScene& scene);

/// The same, none where there is none.
Windows find_windows(const RecordedScene& scene);

}  // namespace sumogamma
