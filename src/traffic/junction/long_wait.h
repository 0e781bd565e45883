#pragma once

#include "traffic/junction/encounter.h"

namespace sumogamma {

/// Is `one`, to whom the law gives no way, owed it after a long wait, by an other that halts for it
/// without braking hard? Forced entry, and cooperative yielding: who has had enough on foot, who
/// has stood for long on wheels where there is no light, and who holds up others on the junction.
bool is_owed_its_way(const Encounter& e, const Party& one, const Party& other);

}  // namespace sumogamma
