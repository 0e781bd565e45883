#include "prediction/methods.h"

#include <algorithm>
#include <array>
#include <memory>

#include "base/error.h"
#include "base/units.h"
#include "prediction/baselines.h"
#include "prediction/flow_memory.h"

namespace sumogamma {

namespace {

/// A row of the ablation table.
struct Variant {
  const char *name, *title;
  void (*change)(PredictorOptions&);
};
constexpr Variant kVariants[] = {
    {"gamma", "sumo-gamma", [](PredictorOptions&) {}},
    {kWithoutMap, "  without the map", [](PredictorOptions& o) { o.use_map = false; }},
    {"gamma-no-kinematics", "  without K and bodies",
     [](PredictorOptions& o) { o.use_kinematics = false; }},
    {"gamma-no-polygons", "  without polygons (discs)",
     [](PredictorOptions& o) { o.use_polygons = false; }},
    {"gamma-no-inference", "  without inference (keeps velocity)",
     [](PredictorOptions& o) { o.use_inference = false; }},
    {"gamma-no-avoidance", "  without avoidance",
     [](PredictorOptions& o) { o.use_avoidance = false; }},
    {"gamma-no-flow", "  without the flow of predecessors",
     [](PredictorOptions& o) { o.use_flow = false; }},
    {"gamma-no-experts", "  without experts (intentions alone)",
     [](PredictorOptions& o) { o.use_experts = false; }},
    {"gamma-no-regression", "  without the regression of walkers",
     [](PredictorOptions& o) { o.use_walking_model = false; }},
    {"gamma-no-companions", "  without companions",
     [](PredictorOptions& o) { o.use_companions = false; }},
    {"gamma-no-obstacles", "  without solid things",
     [](PredictorOptions& o) { o.use_obstacles = false; }},
    {"gamma-no-smoothing", "  without the motion filter",
     [](PredictorOptions& o) { o.use_smoothing = false; }},
    {"gamma-most-likely", "  likeliest intention instead of the mean",
     [](PredictorOptions& o) { o.most_likely = true; }},
};

/// A baseline that learns by the same means as the predictor does: the flow of those who were at
/// the same place before.
struct FlowedBaseline {
  const Baseline& baseline;
  PredictorParameters parameters;
  AgentTypeTable types = recorded_agent_types();
  FlowMemory flow{};

  void observe(const ObservedScene& scene) {
    for (const ObservedAgent& agent : scene.agents) flow.resolve(agent.id, agent.now());
    const Forecast forecast = baseline.predict(scene, FlowMemory::kSteps);
    std::array<Vec2, FlowMemory::kSteps> way;
    for (std::size_t row = 0; row < scene.agents.size(); ++row) {
      const ObservedAgent& agent = scene.agents[row];
      if (agent.position.size() < 3) continue;
      for (std::size_t k = 0; k < way.size(); ++k) way[k] = forecast.row(row)[k] - agent.now();
      flow.remember(agent.id, agent.now(), agent.last_velocity(scene.period), way);
    }
    flow.end_frame();
  }

  Forecast predict(const ObservedScene& scene, std::size_t steps) const {
    Forecast forecast = baseline.predict(scene, steps);
    for (std::size_t row = 0; row < scene.agents.size(); ++row) {
      const ObservedAgent& agent = scene.agents[row];
      const bool walks = type_of(types, agent.type).kinematics == Kinematics::Holonomic;
      const FlowKernel& kernel = walks ? parameters.walker.flow : parameters.wheels.flow;
      const auto correction =
          flow.correction(agent.id, agent.now(), agent.last_velocity(scene.period), kernel);
      for (std::size_t k = 0; k < steps; ++k) forecast.position[row * steps + k] += correction[k];
    }
    return forecast;
  }
};

constexpr std::string_view kFlowSuffix = "+flow";

Method flowed_method(const Baseline& baseline, const MethodSettings& settings) {
  const std::shared_ptr<FlowedBaseline> flowed(
      new FlowedBaseline{.baseline = baseline, .parameters = settings.parameters});
  Method method{std::string(baseline.name) + std::string(kFlowSuffix),
                std::string(baseline.title) + " + flow",
                {},
                {},
                {},
                {}};
  method.observe = [flowed](const ObservedScene& scene) { flowed->observe(scene); };
  method.predict = [flowed](const ObservedScene& scene, std::size_t steps) {
    return flowed->predict(scene, steps);
  };
  method.forget = [flowed] { flowed->flow = FlowMemory(); };
  return method;
}

Method gamma_method(const Variant& variant, const MethodSettings& settings, const TrackSet& set) {
  PredictorOptions options;
  variant.change(options);
  auto predictor = std::make_shared<GammaPredictor>(recorded_agent_types(), settings.parameters,
                                                    options, set.period, set.obstacles);
  if (settings.map != nullptr) predictor->use_map(*settings.map);
  Method method{variant.name, variant.title, {}, {}, {}, {}};
  method.forget = [predictor] { predictor->forget(); };
  method.observe = [predictor](const ObservedScene& scene) { predictor->observe(scene); };
  method.observe_in_window = [predictor](const ObservedScene& scene, std::size_t later) {
    predictor->observe_in_window(scene, later);
  };
  method.predict = [predictor](const ObservedScene&, std::size_t steps) {
    return predictor->forecast(steps);
  };
  method.draws = name_of(settings.draws);
  if (settings.samples > 1)
    method.sample = [predictor, settings](const ObservedScene&, std::size_t steps) {
      std::vector<Forecast> samples;
      for (std::size_t k = 0; k < settings.samples; ++k)
        samples.push_back(
            predictor->sample(k, settings.samples, steps, {settings.seed, settings.draws}));
      return samples;
    };
  return method;
}

/// The bound over the hypotheses: every intention alone counts as a sample, the best is taken.
Method oracle_method(const MethodSettings& settings, const TrackSet& set) {
  auto predictor = std::make_shared<GammaPredictor>(recorded_agent_types(), settings.parameters,
                                                    PredictorOptions{}, set.period, set.obstacles);
  Method method{"oracle", "  bound: best single intention (min columns)", {}, {}, {}, {}};
  method.forget = [predictor] { predictor->forget(); };
  method.observe = [predictor](const ObservedScene& scene) { predictor->observe(scene); };
  method.predict = [predictor](const ObservedScene&, std::size_t steps) {
    return predictor->forecast(steps);
  };
  method.draws = "intentions";
  method.sample = [predictor](const ObservedScene&, std::size_t steps) {
    std::vector<Forecast> all;
    for (std::size_t k = 0; k < kFreeIntentions; ++k)
      all.push_back(predictor->forecast_intention(static_cast<IntentionHypothesis>(k), steps));
    all.push_back(predictor->forecast(steps));
    return all;
  };
  return method;
}

/// Constant velocity along a fan of directions and speeds: what best-of-N measures without a model.
/// Five speeds times N/5 directions within 20 degrees.
std::vector<Forecast> velocity_fan(const ObservedScene& scene, std::size_t count,
                                   std::size_t steps) {
  constexpr double kSpeeds[] = {1.0, 0.75, 1.15, 0.5, 0.9};
  const std::size_t directions = std::max<std::size_t>((count + 4) / 5, 1);
  const Forecast straight = constant_velocity(scene, steps);
  std::vector<Forecast> fan;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t d = k / 5;
    const double share =
        directions > 1 ? static_cast<double>(d) / static_cast<double>(directions - 1) : 0.5;
    const Vec2 turn = kSpeeds[k % 5] * direction_of(radians(-20.0 + 40.0 * share));
    Forecast one = straight;
    for (std::size_t row = 0; row < scene.agents.size(); ++row)
      for (std::size_t step = 0; step < steps; ++step) {
        Vec2& position = one.position[row * steps + step];
        position = scene.agents[row].now() + from_body(position - scene.agents[row].now(), turn);
      }
    fan.push_back(std::move(one));
  }
  return fan;
}

Method baseline_method(const Baseline& baseline) {
  return {std::string(baseline.name), std::string(baseline.title), {}, baseline.predict, {}, {}};
}

}  // namespace

std::vector<std::string> default_methods(bool ablations, Memory memory, bool map) {
  std::vector<std::string> names;
  if (ablations) {
    for (const Variant& variant : kVariants)
      if (map || variant.name != std::string_view(kWithoutMap)) names.emplace_back(variant.name);
    return names;
  }
  names.emplace_back("gamma");
  if (map) names.emplace_back(kWithoutMap);
  for (const Baseline& baseline : baselines()) names.emplace_back(baseline.name);
  // who may learn from the recording is compared with those who may as well
  if (memory == Memory::Online)
    for (const char* simple : {"cv", "mean", "kalman", "ca"})
      names.push_back(simple + std::string(kFlowSuffix));
  return names;
}

std::string all_methods() {
  std::string all;
  auto add = [&](std::string_view name) { all += (all.empty() ? "" : ", ") + std::string(name); };
  for (const Variant& variant : kVariants) add(variant.name);
  add("oracle");
  add("cv-fan");
  for (const Baseline& baseline : baselines()) add(baseline.name);
  return all + "; with +flow behind a baseline's name it learns as gamma does";
}

Method make_method(const std::string& name, const MethodSettings& settings, const TrackSet& set) {
  for (const Variant& variant : kVariants)
    if (variant.name == name) return gamma_method(variant, settings, set);
  if (name == "oracle") return oracle_method(settings, set);
  if (name == "cv-fan") {
    Method method{"cv-fan", "constant velocity, fan of directions", {}, constant_velocity, {}, {}};
    method.draws = "fan";
    if (settings.samples > 1)
      method.sample = [count = settings.samples](const ObservedScene& scene, std::size_t steps) {
        return velocity_fan(scene, count, steps);
      };
    return method;
  }
  if (name.ends_with(kFlowSuffix))
    return flowed_method(find_baseline(name.substr(0, name.size() - kFlowSuffix.size())), settings);
  return baseline_method(find_baseline(name));
}

}  // namespace sumogamma
