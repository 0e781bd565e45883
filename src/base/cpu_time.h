#pragma once

namespace sumogamma {

/// CPU time of this process so far, all threads together [s].
double process_cpu_seconds();

}  // namespace sumogamma
