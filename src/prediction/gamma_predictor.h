#pragma once

#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "inference/behavior_filter.h"
#include "prediction/companions.h"
#include "prediction/expert_weights.h"
#include "prediction/flow_memory.h"
#include "prediction/flow_trust.h"
#include "prediction/lane_guide.h"
#include "prediction/observed_scene.h"
#include "prediction/predictor_parameters.h"
#include "prediction/road_guess.h"
#include "prediction/roll_out.h"
#include "prediction/spread_calibration.h"
#include "prediction/spread_model.h"
#include "prediction/walking_model.h"

namespace sumogamma {

/// Parts that can be left out, each for a row of the ablation table.
struct PredictorOptions {
  bool use_kinematics = true;  ///< K, and bodies that roll and steer
  bool use_polygons = true;    ///< false: discs
  bool use_avoidance = true;   ///< G
  bool use_inference =
      true;                 ///< false: everybody keeps its velocity, as the paper's ablation has it
  bool use_flow = true;     ///< what those did who were here before
  bool use_experts = true;  ///< false: the mean of the intentions alone
  bool use_walking_model = true;  ///< false: the experts without the regression
  bool use_companions = true;     ///< people who walk together keep together
  bool use_smoothing =
      true;                  ///< false: velocity and acceleration from the last displacements alone
  bool most_likely = false;  ///< the paper's choice: the single likeliest intention, not the mean
  bool use_map = true;       ///< experts that follow lanes, where a map is known
  bool use_obstacles = true;  ///< hard constraints of solid things
  bool learn_spread = true;  ///< samples spread as wide as past predictions of the recording missed
  std::size_t flow_cell_capacity = 384;  ///< see FlowMemory
};

/// How the samples of an agent are drawn.
enum class Draws : std::uint8_t {
  Independent,  ///< each by itself
  Even,  ///< a sunflower: few of them cover the distribution, which flatters the best of them
};
std::string_view name_of(Draws draws);
/// Throws Error on a name that is unknown.
Draws draws_from_name(std::string_view name);

struct SampleDraws {
  std::uint64_t seed = 1;
  Draws kind = Draws::Independent;
};

/// Who goes near somebody else at the same velocity departs as the other does: a row's draw takes
/// in another's with this weight, against 1 for its own.
struct SharedDraw {
  std::size_t row, other;
  double weight;
};
std::vector<SharedDraw> shared_draws(std::span<const Vec2> position,
                                     std::span<const Vec2> velocity);

/// Mixes standard normal deviates, `own` by row, by `shared`: standard normal again.
void mix_deviates(std::span<const SharedDraw> shared, std::span<const Vec2> own,
                  std::vector<Vec2>& mixed);

/// The prediction of the paper with the behaviour filter of III-E: fed with a scene frame by frame,
/// it keeps a belief for everybody and predicts them jointly with the model. Nothing is known to it
/// but what was passed to `observe` before. A road network, where given, must outlive it.
class GammaPredictor {
 public:
  GammaPredictor(const AgentTypeTable& types, const PredictorParameters& parameters,
                 const PredictorOptions& options, double period,
                 const std::vector<Obstacle>& obstacles = {}, const RoadNetwork* road = nullptr);

  /// From now on agents on wheels that lie on a lane of a map have experts that follow it. Its
  /// network must outlive the predictor.
  void use_map(const PredictionMap& map);

  /// As new: nothing of what was observed remains.
  void forget();

  /// Takes in the next frame: updates beliefs by what everybody did since the last one. Frames must
  /// be consecutive; after a gap beliefs start anew.
  void observe(const ObservedScene& scene);

  /// The same for a frame of a window after which `later` more come, then `forecast` or `sample`
  /// are asked, and then all is forgotten. What nobody will ask for isn't worked out; forecasts and
  /// samples have the bits that `observe` gives.
  void observe_in_window(const ObservedScene& scene, std::size_t later);

  /// Expected motion of everybody in the last observed scene. Precondition: steps <=
  /// FlowMemory::kSteps.
  Forecast forecast(std::size_t steps);

  /// One of `count` samples from the posterior: for each agent an intention drawn from the belief
  /// and a departure drawn from its spread (spread_model.h), rolled out jointly, so that bodies
  /// keep apart as in the forecast. Intentions make at most half of a spread's variance, the
  /// departure what is left of it.
  Forecast sample(std::size_t index, std::size_t count, std::size_t steps,
                  const SampleDraws& draws);

  /// Unit vector along which a row of the last scene moves, or points where it hardly moves.
  Vec2 forward_of(std::size_t row) const;

  /// Every intention alone, for the oracle bound: what the best of them would have predicted.
  Forecast forecast_intention(IntentionHypothesis intention, std::size_t steps);

  /// Weights of the experts for a row of the last observed scene.
  std::array<double, kExperts> expert_weights_of(std::size_t row) const;

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
    bool on_road = false;  ///< a vehicle on a lane of the known network
    std::array<double, kIntentions> weight{};
    using Path = std::array<Vec2, FlowMemory::kSteps>;
    std::array<Path, kIntentions> way;              ///< displacement by intention [m]
    std::array<Vec2, FlowMemory::kSteps> mean;      ///< displacement of the intentions [m]
    std::array<Vec2, FlowMemory::kSteps> learned;   ///< what the experts make of it [m]
    std::array<Vec2, FlowMemory::kSteps> together;  ///< correction by companions [m]
    std::array<Vec2, FlowMemory::kSteps> flow;      ///< correction by predecessors [m]
    double flow_share = 1;                          ///< of it that is believed
  };

  /// What a frame's work is for.
  struct Need {
    std::size_t steps = FlowMemory::kSteps;  ///< that anybody will look at
    bool forecast = true;                    ///< asked for at this frame
    bool memory = true;                      ///< frames will follow
  };
  void take_in(const ObservedScene& scene);
  const KindParameters& kind_of(AgentTypeId type) const;
  const MotionFilter& filter_of(AgentTypeId type) const;
  void measure_noise(const ObservedScene& scene);
  void estimate_rows(const ObservedScene& scene);
  void ways(const ObservedAgent& agent, Row& row) const;
  void mean_path(Row& row) const;
  /// Weighs the ways in which everybody may go on by how they did so far.
  void weigh_experts(const ObservedScene& scene);
  /// Of a row of the last scene, as ExpertWeights has kinds.
  std::size_t expert_kind_of(std::size_t row) const;
  void lane_paths(const Row& row, std::size_t r, std::array<ExpertPath, kExperts>& paths) const;
  void expert_paths(const ObservedAgent& agent, const Row& row, std::size_t r,
                    std::array<ExpertPath, kExperts>& paths) const;
  void predecessors(const ObservedAgent& agent, Row& row) const;
  void go_together(const ObservedScene& scene);
  /// Spread of every row of the last scene; once a scene.
  void spread_rows();
  /// Who shares draws in the last scene.
  void share_draws();
  /// How far a draw leads from the mean path at a step [m].
  Vec2 departure_of(std::size_t row, std::size_t step, std::size_t intention,
                    const Vec2& deviate) const;
  void remember(const ObservedScene& scene);
  /// What experts, companions and predecessors make of an intention's way [m].
  static Vec2 corrected(const Row& row, std::size_t step);
  void infer(const ObservedScene& scene);
  /// The rows as a scene, each with its likeliest behaviour. Vehicles on the carriageway keep to
  /// it: what stands beside or above it is not in their way.
  void set_scene(const ObservedScene& observed, Scene& scene) const;
  Forecast roll_out(const std::vector<Vec2>& path, std::size_t steps);

  Model model_;
  PredictorParameters parameters_;
  PredictorOptions options_;
  double period_;
  bool has_road_ = false;
  RoadGuess road_;
  std::optional<LaneGuide> guide_;
  ObservationNoise noise_;
  double walker_noise_ = 0.02, wheels_noise_ = 0.02;  ///< deviations assumed now [m]
  MotionFilter walker_filter_, wheels_filter_;
  IntentionTimes walker_times_, wheels_times_;
  FlowMemory flow_;
  FlowTrust trust_;
  SpreadCalibration calibration_;
  ExpertWeights experts_;
  std::vector<WalkingFeatures> walking_;
  std::unordered_map<std::uint32_t, AgentMemory>
      memory_;  ///< looked up; iterated only to drop entries
  Need need_;
  ObservedScene seen_;
  std::vector<Spread> spreads_;  ///< by row, empty where nobody asked yet
  std::vector<SharedDraw> shared_;
  std::vector<Vec2> deviates_;  ///< of a sample, by row
  std::array<ExpertPath, kExperts> expert_paths_{};
  std::vector<Row> rows_;
  std::vector<Companion> companions_;
  std::vector<std::array<Vec2, FlowMemory::kSteps>> joint_;
  SpatialGrid companion_grid_;
  Scene scene_;
  Scene rolling_;
  TickGeometry geometry_;
  Workspace work_;
  Nearby nearby_;
  Workers workers_{1};
  RollOut roll_out_;
};

}  // namespace sumogamma
