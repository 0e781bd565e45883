#include "prediction/gamma_predictor.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"

namespace sumogamma {

namespace {

// slower than this an agent has no direction of its own [m/s]
constexpr double kMoving = 0.2;
// slower than this a vehicle stands [m/s]
constexpr double kStanding = 0.5;
// frames after which a prediction is as good as it gets, and so tells how good that is
constexpr std::size_t kCalibrated = MotionFilter::kMemory;

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
                               const PredictorOptions& options, double period,
                               const std::vector<Obstacle>& obstacles, const RoadNetwork* road)
    : model_(predictor_model(types, parameters, options, period)),
      parameters_(parameters),
      options_(options),
      period_(period),
      walker_times_(parameters.walker.shape, period),
      wheels_times_(parameters.wheels.shape, period),
      flow_(options.flow_cell_capacity) {
  if (options.use_obstacles) model_.obstacles = ObstacleIndex(obstacles);
  if (road == nullptr) return;
  has_road_ = true;
  road_ = RoadGuess(*road);
  for (KindParameters* kind : {&parameters_.walker, &parameters_.wheels}) {
    std::array<double, kIntentions>& prior = kind->filter.intention_prior;
    prior[kFreeIntentions] = kind->road_ahead;
    prior[kFreeIntentions + 1] = prior[kFreeIntentions + 2] = kind->road_turn;
  }
}

void GammaPredictor::use_map(const PredictionMap& map) {
  if (options_.use_map) guide_.emplace(model_.types, map);
}

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

void GammaPredictor::forget() {
  noise_.clear();
  flow_.clear();
  trust_.clear();
  calibration_ = {};
  experts_.clear();
  memory_.clear();
  seen_ = {};
  rows_.clear();
}

void GammaPredictor::observe(const ObservedScene& scene) {
  need_ = {};
  take_in(scene);
}

void GammaPredictor::observe_in_window(const ObservedScene& scene, std::size_t later) {
  need_ = {later > 0 ? std::min(later, FlowMemory::kSteps) : FlowMemory::kSteps, later == 0,
           later > 0};
  take_in(scene);
}

void GammaPredictor::take_in(const ObservedScene& scene) {
  measure_noise(scene);
  for (const ObservedAgent& agent : scene.agents) {
    flow_.resolve(agent.id, agent.now());
    trust_.resolve(agent.id, agent.now());
    calibration_.resolve(agent.id, agent.now());
    experts_.resolve(agent.id, agent.now(), kind_of(agent.type).experts);
  }

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
  spreads_.clear();
  shared_.clear();
  // who has been seen for long is predicted whether or not it is asked for, to be held against
  for (const ObservedAgent& agent : scene.agents)
    if (need_.memory && agent.position.size() >= kCalibrated) need_ = {};
  estimate_rows(scene);
  if (!need_.memory) return;
  if (options_.use_inference) infer(scene);
  remember(scene);
}

void GammaPredictor::remember(const ObservedScene& scene) {
  if (need_.forecast && options_.learn_spread) spread_rows();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    const Row& row = rows_[r];
    if (agent.position.size() < 3) continue;
    std::array<Vec2, FlowMemory::kSteps> expected = row.mean;
    for (std::size_t k = 0; k < need_.steps; ++k) expected[k] += row.learned[k] + row.together[k];
    flow_.remember(agent.id, agent.now(), row.motion.velocity, expected);
    if (agent.position.size() < kCalibrated) continue;
    for (Vec2& point : expected) point += agent.now();
    const std::size_t kind = walks(type_of(model_.types, agent.type)) ? 0 : 1;
    if (options_.use_flow) trust_.remember(agent.id, kind, expected, row.flow);
    if (!options_.learn_spread) continue;
    for (std::size_t k = 0; k < expected.size(); ++k) expected[k] += row.flow_share * row.flow[k];
    calibration_.remember(agent.id, kind, expected, spreads_[r]);
  }
  flow_.end_frame();
  trust_.end_frame();
  calibration_.end_frame();
}

Vec2 GammaPredictor::forward_of(std::size_t row) const {
  const Vec2& velocity = rows_[row].motion.velocity;
  const double speed = velocity.norm();
  return speed > kMoving ? Vec2(velocity / speed) : direction_of(seen_.agents[row].heading.back());
}

std::vector<SharedDraw> shared_draws(std::span<const Vec2> position,
                                     std::span<const Vec2> velocity) {
  constexpr double kNear = 2.0, kAlike = 0.4;  // scales of distance [m] and velocity [m/s]
  constexpr double kReach = 3.0;
  SpatialGrid grid;
  grid.rebuild(position);
  std::vector<SharedDraw> shared;
  for (std::size_t row = 0; row < position.size(); ++row)
    grid.visit_within(position[row], kReach * kNear, [&](std::uint32_t other, double square) {
      if (other == row) return;
      const double apart = square / (kNear * kNear) +
                           (velocity[other] - velocity[row]).squaredNorm() / (kAlike * kAlike);
      if (apart < kReach * kReach) shared.push_back({row, other, std::exp(-0.5 * apart)});
    });
  return shared;
}

void mix_deviates(std::span<const SharedDraw> shared, std::span<const Vec2> own,
                  std::vector<Vec2>& mixed) {
  mixed.assign(own.begin(), own.end());
  std::vector<double> square(own.size(), 1.0);
  for (const SharedDraw& draw : shared) {
    mixed[draw.row] += draw.weight * own[draw.other];
    square[draw.row] += draw.weight * draw.weight;
  }
  for (std::size_t row = 0; row < mixed.size(); ++row) mixed[row] /= std::sqrt(square[row]);
}

void GammaPredictor::spread_rows() {
  if (spreads_.size() == rows_.size()) return;
  const std::vector<SpreadClues> clues = spread_clues(model_.types, seen_);
  spreads_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r)
    spreads_.push_back(spread_for(clues[r], forward_of(r)));
}

void GammaPredictor::ways(const ObservedAgent& agent, Row& row) const {
  const IntentionTimes& times =
      walks(type_of(model_.types, agent.type)) ? walker_times_ : wheels_times_;
  const std::size_t known = has_road_ ? kIntentions : kFreeIntentions;
  for (std::size_t k = 0; k < known; ++k)
    intended_path(static_cast<IntentionHypothesis>(k), row.motion, times,
                  std::span(row.way[k]).first(need_.steps));
  const double speed = row.motion.velocity.norm();
  row.on_road = false;
  if (!has_road_ || speed < kMoving) return;

  // as far along the road as the present acceleration leads
  const Vec2 forward = row.motion.velocity / speed;
  std::array<double, FlowMemory::kSteps> progress{};
  double most = 0;
  for (std::size_t step = 0; step < progress.size(); ++step)
    progress[step] = most = std::max(
        most, row.way[static_cast<std::size_t>(IntentionHypothesis::KeepAcceleration)][step].dot(
                  forward));
  // people look where they go, boxes go where they point
  const AgentType& type = type_of(model_.types, agent.type);
  const double heading = walks(type) ? heading_of(forward) : agent.heading.back();
  const auto lines = road_.ways(type, agent.now(), heading, most);
  if (!lines) return;
  row.on_road = !walks(type);
  for (std::size_t k = 0; k < kRoadWays; ++k)
    follow_line((*lines)[k], agent.now(), progress, row.way[kFreeIntentions + k]);
}

void GammaPredictor::mean_path(Row& row) const {
  row.mean.fill(Vec2::Zero());
  for (std::size_t k = 0; k < kIntentions; ++k) {
    if (row.weight[k] <= 0) continue;
    for (std::size_t step = 0; step < need_.steps; ++step)
      row.mean[step] += row.weight[k] * row.way[k][step];
  }
}

void GammaPredictor::estimate_rows(const ObservedScene& scene) {
  rows_.resize(scene.agents.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    Row& row = rows_[r];
    row.motion = options_.use_smoothing ? filter_of(agent.type).estimate(agent.position)
                                        : raw_estimate(agent, period_);
    const Belief& belief = memory_.at(agent.id).belief;
    row.weight = belief.intention.weights();
    if (!options_.use_inference) row.weight = {1};
    if (options_.most_likely) {
      row.weight.fill(0);
      row.weight[belief.intention.most_likely()] = 1;
    }
    ways(agent, row);
    mean_path(row);
    row.learned.fill(Vec2::Zero());
    predecessors(agent, row);
  }
  if (options_.use_experts) weigh_experts(scene);
  go_together(scene);
}

std::size_t GammaPredictor::expert_kind_of(std::size_t row) const {
  if (walks(type_of(model_.types, seen_.agents[row].type))) return kWalkerKind;
  if (!guide_ || !guide_->guides(row)) return kWheelsKind;
  return seen_.agents[row].last_velocity(period_).norm() < kStanding ? kStandingKind : kLanesKind;
}

std::array<double, kExperts> GammaPredictor::expert_weights_of(std::size_t row) const {
  const ObservedAgent& agent = seen_.agents[row];
  ExpertRate rate = kind_of(agent.type).experts;
  if (!options_.use_walking_model || std::abs(period_ - kWalkingPeriod) > 1e-6) rate.walking = 0;
  return experts_.weights(agent.id, expert_kind_of(row), rate);
}

void GammaPredictor::lane_paths(const Row& row, std::size_t r,
                                std::array<ExpertPath, kExperts>& paths) const {
  const std::span<ExpertPath, kLaneMotions> lanes(paths.data() + kFirstLaneExpert, kLaneMotions);
  if (!guide_ || !guide_->guides(r)) {
    // who isn't on a lane goes nowhere by it: as good as one that is there anyway
    std::fill(lanes.begin(), lanes.end(), paths[static_cast<std::size_t>(Expert::Kalman)]);
    return;
  }
  const auto& accelerated =
      row.way[static_cast<std::size_t>(IntentionHypothesis::KeepAcceleration)];
  const Vec2 forward = forward_of(r);
  std::array<double, FlowMemory::kSteps> progress{};
  double most = 0;
  for (std::size_t k = 0; k < progress.size(); ++k) {
    if (k < need_.steps) most = std::max(most, accelerated[k].dot(forward));
    progress[k] = most;
  }
  guide_->paths(r, progress, lanes);
}

void GammaPredictor::expert_paths(const ObservedAgent& agent, const Row& row, std::size_t r,
                                  std::array<ExpertPath, kExperts>& paths) const {
  static const FadedSteps kBrief(3), kLong(6), kFresh(8);
  auto path = [&](Expert expert) {
    return std::span(paths[static_cast<std::size_t>(expert)]).first(need_.steps);
  };
  std::copy_n(row.mean.begin(), need_.steps, path(Expert::Model).begin());
  walking_path(walking_[r], path(Expert::Walking));
  straight_path(displacement_before(agent.position, 0), path(Expert::LastDisplacement));
  straight_path(mean_displacement(agent.position, 3), path(Expert::MeanDisplacement));
  straight_path(period_ * row.motion.velocity, path(Expert::Kalman));
  accelerating_path(agent.position, path(Expert::Acceleration));
  turning_path(agent.position, 2, kBrief, path(Expert::BriefTurn));
  turning_path(agent.position, 2, kLong, path(Expert::LongTurn));
  turning_path(agent.position, 1, kFresh, path(Expert::FreshTurn));
  lane_paths(row, r, paths);
}

void GammaPredictor::weigh_experts(const ObservedScene& scene) {
  walking_features(model_.types, scene, walking_);
  if (guide_) guide_->look(scene, need_.steps);
  std::array<ExpertPath, kExperts>& paths = expert_paths_;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    Row& row = rows_[r];
    expert_paths(agent, row, r, paths);
    const std::array<double, kExperts> weight = expert_weights_of(r);
    for (std::size_t k = 0; k < need_.steps; ++k) {
      for (std::size_t e = 0; e < kExperts; ++e) row.learned[k] += weight[e] * paths[e][k];
      row.learned[k] -= row.mean[k];
    }
    if (!need_.memory) continue;
    experts_.remember(agent.id, expert_kind_of(r), agent.now(), agent.position.size(), paths);
  }
  if (need_.memory) experts_.end_frame(parameters_.walker.experts, parameters_.wheels.experts);
}

void GammaPredictor::predecessors(const ObservedAgent& agent, Row& row) const {
  row.flow.fill(Vec2::Zero());
  row.flow_share = trust_.share(walks(type_of(model_.types, agent.type)) ? 0 : 1);
  if (!options_.use_flow || !need_.forecast) return;
  row.flow = flow_.correction(agent.id, agent.now(), row.motion.velocity, kind_of(agent.type).flow);
}

void GammaPredictor::go_together(const ObservedScene& scene) {
  for (Row& row : rows_) row.together.fill(Vec2::Zero());
  if (!options_.use_companions) return;
  companions_.resize(rows_.size());
  // once for what they mean to do and once for what the place makes of it
  for (const bool flow : {false, true}) {
    if (flow && !need_.forecast) break;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const ObservedAgent& agent = scene.agents[r];
      companions_[r] = {agent.now(), rows_[r].motion.velocity,
                        walks(type_of(model_.types, agent.type)) && agent.position.size() >= 3,
                        flow ? rows_[r].flow : rows_[r].mean};
      if (flow) continue;
      for (std::size_t k = 0; k < need_.steps; ++k) companions_[r].path[k] += rows_[r].learned[k];
    }
    join_paths(companions_, parameters_.companions, companion_grid_, joint_, need_.steps);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      Row& row = rows_[r];
      if (flow) {
        row.flow = joint_[r];
        continue;
      }
      for (std::size_t k = 0; k < need_.steps; ++k)
        row.together[k] = joint_[r][k] - row.mean[k] - row.learned[k];
    }
  }
}

void GammaPredictor::infer(const ObservedScene& scene) {
  set_scene(scene, scene_);
  prepare_tick(model_, scene_, workers_, geometry_);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = scene.agents[r];
    std::array<Vec2, kIntentions> wanted;
    wanted.fill(Vec2::Zero());
    for (std::size_t k = 0; k < (has_road_ ? kIntentions : kFreeIntentions); ++k)
      wanted[k] = rows_[r].way[k].front() / period_;
    AgentMemory& memory = memory_.at(agent.id);
    memory.expectation = {};
    if (agent.position.size() >= 2)
      memory.expectation =
          expect_next({model_, scene_, geometry_, r, wanted, agent.now(), period_, nearby_},
                      memory.belief, work_);
  }
}

void GammaPredictor::set_scene(const ObservedScene& observed, Scene& scene) const {
  std::vector<Vec2> velocity;
  velocity.reserve(rows_.size());
  for (const Row& row : rows_) velocity.push_back(row.motion.velocity);
  build_scene(model_.types, observed, velocity, scene);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    scene.behavior[r] = likeliest_behavior(type_of(model_.types, scene.type[r]),
                                           memory_.at(observed.agents[r].id).belief);
    if (!rows_[r].on_road) continue;
    RoadContext& context = scene.context[r];
    context.active = true;
    context.tangent = direction_of(scene.heading[r]);
    context.speed_limit = std::numeric_limits<double>::infinity();
  }
}

Forecast GammaPredictor::roll_out(const std::vector<Vec2>& path, std::size_t steps) {
  set_scene(seen_, rolling_);
  Forecast forecast;
  roll_out_.run(model_, {.use_bodies = options_.use_kinematics, .rejoin = parameters_.rejoin},
                period_, path, steps, rolling_, forecast);
  return forecast;
}

Vec2 GammaPredictor::corrected(const Row& row, std::size_t step) {
  return row.learned[step] + row.together[step] + row.flow_share * row.flow[step];
}

Forecast GammaPredictor::forecast(std::size_t steps) {
  assert(steps <= FlowMemory::kSteps);
  std::vector<Vec2> path(rows_.size() * steps);
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (std::size_t k = 0; k < steps; ++k)
      path[r * steps + k] = seen_.agents[r].now() + rows_[r].mean[k] + corrected(rows_[r], k);
  return roll_out(path, steps);
}

Forecast GammaPredictor::forecast_intention(IntentionHypothesis intention, std::size_t steps) {
  std::vector<Vec2> path(rows_.size() * steps);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const auto& way = rows_[r].way[static_cast<std::size_t>(intention)];
    for (std::size_t k = 0; k < steps; ++k)
      path[r * steps + k] = seen_.agents[r].now() + way[k] + corrected(rows_[r], k);
  }
  return roll_out(path, steps);
}

namespace {

double radius_within(double share) { return std::sqrt(-2.0 * std::log1p(-share)); }

/// Point k of n of a sunflower: even in angle and in probability.
Vec2 even_deviate(std::size_t k, std::size_t n, double turn) {
  constexpr double kGoldenAngle = 2.399963229728653;
  return radius_within((static_cast<double>(k) + 0.5) / static_cast<double>(n)) *
         direction_of(kGoldenAngle * static_cast<double>(k) + turn);
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

/// One agent's draw for a sample.
struct AgentDraw {
  Vec2 deviate;      ///< standard normal
  double intention;  ///< uniform
};

AgentDraw draw_for(std::uint64_t agent, std::uint64_t frame, std::size_t index, std::size_t count,
                   const SampleDraws& draws) {
  constexpr std::uint64_t kMostSamples = 65536;
  const std::uint64_t at = frame * kMostSamples + index;
  const double intention = random_uniform(draws.seed, agent, at, Draw::Intention);
  if (draws.kind == Draws::Independent) {
    const double share = random_uniform(draws.seed, agent, 2 * at, Draw::ProcessNoise);
    const double turn = random_uniform(draws.seed, agent, 2 * at + 1, Draw::ProcessNoise);
    return {radius_within(share) * direction_of(2.0 * kPi * turn), intention};
  }
  // the same order for nobody: agents are shuffled against each other
  const double shift = random_uniform(draws.seed, agent, frame, Draw::ProcessNoise);
  const std::size_t k =
      (index + static_cast<std::size_t>(shift * static_cast<double>(count))) % count;
  return {even_deviate(k, count, 2.0 * kPi * shift), intention};
}

/// How an axis of a spread is shared: intentions depart from their mean by this share of what they
/// would, and noise makes that share of the spread.
struct AxisShares {
  double intention = 1, noise = 1;
};

AxisShares shares_of(double spread, double variance) {
  constexpr double kMostByIntentions = 0.5;
  const double square = spread * spread;
  if (variance <= 0 || square <= 0) return {};
  const double kept = std::min(1.0, kMostByIntentions * square / variance);
  return {std::sqrt(kept), std::sqrt(1.0 - kept * variance / square)};
}

}  // namespace

std::string_view name_of(Draws draws) {
  return draws == Draws::Independent ? "independent" : "even";
}

Draws draws_from_name(std::string_view name) {
  for (const Draws draws : {Draws::Independent, Draws::Even})
    if (name == name_of(draws)) return draws;
  throw Error("--draws", "\"" + std::string(name) + "\" is unknown, expected independent or even");
}

Vec2 GammaPredictor::departure_of(std::size_t r, std::size_t step, std::size_t intention,
                                  const Vec2& deviate) const {
  const Row& row = rows_[r];
  const Spread& spread = spreads_[r];
  const Vec2 left = left_of(spread.forward);
  Vec2 variance = Vec2::Zero(), drawn = Vec2::Zero();
  for (std::size_t k = 0; k < kIntentions; ++k) {
    if (row.weight[k] <= 0) continue;
    const Vec2 off = row.way[k][step] - row.mean[step];
    const Vec2 axes(off.dot(spread.forward), off.dot(left));
    variance += row.weight[k] * axes.cwiseProduct(axes);
    if (k == intention) drawn = axes;
  }
  const AxisShares along = shares_of(spread.along[step], variance.x());
  const AxisShares across = shares_of(spread.across[step], variance.y());
  const double radius = deviate.norm();
  const Vec2 noise =
      Vec2(along.noise * deviate.x(), across.noise * deviate.y()) / std::max(radius, 1e-12);
  return along.intention * drawn.x() * spread.forward + across.intention * drawn.y() * left +
         spread.departure(step, radius, noise);
}

Forecast GammaPredictor::sample(std::size_t index, std::size_t count, std::size_t steps,
                                const SampleDraws& draws) {
  if (shared_.empty() && draws.kind == Draws::Independent) share_draws();
  spread_rows();
  const auto frame = static_cast<std::uint64_t>(seen_.frame);
  std::vector<AgentDraw> drawn;
  std::vector<Vec2> own;
  for (const ObservedAgent& agent : seen_.agents) {
    drawn.push_back(draw_for(agent.id, frame, index, count, draws));
    own.push_back(drawn.back().deviate);
  }
  mix_deviates(shared_, own, deviates_);
  std::vector<Vec2> path(rows_.size() * steps);
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const ObservedAgent& agent = seen_.agents[r];
    const Row& row = rows_[r];
    const std::size_t intention = draw_intention(row.weight, drawn[r].intention);
    const double scale = calibration_.scale(walks(type_of(model_.types, agent.type)) ? 0 : 1);
    for (std::size_t step = 0; step < steps; ++step)
      path[r * steps + step] = agent.now() + row.mean[step] + corrected(row, step) +
                               scale * departure_of(r, step, intention, deviates_[r]);
  }
  return roll_out(path, steps);
}

void GammaPredictor::share_draws() {
  std::vector<Vec2> position, velocity;
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    position.push_back(seen_.agents[r].now());
    velocity.push_back(rows_[r].motion.velocity);
  }
  shared_ = shared_draws(position, velocity);
}

}  // namespace sumogamma
