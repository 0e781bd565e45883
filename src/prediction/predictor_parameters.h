#pragma once

#include <span>
#include <string>
#include <string_view>

#include "inference/behavior_filter.h"
#include "prediction/companions.h"
#include "prediction/expert_weights.h"
#include "prediction/flow_memory.h"

namespace sumogamma {

/// Everything the predictor takes from data about one kind of agent (on foot, or on wheels).
struct KindParameters {
  MotionNoise noise;  ///< `observation` is the least deviation that is assumed
  double noise_scale =
      0;  ///< observations count as noisy as scale * 2 cm * (measured / 2 cm)^power
  double noise_power = 1;
  IntentionShape shape;
  FilterParameters filter;
  FlowKernel flow;
  ExpertRate experts;
  /// prior of the road's ways where a network is known: straight on; each of left and right
  double road_ahead = 1.0, road_turn = 0.3;
};

/// The one parameter set, chosen by tools/tune_prediction.py on the training recordings.
struct PredictorParameters {
  KindParameters walker, wheels;
  CompanionKernel companions;    ///< of people on foot
  double rejoin = 0.7;           ///< see RollOutOptions
  double horizon_walker = 1.0;   ///< tau of avoidance [s]
  double horizon_wheels = 1.0;   ///< likewise
  double margin = 0;             ///< kept around bodies [m]
  double separation_time = 2.0;  ///< over which bodies that overlap come apart [s]
};

PredictorParameters default_predictor_parameters();

/// A recording that parameters or coefficients were chosen on.
struct TrainingRecording {
  std::string_view name;
  std::uint64_t content;  ///< see content_of
};
std::span<const TrainingRecording> training_recordings();
/// Whether these very tracks were among them, whatever they are called now.
bool trained_on(std::uint64_t content);

/// A parameter by its name, such as "walker.flow_distance".
struct NamedParameter {
  std::string name;
  double* value;
};
/// All of them, in a fixed order.
std::vector<NamedParameter> named_parameters(PredictorParameters& parameters);

/// Sets "name=value". Throws Error on an unknown name or a value that is no finite number.
void set_parameter(PredictorParameters& parameters, std::string_view assignment);

}  // namespace sumogamma
