#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prediction/evaluation.h"
#include "prediction/gamma_predictor.h"
#include "prediction/predictor_parameters.h"

namespace sumogamma {

/// What all methods of an evaluation share.
struct MethodSettings {
  PredictorParameters parameters;
  std::size_t samples = 0;  ///< 0: no distribution; else 2 or more
  std::uint64_t seed = 1;
  Draws draws = Draws::Independent;
  const PredictionMap* map = nullptr;  ///< null: none is known; else it outlives the methods
};

/// Names for a table: gamma and the baselines (online: the simple ones with flow, too), or
/// (ablations) gamma and its parts. With a map gamma without it is among them.
std::vector<std::string> default_methods(bool ablations, Memory memory, bool map = false);

/// Every name that make_method knows, for a help text.
std::string all_methods();

/// A fresh predictor for a recording (of which it is told period and solid things alone) by name:
/// one of all_methods(). Throws Error on an unknown name.
Method make_method(const std::string& name, const MethodSettings& settings, const TrackSet& set);

}  // namespace sumogamma
