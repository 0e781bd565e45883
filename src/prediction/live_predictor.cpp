#include "prediction/live_predictor.h"

#include <algorithm>

namespace sumogamma {

namespace {
// frames kept of an agent: what the motion filter and the noise estimate look back
constexpr std::size_t kKept = MotionFilter::kMemory;
// frames that an agent must have been seen before its predictions count, as in protocol C
constexpr std::size_t kSeenBefore = 8;
// of the flow memory, by cell: a run covers a city and lasts
constexpr std::size_t kLiveCellCapacity = 24;

/// Where the road says how one goes on, predecessors would only tell how the signals stood for
/// them.
PredictorOptions live_options(bool has_road) {
  PredictorOptions options;
  options.use_flow = !has_road;
  options.use_experts = false;   // where a map tells how one goes on, straight lines tell less
  options.learn_spread = false;  // nobody draws samples
  options.flow_cell_capacity = kLiveCellCapacity;
  return options;
}
}  // namespace

PredictorParameters live_predictor_parameters() {
  PredictorParameters parameters = default_predictor_parameters();
  // without the regression, which sees companions itself, they weigh in full
  parameters.companions.weight = 1.0;
  parameters.walker.shape.speed_decay = parameters.wheels.shape.speed_decay = 0;
  return parameters;
}

LivePredictor::LivePredictor(const AgentTypeTable& types, const PredictorParameters& parameters,
                             const RoadNetwork* road, double period)
    : types_(types),
      period_(period),
      predictor_(types, parameters, live_options(road != nullptr), period,
                 road != nullptr ? road->obstacles : std::vector<Obstacle>{}, road),
      by_type_(types.size()) {}

LiveScore LivePredictor::mean_of(const Sums& sums) {
  LiveScore score;
  score.predictions = sums.predictions;
  score.left = sums.left;
  if (sums.predictions == 0) return score;
  const double n = static_cast<double>(sums.predictions);
  score.average = sums.average / n;
  score.final = sums.final / n;
  score.constant_velocity_average = sums.straight_average / n;
  score.constant_velocity_final = sums.straight_final / n;
  return score;
}

LiveScore LivePredictor::score_of(AgentTypeId type) const {
  return mean_of(by_type_[static_cast<std::size_t>(type)]);
}

std::map<std::string, LiveScore> LivePredictor::scores() const {
  std::map<std::string, LiveScore> scores;
  for (std::size_t k = 0; k < types_.size(); ++k)
    if (by_type_[k].predictions + by_type_[k].left > 0)
      scores[types_[k].name] = mean_of(by_type_[k]);
  return scores;
}

void LivePredictor::score_pending(History& history, const Vec2& position) {
  for (Pending& pending : history.pending) {
    const std::size_t k = pending.seen++;
    const double error = (pending.predicted[k] - position).norm();
    const Vec2 straight =
        pending.position + static_cast<double>(k + 1) * period_ * pending.velocity;
    const double straight_error = (straight - position).norm();
    pending.sum += error;
    pending.straight_sum += straight_error;
    if (pending.seen < kSteps) continue;
    for (Sums* sums : {&total_, &sums_of(history.type)}) {
      ++sums->predictions;
      sums->average += pending.sum / static_cast<double>(kSteps);
      sums->final += error;
      sums->straight_average += pending.straight_sum / static_cast<double>(kSteps);
      sums->straight_final += straight_error;
    }
  }
  std::erase_if(history.pending, [](const Pending& pending) { return pending.seen >= kSteps; });
}

void LivePredictor::drop_vanished() {
  // counts alone are taken from these, so that the order of the table doesn't matter
  std::erase_if(history_, [&](const auto& entry) {
    const History& history = entry.second;
    if (history.frame == frame_) return false;
    const auto open = static_cast<std::int64_t>(history.pending.size());
    total_.left += open;
    sums_of(history.type).left += open;
    return true;
  });
}

void LivePredictor::observe(const Scene& scene, const AgentTypeTable* types) {
  constexpr double kTolerance = 1e-6;  // [s]
  if (frame_ >= 0 && scene.time < next_time_ - kTolerance) return;
  next_time_ = (frame_ < 0 ? scene.time : next_time_) + period_;
  ++frame_;
  ObservedScene seen{static_cast<int>(frame_), period_, {}};
  ids_.clear();
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const AgentTypeId kind = kind_of(types ? *types : types_, scene.type[row]);
    const double behind = type_of(types ? *types : types_, scene.type[row]).rear_axle_to_center;
    const Vec2 position = scene.position[row] - behind * direction_of(scene.heading[row]);
    History& history = history_[scene.id[row].value];
    history.type = kind;
    history.frame = frame_;
    score_pending(history, position);
    if (history.position.size() == kKept) {
      std::shift_left(history.position.begin(), history.position.end(), 1);
      std::shift_left(history.heading.begin(), history.heading.end(), 1);
      history.position.back() = position;
      history.heading.back() = scene.heading[row];
    } else {
      history.position.push_back(position);
      history.heading.push_back(scene.heading[row]);
    }
    seen.agents.push_back({scene.id[row].value, kind, history.position, history.heading});
    ids_.push_back(scene.id[row].value);
  }
  drop_vanished();
  predictor_.observe(seen);
  forecast_ = predictor_.forecast(kSteps);
  for (std::size_t row = 0; row < seen.agents.size(); ++row) {
    const ObservedAgent& agent = seen.agents[row];
    if (agent.position.size() < kSeenBefore) continue;
    Pending pending;
    std::copy_n(forecast_.row(row).begin(), kSteps, pending.predicted.begin());
    pending.position = agent.now();
    pending.velocity = agent.last_velocity(period_);
    history_[agent.id].pending.push_back(pending);
  }
}

}  // namespace sumogamma
