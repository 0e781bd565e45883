#pragma once

#include <cstdint>

#include "geometry/vec2.h"
#include "study/histogram.h"

namespace sumogamma {

/// The measured keys of `coupling` in results.json.
struct CouplingResult {
  double position_error_max_m = 0;  ///< [m]
  double position_error_p99_m = 0;  ///< [m]
  std::uint64_t lane_mismatches = 0;
  std::uint64_t compared = 0;  ///< pairs of poses that the errors rest on
};

/// What SUMO reports after a step against what was written before it.
class CouplingMonitor {
 public:
  void add(const Vec2& written, const Vec2& reported) { errors_.add((written - reported).norm()); }
  /// SUMO put the agent on another lane than the locator did.
  void add_lane_mismatch() { ++lane_mismatches_; }

  CouplingResult result() const {
    return {errors_.maximum(), errors_.quantile(0.99), lane_mismatches_, errors_.total()};
  }

 private:
  Histogram errors_{0.0005, 20001};
  std::uint64_t lane_mismatches_ = 0;
};

}  // namespace sumogamma
