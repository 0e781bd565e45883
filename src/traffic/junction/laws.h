#pragma once

#include <optional>

#include "traffic/junction/encounter.h"

namespace sumogamma {

/// What a foe means for the subject of an encounter.
enum class Verdict {
  Free,    ///< nothing: it has passed, is far away, or has to wait
  Held,    ///< it stands and lets the subject go first; nobody gets past it either
  Blocks,  ///< it has to be waited for
};

/// A rule that decides some encounters, and says nothing of the others.
using Law = std::optional<Verdict> (*)(const Encounter&);

/// Asks the laws in their order; the first that decides does. Where none does, the subject yields.
Verdict judge(Encounter encounter);

}  // namespace sumogamma
