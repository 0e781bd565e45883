#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "realism/window_cast.h"

namespace sumogamma {

/// A recording driven freely from its first step to its last, at most five minutes: everybody comes
/// when and where it was seen first, drives as a method does, and leaves where it was seen last;
/// who was still there at the recording's end goes on.
struct FreeRun {
  RecordedScene
      driven;  ///< what became of it, like a recording: ids and boxes of the agents, poses
  std::vector<std::size_t> who;  ///< agents of the recording, by driven agent
  std::vector<bool> arrived;     ///< where it was seen last, by driven agent
};

/// Steps of a free run of a recording.
int free_steps(const RecordedScene& scene);

/// What a model does in a free run.
struct FreeDriver {
  std::function<void()> move;                     ///< everybody, by kScoreStep
  std::function<bool(std::size_t row)> has_come;  ///< to where it was seen last
};

/// Drives the cast of a free run.
FreeRun drive_freely(const RecordedScene& scene, WindowCast& cast, const FreeDriver& driver);

/// Notes where an agent of the recording is at a step; steps of one agent follow each other.
class FreeRunNotes {
 public:
  explicit FreeRunNotes(const RecordedScene& scene);
  void note(std::size_t agent, int step, const Vec2& center, double heading);
  void note_arrival(std::size_t agent);
  /// Everybody who was there for kLeastPoints steps.
  FreeRun result() &&;

 private:
  const RecordedScene& scene_;
  std::vector<RecordedAgent> driven_;  ///< by agent of the recording; without poses: never there
  std::vector<bool> arrived_;
};

}  // namespace sumogamma
