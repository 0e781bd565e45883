#pragma once

#include <span>
#include <vector>

#include "model/model.h"
#include "scene/extent.h"
#include "scene/road_state.h"
#include "traffic/traffic_state.h"

namespace sumogamma {

/// Somebody on the way to, or on, a junction link.
struct Approach {
  ConnectionId connection = kNoConnection;
  std::uint32_t row = 0;
  double front = 0;   ///< of the agent's front past the link's begin [m]; negative before it
  double length = 0;  ///< of the agent along its path [m]
  double speed = 0;   ///< along its path, >= 0 [m/s]
  bool stands = false;
  bool wide = false;        ///< see is_wide
  bool has_halted = false;  ///< before this link, or one whose halt counts for it
  std::uint32_t link = 0;   ///< index of the link on the agent's path
};

/// What held an agent at the last tick.
struct Waiting {
  LimitReason reason = LimitReason::None;
  std::int64_t foe = -1;
  ConnectionId halted_for = kNoConnection;  ///< link before which it came to a halt
  double halted_at = 0;                     ///< when it did [s]
  double to_halt = 0;     ///< way of the front to where it comes to rest before a link, as things
                          ///< are; infinite where it doesn't [m]
  bool blocked = false;   ///< no rule holds it, and yet it has stood for seconds: bodies do
  bool holds_up = false;  ///< somebody to whom others give way has stood for it for some time
};

struct TrafficView;

/// Who approaches which link, and who waits for whom, from the frozen scene.
class ApproachTable {
 public:
  /// Registers every agent with a path for the links within its stopping distance and some seconds.
  /// Serial, O(n log n).
  void rebuild(const TrafficView& view);
  /// Foremost first.
  std::span<const Approach> of(ConnectionId id) const;
  /// Frozen copy of what the contexts said at the last tick: rows may read each other's.
  const Waiting& waiting(std::size_t row) const { return waiting_[row]; }
  /// Where a front comes to rest, as things are [m past its link's begin].
  double rest_of(const Approach& one) const { return one.front + waiting(one.row).to_halt; }

 private:
  void note_waiting(const TrafficView& view);

  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  std::vector<Approach> approaches_;  ///< sorted by connection, foremost first
  std::vector<Range> ranges_;         ///< by connection
  std::vector<Waiting> waiting_;      ///< by row
};

/// The last link that a halt of a body `length` [m] long before `link` counts for: at a stop sign
/// so close behind that a body which waits there would stand on `link` one halts before both, and
/// once.
ConnectionId halt_counts_for(const RoadNetwork& road, const Path& path, const PathLink& link,
                             double length);

}  // namespace sumogamma
