#pragma once

#include "traffic/junction/encounter.h"

namespace sumogamma {

/// Is `one`, to whom the law gives no way, owed it after a long wait, by an other that halts for it
/// without braking hard? Forced entry, and cooperative yielding: who has had enough on foot, who
/// has stood for long on wheels where there is no light, a cyclist who has missed a green, and who
/// holds up others on the junction.
bool is_owed_its_way(const Encounter& e, const Party& one, const Party& other);

/// Does `one`, who has to give way, stand in the way of nobody at its line while the other has
/// stood for long and waits for a gap? That one is next.
bool starves(const Encounter& e, const Party& one, const Party& other);

}  // namespace sumogamma
