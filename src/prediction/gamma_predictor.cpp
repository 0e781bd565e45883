#include "prediction/gamma_predictor.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/random.h"
#include "base/units.h"

namespace sumogamma {

namespace {

// slower than this an agent has no direction of its own [m/s]
constexpr double kMoving = 0.2;

bool walks(const AgentType& type) { return type.kinematics == Kinematics::Holonomic; }

Model predictor_model(const AgentTypeTable& types, const PredictorParameters& parameters,
                      const PredictorOptions& options, double period) {
  Model model;
  model.types = types;
  for (AgentType& type : model.types) {
    type.horizon = walks(type) ? parameters.horizon_walker : parameters.horizon_wheels;
    // beliefs come without a steering history: wheels may be where the bend asks for them
    type.max_steering_rate = radians(360);
  }
  Workers workers(1);
  model.kinematics = build_kinematic_tables(model.types, workers);
  model.options.use_kinematics = options.use_kinematics;
  model.options.use_polygons = options.use_polygons;
  model.options.use_avoidance = options.use_avoidance;
  // a step of 0.4 s is long: pairs that are safe now must stay so, or they meet within the step
  model.options.constrain_safe_pairs = true;
  model.options.pass_as_intended = false;
  model.options.use_guard = false;
  model.options.look_aside = false;
  model.options.creep_when_held = false;
  model.options.front_margin = model.options.rear_margin = model.options.side_margin =
      parameters.margin;
  model.options.walker_margin = parameters.margin;
  model.options.separation_time = model.options.margin_time = model.options.walker_separation_time =
      parameters.separation_time;
  model.options.step = period;
  return model;
}

double assumed_noise(const KindParameters& kind, double measured) {
  constexpr double kUnit = 0.02, kMost = 1.0;  // [m]
  const double scaled = kind.noise_scale * kUnit * std::pow(measured / kUnit, kind.noise_power);
  return std::min(std::max(kind.noise.observation, scaled), kMost);
}

MotionFilter filter_for(const KindParameters& kind, double noise, double period) {
  MotionNoise assumed = kind.noise;
  assumed.observation = noise;
  return MotionFilter(assumed, period);
}

/// Velocity and acceleration as the last displacements have them.
MotionEstimate raw_estimate(const ObservedAgent& agent, double period) {
  MotionEstimate estimate;
  estimate.velocity = agent.last_velocity(period);
  const std::size_t n = agent.position.size();
  if (n >= 3)
    estimate.acceleration =
        (estimate.velocity - (agent.position[n - 2] - agent.position[n - 3]) / period) / period;
  return estimate;
}

}  // namespace

GammaPredictor::GammaPredictor(const AgentTypeTable& types, const PredictorParameters& parameters,
                               const PredictorOptions& options, double period)
    : model_(predictor_model(types, parameters, options, period)),
      parameters_(parameters),
      options_(options),
      period_(period),
      flow_(options.flow_cell_capacity) {}

const KindParameters& GammaPredictor::kind_of(AgentTypeId type) const {
  return walks(type_of(model_.types, type)) ? parameters_.walker : parameters_.wheels;
}

const MotionFilter& GammaPredictor::filter_of(AgentTypeId type) const {
  return walks(type_of(model_.types, type)) ? walker_filter_ : wheels_filter_;
}

const Belief* GammaPredictor::belief_of(std::uint32_t id) const {
  const auto found = memory_.find(id);
  return found == memory_.end() ? nullptr : &found->second.belief;
}

void GammaPredictor::measure_noise(const ObservedScene& scene) {
  for (const ObservedAgent& agent : scene.agents) noise_.add(agent.position);
  noise_.update();
  walker_noise_ = assumed_noise(parameters_.walker, noise_.deviation());
  wheels_noise_ = assumed_noise(parameters_.wheels, noise_.deviation());
  walker_filter_ = filter_for(parameters_.walker, walker_noise_, period_);
  wheels_filter_ = filter_for(parameters_.wheels, wheels_noise_, period_);
}

void GammaPredictor::observe(const ObservedScene& scene) {
  measure_noise(scene);
  for (const ObservedAgent& agent : scene.agents) flow_.resolve(agent.id, agent.now());

  // Eqs. 9 and 10: weigh what was expected of this frame
  for (const ObservedAgent& agent : scene.agents) {
    const KindParameters& kind = kind_of(agent.type);
    auto [found, fresh] = memory_.try_emplace(agent.id);
    AgentMemory& memory = found->second;
    if (fresh || memory.frame + 1 != scene.frame) {
      memory.belief = initial_belief(kind.filter);
      memory.expectation = {};
    }
    const double noise = walks(type_of(model_.types, agent.type)) ? walker_noise_ : wheels_noise_;
    update_belief(kind.filter, memory.expectation, agent.now(), noise, memory.belief);
    memory.frame = scene.frame;
  }
  std::erase_if(memory_, [&](const auto& entry) { return entry.second.frame != scene.frame; });

  seen_ = scene;
  estimate_rows(scene);
  if (options_.use_inference) infer(scene);
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    const ObservedAgent& agent = scene.agents[row];
    if (agent.position.size() >= 3)
      flow_.remember(agent.id, agent.now(), rows_[row].motion.velocity, rows_[row].mean);
  }
  flow_.end_frame();
}

void GammaPredictor::mean_path(const ObservedAgent& agent, Row& row) const {
  const KindParameters& kind = kind_of(agent.type);
  std::array<Vec2, FlowMemory::kSteps> path;
  row.mean.fill(Vec2::Zero());
  for (std::size_t k = 0; k < kIntentions; ++k) {
    if (row.weight[k] <= 0) continue;
    intended_path(static_cast<IntentionHypothesis>(k), row.motion, kind.shape, period_, path);
    for (std::size_t step = 0; step < path.size(); ++step)
      row.mean[step] += row.weight[k] * path[step];
  }
}

void GammaPredictor::estimate_rows(const ObservedScene& scene) {
  rows_.resize(scene.agents.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    const KindParameters& kind = kind_of(agent.type);
    Row& row = rows_[r];
    row.motion = options_.use_smoothing ? filter_of(agent.type).estimate(agent.position)
                                        : raw_estimate(agent, period_);
    const Belief& belief = memory_.at(agent.id).belief;
    row.weight = belief.intention.weights();
    if (!options_.use_inference) row.weight = {1, 0, 0, 0};
    if (options_.most_likely) {
      row.weight.fill(0);
      row.weight[belief.intention.most_likely()] = 1;
    }
    mean_path(agent, row);
    row.flow.fill(Vec2::Zero());
    if (options_.use_flow)
      row.flow = flow_.correction(agent.id, agent.now(), row.motion.velocity, kind.flow);
    if (kind.sideways != 1.0 && row.motion.velocity.norm() > kMoving) {
      const Vec2 left = left_of(row.motion.velocity.normalized());
      for (Vec2& correction : row.flow)
        correction -= (1.0 - kind.sideways) * left.dot(correction) * left;
    }
  }
}

void GammaPredictor::infer(const ObservedScene& scene) {
  std::vector<Vec2> velocity;
  for (const Row& row : rows_) velocity.push_back(row.motion.velocity);
  build_scene(model_.types, scene, velocity, scene_);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    scene_.behavior[r] = likeliest_behavior(type_of(model_.types, scene_.type[r]),
                                            memory_.at(scene.agents[r].id).belief);
  prepare_tick(model_, scene_, workers_, geometry_);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    const KindParameters& kind = kind_of(agent.type);
    std::array<Vec2, kIntentions> wanted;
    for (std::size_t k = 0; k < kIntentions; ++k) {
      Vec2 step = Vec2::Zero();
      intended_path(static_cast<IntentionHypothesis>(k), rows_[r].motion, kind.shape, period_,
                    {&step, 1});
      wanted[k] = step / period_;
    }
    AgentMemory& memory = memory_.at(agent.id);
    memory.expectation = {};
    if (agent.position.size() >= 2)
      memory.expectation = expect_next(model_, scene_, geometry_, r, memory.belief, wanted,
                                       agent.now(), period_, work_);
  }
}

Forecast GammaPredictor::roll_out(const std::vector<Vec2>& path, std::size_t steps) {
  std::vector<Vec2> velocity;
  for (const Row& row : rows_) velocity.push_back(row.motion.velocity);
  build_scene(model_.types, seen_, velocity, rolling_);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    rolling_.behavior[r] = likeliest_behavior(type_of(model_.types, rolling_.type[r]),
                                              memory_.at(seen_.agents[r].id).belief);
  Forecast forecast;
  roll_out_.run(model_, {.use_bodies = options_.use_kinematics, .rejoin = parameters_.rejoin},
                period_, path, steps, rolling_, forecast);
  return forecast;
}

Forecast GammaPredictor::forecast(std::size_t steps) {
  assert(steps <= FlowMemory::kSteps);
  std::vector<Vec2> path(rows_.size() * steps);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (std::size_t k = 0; k < steps; ++k)
      path[r * steps + k] = seen_.agents[r].now() + rows_[r].mean[k] + rows_[r].flow[k];
  return roll_out(path, steps);
}

Forecast GammaPredictor::forecast_intention(IntentionHypothesis intention, std::size_t steps) {
  std::vector<Vec2> path(rows_.size() * steps);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    std::array<Vec2, FlowMemory::kSteps> way;
    intended_path(intention, rows_[r].motion, kind_of(seen_.agents[r].type).shape, period_, way);
    for (std::size_t k = 0; k < steps; ++k)
      path[r * steps + k] = seen_.agents[r].now() + way[k] + rows_[r].flow[k];
  }
  return roll_out(path, steps);
}

namespace {

/// Point k of n of a sunflower turned into two normal deviates: even in angle and in probability.
Vec2 even_normal(std::size_t k, std::size_t n, double turn) {
  constexpr double kGoldenAngle = 2.399963229728653;
  const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
  const double radius = std::sqrt(-2.0 * std::log1p(-share));
  return radius * direction_of(kGoldenAngle * static_cast<double>(k) + turn);
}

/// Intention whose cumulated weight reaches u.
std::size_t draw_intention(const std::array<double, kIntentions>& weight, double u) {
  double sum = 0;
  for (std::size_t k = 0; k + 1 < kIntentions; ++k) {
    sum += weight[k];
    if (u < sum) return k;
  }
  for (std::size_t k = kIntentions; k-- > 0;)
    if (weight[k] > 0) return k;
  return 0;
}

}  // namespace

Forecast GammaPredictor::sample(std::size_t index, std::size_t count, std::size_t steps,
                                std::uint64_t seed) {
  std::vector<Vec2> path(rows_.size() * steps);
  const auto frame = static_cast<std::uint64_t>(seen_.frame);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = seen_.agents[r];
    const KindParameters& kind = kind_of(agent.type);
    const Row& row = rows_[r];
    // the same order for nobody: agents' draws are independent
    const double shift = random_uniform(seed, agent.id, frame, Draw::ProcessNoise);
    const std::size_t k =
        (index + static_cast<std::size_t>(shift * static_cast<double>(count))) % count;
    const Vec2 normal = even_normal(k, count, 2.0 * kPi * shift);
    const double u = random_uniform(seed, agent.id, frame * 4096 + index, Draw::Intention);
    std::array<Vec2, FlowMemory::kSteps> way;
    intended_path(static_cast<IntentionHypothesis>(draw_intention(row.weight, u)), row.motion,
                  kind.shape, period_, way);
    const double speed = row.motion.velocity.norm();
    const Vec2 forward =
        speed > kMoving ? Vec2(row.motion.velocity / speed) : direction_of(agent.heading.back());
    const Vec2 noise =
        normal.x() * (kind.along_fixed + kind.along_by_speed * speed) * forward +
        normal.y() * (kind.across_fixed + kind.across_by_speed * speed) * left_of(forward);
    for (std::size_t step = 0; step < steps; ++step) {
      const double time = static_cast<double>(step + 1) * period_;
      path[r * steps + step] =
          agent.now() + way[step] + row.flow[step] + std::pow(time, kind.growth) * noise;
    }
  }
  return roll_out(path, steps);
}

}  // namespace sumogamma
