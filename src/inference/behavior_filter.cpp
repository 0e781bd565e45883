#include "inference/behavior_filter.h"

namespace sumogamma {

Belief initial_belief(const FilterParameters& parameters) {
  return {HypothesisWeights<kIntentions>::from(parameters.intention_prior),
          HypothesisWeights<kAttentions>::from(parameters.attention_prior),
          HypothesisWeights<kResponsibilities>::from(parameters.responsibility_prior)};
}

BehaviorState likeliest_behavior(const AgentType& type, const Belief& belief) {
  BehaviorState behavior;
  behavior.intention.kind = IntentionKind::Goal;
  behavior.attention = attention_of(type, belief.attention.most_likely());
  behavior.responsibility = responsibility_of(belief.responsibility.most_likely());
  return behavior;
}

void set_wanted_velocity(Scene& scene, std::size_t row, const Vec2& velocity) {
  // far enough that the goal's own braking never begins
  constexpr double kFar = 60.0;  // [s]
  scene.behavior[row].intention.kind = IntentionKind::Goal;
  scene.behavior[row].intention.goal = scene.position[row] + kFar * velocity;
  scene.preferred_speed[row] = velocity.norm();
}

namespace {
/// One pass of the model: where the row is expected next [m].
Vec2 pass(const Question& asked, std::size_t intention, std::size_t attention,
          std::size_t responsibility, Workspace& work) {
  set_wanted_velocity(asked.scene, asked.row, asked.wanted[intention]);
  BehaviorState behavior = asked.scene.behavior[asked.row];
  behavior.attention =
      attention_of(type_of(asked.model.types, asked.scene.type[asked.row]), attention);
  behavior.responsibility = responsibility_of(responsibility);
  return asked.position + asked.period * gamma_velocity_among(asked.model, asked.scene,
                                                              asked.geometry, behavior,
                                                              asked.nearby, work);
}

bool neighbour_binds_in(const Workspace& work) {
  const ConstraintSource* source = work.binding_source();
  return source != nullptr && source->kind == ConstraintKind::Neighbour;
}
}  // namespace

Expectation expect_next(const Question& asked, const Belief& belief, Workspace& work) {
  const std::size_t likeliest = belief.intention.most_likely();
  const std::size_t attention = belief.attention.most_likely();
  const std::size_t responsibility = belief.responsibility.most_likely();
  Expectation expectation;
  expectation.valid = true;
  const AgentType& type = type_of(asked.model.types, asked.scene.type[asked.row]);
  find_nearby(asked.model.road, asked.geometry, asked.row, attention_of(type, kAttentions - 1),
              asked.nearby);
  bool neighbour_binds = false;
  for (std::size_t k = 0; k < kIntentions; ++k) {
    expectation.by_intention[k] = asked.position;
    // what the prior rules out needs no pass
    if (belief.intention.ruled_out(k)) continue;
    expectation.by_intention[k] = pass(asked, k, attention, responsibility, work);
    if (k == likeliest) neighbour_binds = neighbour_binds_in(work);
  }
  expectation.by_attention.fill(expectation.by_intention[likeliest]);
  expectation.by_responsibility.fill(expectation.by_intention[likeliest]);
  if (!neighbour_binds) return expectation;
  for (std::size_t k = 0; k < kAttentions; ++k)
    if (k != attention)
      expectation.by_attention[k] = pass(asked, likeliest, k, responsibility, work);
  for (std::size_t k = 0; k < kResponsibilities; ++k)
    if (k != responsibility)
      expectation.by_responsibility[k] = pass(asked, likeliest, attention, k, work);
  return expectation;
}

namespace {
template <std::size_t N>
std::array<double, N> log_likelihoods(const HypothesisWeights<N>& belief,
                                      const std::array<Vec2, N>& expected, const Vec2& seen,
                                      double deviation) {
  std::array<double, N> result{};
  for (std::size_t k = 0; k < N; ++k) {
    if (belief.ruled_out(k)) continue;
    // mostly nothing tells the hypotheses apart
    const bool same = k > 0 && !belief.ruled_out(k - 1) && expected[k] == expected[k - 1];
    result[k] = same ? result[k - 1] : log_likelihood((seen - expected[k]).norm(), deviation);
  }
  return result;
}
}  // namespace

void update_belief(const FilterParameters& parameters, const Expectation& expectation,
                   const Vec2& seen, double noise, Belief& belief) {
  belief.intention.forget(parameters.change_of_mind, parameters.intention_prior);
  belief.attention.forget(parameters.change_of_mind, parameters.attention_prior);
  belief.responsibility.forget(parameters.change_of_mind, parameters.responsibility_prior);
  if (!expectation.valid) return;
  const double deviation = std::hypot(parameters.deviation, noise);
  belief.intention.update(
      log_likelihoods(belief.intention, expectation.by_intention, seen, deviation));
  belief.attention.update(
      log_likelihoods(belief.attention, expectation.by_attention, seen, deviation));
  belief.responsibility.update(
      log_likelihoods(belief.responsibility, expectation.by_responsibility, seen, deviation));
}

}  // namespace sumogamma
