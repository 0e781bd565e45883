#pragma once

#include "io/replay_stream.h"
#include "study/collisions.h"
#include "study/flow_metrics.h"
#include "study/offences/offence.h"
#include "study/safety/conflicts.h"

namespace sumogamma {

// What studies found out about a run, as marks of its replay. `over`: false where it has only just
// begun, so that depths and times aren't known yet: once they are the mark is told again.
ReplayEvent mark_of(const CollisionPair& pair, bool over);
ReplayEvent mark_of(const OffenceSpan& offence, bool over);
ReplayEvent mark_of(const Conflict& conflict);
/// At the moment `time` [s] from which on it counts as stuck. `name_of` gives SUMO's ids.
ReplayEvent mark_of(const StuckAgent& stuck, double time, const AgentName& name_of);

}  // namespace sumogamma
