#pragma once

#include "traffic/junction/arbitration.h"

namespace sumogamma {

/// Must somebody on foot wait at the kerb before the next piece of its path over a road between
/// junctions? Nobody yields to it there, so it goes where no vehicle that it sees come gets to its
/// way before it is past, or where that is gone first. Bodies that stand clear of the way are let
/// be. The spare time shrinks while it waits; in the end it goes where nobody has to brake hard.
/// Who has set out goes on: the rest is avoidance's, and the drivers'. `pace`: that it would like
/// to walk at [m/s].
LinkDecision decide_at_kerb(const TrafficView& view, const Traveller& walker, double pace);

}  // namespace sumogamma
