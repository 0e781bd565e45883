#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "prediction/gamma_predictor.h"
#include "scene/scene.h"

namespace sumogamma {

/// How predictions made in a run compare with what agents then did.
struct LiveScore {
  std::int64_t predictions = 0;  ///< scored over the full horizon
  std::int64_t left = 0;         ///< of agents that vanished before the horizon was over
  double average = 0,
         final = 0;  ///< ADE and FDE of the predictor [m]; null where nothing was scored
  double constant_velocity_average = 0,
         constant_velocity_final = 0;  ///< the same of constant velocity [m]
};

/// The parameter set for simulated traffic: that of the recordings, but nobody loses speed by
/// itself, for SUMO's and the model's agents, unlike people, never tire of their preferred speed.
PredictorParameters live_predictor_parameters();

/// The predictor inside a run: fed with the scene every tick, it predicts every agent once a period
/// and scores itself when the horizon has passed. It reads what can be seen (poses), never an
/// agent's own plans, so that it may stand for a planner's view of traffic that SUMO or the model
/// drives.
class LivePredictor {
 public:
  static constexpr std::size_t kSteps = FlowMemory::kSteps;

  /// `road`: its lanes are hypotheses, its solid things are hard; null where there is none. It must
  /// outlive the predictor.
  LivePredictor(const AgentTypeTable& types, const PredictorParameters& parameters,
                const RoadNetwork* road = nullptr, double period = 0.4);

  /// Takes in the scene of a tick; does something only when a period has passed since the last time
  /// (scene.time, which must not run backwards). `types`: the scene's own where it has variants of
  /// the rows that the predictor was made with.
  void observe(const Scene& scene, const AgentTypeTable* types = nullptr);

  /// Over all agents so far.
  LiveScore score() const { return mean_of(total_); }
  /// Over agents of one type.
  LiveScore score_of(AgentTypeId type) const;
  /// By name of type, those with a score or somebody who left.
  std::map<std::string, LiveScore> scores() const;

  /// The last forecast, row by row of `ids()`; reference points [m].
  const Forecast& forecast() const { return forecast_; }
  const std::vector<std::uint32_t>& ids() const { return ids_; }

 private:
  /// A prediction that waits for its end.
  struct Pending {
    std::array<Vec2, kSteps> predicted;
    Vec2 position, velocity;  ///< when it was made
    double sum = 0, straight_sum = 0;
    std::size_t seen = 0;
  };
  struct History {
    AgentTypeId type{};
    std::vector<Vec2> position;
    std::vector<double> heading;
    std::vector<Pending> pending;  ///< oldest first
    std::int64_t frame = -1;
  };
  struct Sums {
    std::int64_t predictions = 0, left = 0;
    double average = 0, final = 0, straight_average = 0, straight_final = 0;
  };

  static LiveScore mean_of(const Sums& sums);
  void score_pending(History& history, const Vec2& position);
  void drop_vanished();
  Sums& sums_of(AgentTypeId type) { return by_type_[static_cast<std::size_t>(type)]; }

  AgentTypeTable types_;
  double period_;
  GammaPredictor predictor_;
  std::int64_t frame_ = -1;
  double next_time_ = 0;
  std::unordered_map<std::uint32_t, History> history_;  ///< looked up by id in the scene's order
  std::vector<std::uint32_t> ids_;
  Forecast forecast_;
  Sums total_;
  std::vector<Sums> by_type_;
};

}  // namespace sumogamma
