#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "base/parallel.h"

namespace sumogamma {

inline constexpr double kAny = std::numeric_limits<double>::infinity();

/// What a figure should be; infinite where it may be anything.
struct Band {
  double low = -kAny, high = kAny;
};

/// One figure of a trial, and what is expected of it.
struct Criterion {
  std::string figure;      ///< in words
  std::string unit;        ///< SI, or vehicles an hour; empty: a number or a share
  Band band;               ///< of the mean over seeds
  std::string source;      ///< where the band comes from
  bool empirical = false;  ///< seen somewhere, no law: outside is a note and no failure
  std::string pointer;  ///< of a scenario: where its measures have it (a JSON pointer); of a list
                        ///< the largest
};

/// A case whose outcome is known: traffic engineering's and evacuation research's, each with its
/// source (docs/validation.md).
struct Trial {
  std::string id;        ///< "V1", "R4"
  std::string asks;      ///< the question, in words
  std::string setup;     ///< what is driven or walked, in words
  std::string scenario;  ///< folder of sumo_scenarios; empty: `walk`
  std::vector<Criterion> criteria;
  /// A seed's values, one a criterion; not a number where there was nothing to measure.
  std::function<std::vector<double>(std::uint64_t seed, Workers& workers)> walk;
  std::string preset = "compliant";  ///< how those behave whom `run` drives
};

/// Driven through `run` on the small scenarios.
std::vector<Trial> driving_trials();

/// People on open ground between walls, moved by the model alone: RiMEA's and others'.
std::vector<Trial> walking_trials();

}  // namespace sumogamma
