#pragma once

namespace sumogamma {

/// Version of what is measured: figures of two runs may be compared where theirs are the same. A
/// change of a definition behind a key of `agents`, `collisions`, `flow`, `rules`, `smoothness`,
/// `prediction` or `coupling` in results.json raises it, with a line in docs/results.md; a new key
/// doesn't, nor does whatever changes how agents drive.
inline constexpr int kMetricsVersion = 2;

}  // namespace sumogamma
