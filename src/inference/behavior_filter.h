#pragma once

#include <array>

#include "inference/belief.h"
#include "inference/hypotheses.h"
#include "model/nearby.h"

namespace sumogamma {

/// What the filter takes for granted about a kind of agent.
struct FilterParameters {
  std::array<double, kIntentions> intention_prior{1, 1, 1, 1};  ///< nothing of a road
  std::array<double, kAttentions> attention_prior{0.7, 0.3};
  std::array<double, kResponsibilities> responsibility_prior{0.7, 0.3};
  double deviation = 0.1;        ///< sigma of Eq. 9 [m]
  double change_of_mind = 0.05;  ///< probability a period that theta is drawn anew
};

/// Where an agent is expected next under each hypothesis of one factor, the others at their
/// likeliest.
struct Expectation {
  Expectation() {
    by_intention.fill(Vec2::Zero());
    by_attention.fill(Vec2::Zero());
    by_responsibility.fill(Vec2::Zero());
  }

  bool valid = false;
  std::array<Vec2, kIntentions> by_intention;             ///< [m]
  std::array<Vec2, kAttentions> by_attention;             ///< [m]
  std::array<Vec2, kResponsibilities> by_responsibility;  ///< [m]
};

/// The prior as a belief.
Belief initial_belief(const FilterParameters& parameters);

/// theta at which each factor is likeliest, for a type; its intention has no goal yet.
BehaviorState likeliest_behavior(const AgentType& type, const Belief& belief);

/// One row of a frozen scene whose next place is asked for.
struct Question {
  const Model& model;
  Scene& scene;  ///< its goal and preferred speed in the row are written
  const TickGeometry& geometry;
  std::size_t row;
  const std::array<Vec2, kIntentions>& wanted;  ///< velocity by intention over the period [m/s]
  Vec2 position;                                ///< the observed point that moves with it [m]
  double period;                                ///< [s]
  Nearby& nearby;                               ///< scratch
};

/// Eq. 8 for one row: one pass of gamma_velocity a hypothesis. Attention and responsibility are
/// passed through the model only where a neighbour binds; elsewhere they cannot tell.
Expectation expect_next(const Question& asked, const Belief& belief, Workspace& work);

/// Eqs. 9 and 10: weighs the hypotheses by the place where the agent was seen next. `noise` is the
/// deviation of the observation itself [m].
void update_belief(const FilterParameters& parameters, const Expectation& expectation,
                   const Vec2& seen, double noise, Belief& belief);

/// Lets gamma_velocity ask for `velocity` [m/s] in a row: sets its goal and preferred speed.
void set_wanted_velocity(Scene& scene, std::size_t row, const Vec2& velocity);

}  // namespace sumogamma
