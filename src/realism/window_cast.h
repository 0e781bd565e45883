#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "realism/likelihood.h"
#include "scene/scene.h"

namespace sumogamma {

inline constexpr double kModelStep = 0.05;  ///< of GAMMA in a rollout [s]
inline constexpr int kModelStepsAPose = 2;  ///< of these from one pose to the next

/// What became of those who come during the windows.
struct EntryCounts {
  std::size_t entered = 0;   ///< a rollout each
  std::size_t delayed = 0;   ///< of them, later than recorded, since somebody was in their place
  std::size_t shut_out = 0;  ///< not at all, for that reason
  std::size_t unplaced = 0;  ///< of those scored, whom SUMO didn't insert: they keep their velocity

  void add(const EntryCounts& other);
};

/// Who is there while a rollout of a window goes on, in a scene that a model moves: those scored
/// from the beginning on, with the ids 0, 1, ... of their rows, others from when they were seen
/// first, all until they were seen last.
class WindowCast {
 public:
  /// A row of the scene for somebody who comes as `state` at a step; the body of its box, its id
  /// and its place are set already.
  using Complete =
      std::function<void(const RecordedAgent& who, const MotionState& state, AgentState& row)>;

  /// `recorded` and `window` outlive it. Those scored begin as known in the second before.
  WindowCast(const RecordedScene& recorded, const ScoreWindow& window, Complete complete);
  /// Of a free run: everybody comes when it was seen first, and goes when let_go says so.
  WindowCast(const RecordedScene& recorded, Complete complete);

  Scene& scene() { return scene_; }
  const Scene& scene() const { return scene_; }
  /// Whom a row of the scene is of.
  const RecordedAgent& agent(std::size_t row) const { return *who_[scene_.id[row].value]; }

  /// Who is seen no more leaves.
  void let_leave(int step);
  /// Rows marked true leave.
  void let_go(const std::vector<bool>& gone);
  /// Who is due comes, where nobody is in its place: of a window only as long as it is seen.
  void let_enter(int step, EntryCounts& entries);
  /// Writes down where those scored are, and whether they touch somebody who came later.
  void note(std::size_t step, Rollout& rollout) const;

 private:
  MotionState pose(std::size_t row) const;
  bool is_taken(const MotionState& state, const Vec2& size) const;
  void append(const RecordedAgent& who, const MotionState& state);

  const RecordedScene& recorded_;
  Complete complete_;
  std::size_t scored_ = 0;
  bool free_ = false;
  Scene scene_;
  std::vector<const RecordedAgent*> who_;  ///< by id
  std::vector<const RecordedAgent*> due_;  ///< who has yet to come
};

}  // namespace sumogamma
