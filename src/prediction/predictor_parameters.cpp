#include "prediction/predictor_parameters.h"

#include <charconv>
#include <cmath>

#include "base/error.h"

namespace sumogamma {

PredictorParameters default_predictor_parameters() {
  PredictorParameters p;
  p.walker.noise = {.observation = 0.004445,
                    .acceleration_variance = 0.1765,
                    .acceleration_time = 0.2,
                    .velocity_drift = 0.01334};
  p.walker.noise_scale = 7.5;
  p.walker.noise_power = 1.5;
  p.walker.shape = {
      .acceleration_decay = 2.25, .speed_decay = 0.054, .turn_decay = 1.5, .stop_time = 1.0};
  p.walker.flow = {.distance = 1.875, .speed = 0.3, .prior = 4};
  p.walker.filter.intention_prior = {0.05303, 1, 0.1414, 0.1};
  p.walker.filter.change_of_mind = 0.005988;
  p.companions = {.distance = 1.5, .speed = 0.2143, .weight = 0.3};
  // by hand: the regression looks twelve steps ahead, rounds four
  p.walker.experts = {.rate = 0.3, .own = 2, .walking = 1000, .others = 100, .keep = 0.98};
  p.wheels.experts = {.rate = 2, .own = 2, .others = 1000, .keep = 0.98};

  p.wheels.noise = {.observation = 0.02,
                    .acceleration_variance = 0.2654,
                    .acceleration_time = 4.913,
                    .velocity_drift = 0.007906};
  p.wheels.shape = {.acceleration_decay = 1.225,
                    .speed_decay = 0.0002645,
                    .turn_decay = 1.186,
                    .stop_time = 0.2419};
  p.wheels.flow = {.distance = 1.875, .speed = 0.6, .prior = 2.178};
  p.wheels.filter.intention_prior = {0.6, 1, 0.2121, 0.008839};
  p.wheels.filter.deviation = 0.1837;
  p.wheels.filter.change_of_mind = 0.07444;
  return p;
}

std::span<const TrainingRecording> training_recordings() {
  static constexpr TrainingRecording kRecordings[] = {
      {"eth", 0x59e780a2fb1609db},
      {"hotel", 0x7783f672d0ae4c83},
      {"univ003", 0xc9fc52a630ce7e95},
      {"zara1", 0xa9e66c6cb2ad9845},
      {"cross", 0x0a570409514ec603},
      {"intersection_10", 0xf55dad2b36528013},
      {"intersection_11", 0xf21246a4d297f3d1},
      {"intersection_12", 0x92ab1debda2d2f8b},
      {"roundabout_10", 0x6b86088ea0e38479},
      {"bi_corr_400_b_03", 0xb7a6ffa732a29989},
      {"uo-050-180-180", 0x2ec4e1b9d99972f0},
      {"uo-070-180-180", 0x30b8c572382d3fd2},
      {"uo-100-180-180", 0x5e522c5bbe7fef35},
      {"uo-180-180-070", 0xc550917766847c1c},
      {"uo-180-180-120", 0xbb8806cbf7710a14},
  };
  return kRecordings;
}

bool trained_on(std::uint64_t content) {
  for (const TrainingRecording& recording : training_recordings())
    if (recording.content == content) return true;
  return false;
}

namespace {
void append_kind(const std::string& prefix, KindParameters& kind,
                 std::vector<NamedParameter>& all) {
  auto add = [&](const char* name, double& value) { all.push_back({prefix + name, &value}); };
  add("observation_noise", kind.noise.observation);
  add("noise_scale", kind.noise_scale);
  add("noise_power", kind.noise_power);
  add("acceleration_variance", kind.noise.acceleration_variance);
  add("acceleration_time", kind.noise.acceleration_time);
  add("velocity_drift", kind.noise.velocity_drift);
  add("acceleration_decay", kind.shape.acceleration_decay);
  add("speed_decay", kind.shape.speed_decay);
  add("turn_decay", kind.shape.turn_decay);
  add("stop_time", kind.shape.stop_time);
  add("prior_keep_velocity", kind.filter.intention_prior[0]);
  add("prior_keep_acceleration", kind.filter.intention_prior[1]);
  add("prior_turn", kind.filter.intention_prior[2]);
  add("prior_stop", kind.filter.intention_prior[3]);
  add("likelihood_deviation", kind.filter.deviation);
  add("change_of_mind", kind.filter.change_of_mind);
  add("flow_distance", kind.flow.distance);
  add("flow_speed", kind.flow.speed);
  add("flow_prior", kind.flow.prior);
  add("expert_rate", kind.experts.rate);
  add("expert_own", kind.experts.own);
  add("expert_prior_model", kind.experts.model);
  add("expert_prior_walking", kind.experts.walking);
  add("expert_prior_lane", kind.experts.lane);
  add("expert_others", kind.experts.others);
  add("expert_keep", kind.experts.keep);
  add("road_ahead", kind.road_ahead);
  add("road_turn", kind.road_turn);
}
}  // namespace

std::vector<NamedParameter> named_parameters(PredictorParameters& parameters) {
  std::vector<NamedParameter> all;
  append_kind("walker.", parameters.walker, all);
  append_kind("wheels.", parameters.wheels, all);
  all.push_back({"walker.companion_distance", &parameters.companions.distance});
  all.push_back({"walker.companion_speed", &parameters.companions.speed});
  all.push_back({"walker.companion_weight", &parameters.companions.weight});
  all.push_back({"rejoin", &parameters.rejoin});
  all.push_back({"horizon_walker", &parameters.horizon_walker});
  all.push_back({"horizon_wheels", &parameters.horizon_wheels});
  all.push_back({"margin", &parameters.margin});
  all.push_back({"separation_time", &parameters.separation_time});
  return all;
}

void set_parameter(PredictorParameters& parameters, std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string name(assignment.substr(0, equals));
  for (const NamedParameter& parameter : named_parameters(parameters)) {
    if (parameter.name != name) continue;
    if (equals == std::string_view::npos) break;
    const std::string_view text = assignment.substr(equals + 1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) break;
    *parameter.value = value;
    return;
  }
  throw Error("--set " + std::string(assignment),
              "expected predict.NAME=NUMBER with one of the parameters of docs/prediction.md");
}

}  // namespace sumogamma
