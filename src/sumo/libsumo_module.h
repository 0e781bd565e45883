#pragma once

#include "sumo/backend.h"

namespace sumogamma {

/// What start_libsumo_backend() finds in the module that it opens, by C's name: the back end, owned
/// by the caller.
extern "C" [[gnu::visibility("default")]] SumoBackend* sumogamma_start_libsumo(
    const SumoStart& start);

}  // namespace sumogamma
