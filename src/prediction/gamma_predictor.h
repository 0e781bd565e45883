#pragma once

#include <unordered_map>
#include <vector>

#include "inference/behavior_filter.h"
#include "prediction/flow_memory.h"
#include "prediction/observed_scene.h"
#include "prediction/predictor_parameters.h"
#include "prediction/roll_out.h"

namespace sumogamma {

/// Parts that can be left out, each for a row of the ablation table.
struct PredictorOptions {
  bool use_kinematics = true;  ///< K, and bodies that roll and steer
  bool use_polygons = true;    ///< false: discs
  bool use_avoidance = true;   ///< G
  bool use_inference =
      true;              ///< false: everybody keeps its velocity, as the paper's ablation has it
  bool use_flow = true;  ///< what those did who were here before
  bool use_smoothing =
      true;                  ///< false: velocity and acceleration from the last displacements alone
  bool most_likely = false;  ///< the paper's choice: the single likeliest intention, not the mean
  std::size_t flow_cell_capacity = 384;  ///< see FlowMemory
};

/// The prediction of the paper with the behaviour filter of III-E: fed with a scene frame by frame,
/// it keeps a belief for everybody and predicts them jointly with the model. Nothing is known to it
/// but what was passed to `observe` before.
class GammaPredictor {
 public:
  GammaPredictor(const AgentTypeTable& types, const PredictorParameters& parameters,
                 const PredictorOptions& options, double period);

  /// Takes in the next frame: updates beliefs by what everybody did since the last one. Frames must
  /// be consecutive; after a gap beliefs start anew.
  void observe(const ObservedScene& scene);

  /// Expected motion of everybody in the last observed scene. Precondition: steps <=
  /// FlowMemory::kSteps.
  Forecast forecast(std::size_t steps);

  /// One of `count` samples from the posterior: an intention drawn from the belief and a process
  /// noise, rolled out jointly. The draws of one agent are spread evenly over the distribution (a
  /// sunflower of normal deviates), so that few of them cover it; agents are shuffled against each
  /// other.
  Forecast sample(std::size_t index, std::size_t count, std::size_t steps, std::uint64_t seed);

  /// Every intention alone, for the oracle bound: what the best of them would have predicted.
  Forecast forecast_intention(IntentionHypothesis intention, std::size_t steps);

  /// Belief of an agent in the last observed scene; null where it is unknown.
  const Belief* belief_of(std::uint32_t id) const;

 private:
  struct AgentMemory {
    Belief belief;
    Expectation expectation;
    int frame = 0;
  };
  /// What is kept by row of the present scene.
  struct Row {
    MotionEstimate motion;
    std::array<double, kIntentions> weight{};
    std::array<Vec2, FlowMemory::kSteps> mean;  ///< displacement without the flow [m]
    std::array<Vec2, FlowMemory::kSteps> flow;  ///< correction [m]
  };

  const KindParameters& kind_of(AgentTypeId type) const;
  const MotionFilter& filter_of(AgentTypeId type) const;
  void measure_noise(const ObservedScene& scene);
  void estimate_rows(const ObservedScene& scene);
  void mean_path(const ObservedAgent& agent, Row& row) const;
  void infer(const ObservedScene& scene);
  Forecast roll_out(const std::vector<Vec2>& path, std::size_t steps);

  Model model_;
  PredictorParameters parameters_;
  PredictorOptions options_;
  double period_;
  ObservationNoise noise_;
  double walker_noise_ = 0.02, wheels_noise_ = 0.02;  ///< deviations assumed now [m]
  MotionFilter walker_filter_, wheels_filter_;
  FlowMemory flow_;
  std::unordered_map<std::uint32_t, AgentMemory>
      memory_;  ///< looked up; iterated only to drop entries
  ObservedScene seen_;
  std::vector<Row> rows_;
  Scene scene_;
  Scene rolling_;
  TickGeometry geometry_;
  Workspace work_;
  Workers workers_{1};
  RollOut roll_out_;
};

}  // namespace sumogamma
