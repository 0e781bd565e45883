#pragma once

#include <cstdint>

#include "traffic/traffic_view.h"

namespace sumogamma {

/// How much of its patience somebody has lost: the one place that compares clocks of the rules with
/// seconds. Where the levels begin are parameters of their names.
enum class Patience : std::uint8_t {
  Calm,
  Waiting,    ///< it has halted
  Impatient,  ///< it looks for a way round
  Pressing,   ///< it claims a gap that is left to it, and others see that
  Stuck,      ///< it gives up a rule that only serves others
  Desperate,  ///< it forces its way where nobody has to brake hard
  Hopeless,   ///< about a cycle of a signal
};

/// Level of somebody who has been held up for so long [s].
Patience patience_after(const TrafficParameters& parameters, double seconds);

/// Of a row since it last got on: creeping is none.
Patience waited(const TrafficView& view, std::size_t row);
/// Since it last moved.
Patience stood(const TrafficView& view, std::size_t row);
/// Since bodies hold it that no rule asks it to mind.
Patience blocked(const TrafficView& view, std::size_t row);
/// Since it first stood for the room of others on a junction.
Patience kept_clear(const TrafficView& view, std::size_t row);
/// Since it came to a halt before the link that it last halted for.
Patience halted(const TrafficView& view, std::size_t row);

/// Has a row stood for a moment, so that it has come to a halt?
bool has_come_to_a_halt(const TrafficView& view, std::size_t row);
/// Has a row moved in the last so many seconds?
bool has_moved_within(const TrafficView& view, std::size_t row, double duration);
/// Has a row been blocked for longer than it bears? Drawn between Pressing and Stuck, anew for each
/// stretch of time, so that of several who are wedged one is the first.
bool is_out_of_patience(const TrafficView& view, std::size_t row);

/// From 0 to 1 while somebody waits (Daganzo's and SUMO's impatience): 1 where it is Desperate.
double impatience_after(const TrafficParameters& parameters, double seconds);

/// Counts once a tick, after everybody has moved, for how long a row has not got on, and notes when
/// it stood. On foot a step forward and back doesn't take the wait back to its beginning, a few
/// seconds of walking take a minute. dt [s].
void count_waiting(const TrafficParameters& parameters, double dt, Kinematics kinematics,
                   const Scene& scene, TrafficState& traffic, std::size_t row);

}  // namespace sumogamma
