#pragma once

#include "traffic/junction/encounter.h"

namespace sumogamma {

/// What the other means for the first party of an encounter.
enum class Verdict {
  Free,    ///< nothing: it has passed, is far away, or has to wait
  Held,    ///< it stands and lets the first go; nobody gets past it either
  Blocks,  ///< it has to be waited for
};

/// A rule claims something for `x`, one of the two, over `y`, the other.
using Claim = bool (*)(const Encounter& e, const Party& x, const Party& y);

/// What a claim that holds means.
enum class Effect {
  YPasses,    ///< x needn't wait, as y isn't there while x is; of y nothing is said
  YStands,    ///< likewise, as y stands where it is; nobody gets past it either
  XGoesFirst  ///< x needn't wait and y has to. Nothing where both claim it.
};

struct Law {
  Claim claim;
  Effect effect;
};

/// Asks the laws in their order, each for both parties; the first that decides does. Of the two at
/// most one is ever told to wait for the other, and one is unless they don't meet: whoever asks,
/// the laws are asked for both, so that each has the answer that goes with the other's.
Verdict judge(Encounter encounter);

}  // namespace sumogamma
