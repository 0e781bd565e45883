#pragma once

#include <cstdint>
#include <vector>

#include "ego/ego_action.h"

namespace sumogamma {

struct Futures;
struct PlanRoot;

/// What a planner reckoned with at a plan, and what it made of that: for whoever looks on. No
/// planner reads it, and one that nobody looks at makes none.
struct PlanTrace {
  AgentId ego;
  double time = 0;  ///< of the scene [s]
  EgoAction action;

  /// One that somebody may take.
  struct Way {
    double probability = 0;
    /// From where it is to where it may be at the planner's horizon; a single point: it stops.
    std::vector<Vec2> line;
  };
  struct Belief {
    AgentId id;
    std::vector<Way> ways;  ///< their probabilities add up to 1
  };
  std::vector<Belief> beliefs;  ///< in order of id

  /// What one of those about the ego, or the ego, does in a scenario.
  struct Part {
    AgentId id;
    std::int32_t way = -1;   ///< of its belief; -1: as `line` says
    std::vector<Vec2> line;  ///< from where it is, then once a second, where that was predicted
  };
  using Scenario = std::vector<Part>;
  std::vector<Scenario> scenarios;

  /// What the figures of the choices are.
  enum class Figures : std::uint8_t {
    None,
    Values,    ///< bounds on what the scenarios are worth
    Meetings,  ///< the share of futures in which the ego meets somebody, twice
  };
  Figures figures = Figures::None;
  struct Choice {
    double acceleration = 0;      ///< [m/s^2]
    double lower = 0, upper = 0;  ///< lower: minus infinity where it wasn't looked at
  };
  std::vector<Choice> choices;

  /// A belief node of the search, or of the first of two trees.
  struct TreeNode {
    std::int32_t parent = -1;     ///< the root: -1
    double acceleration = 0;      ///< that leads to it [m/s^2]
    int depth = 0;                ///< steps from the root
    double weight = 0;            ///< share of the scenarios
    double lower = 0, upper = 0;  ///< on their values, discounted to the root and weighted
  };
  std::vector<TreeNode> tree;  ///< the root first, parents before children; empty: no search
};

/// Notes what is believed of those whom a plan begins with, `horizon` [s] on: as far as each comes
/// that speeds up to the pace that it likes.
void trace_beliefs(const AgentTypeTable& types, const PlanRoot& root, double horizon,
                   PlanTrace& trace);

/// Notes which ways the scenarios 0 to `count` - 1 of draw_scenario have.
void trace_scenarios(const PlanRoot& root, std::uint64_t key, std::uint32_t count,
                     PlanTrace& trace);

/// Notes sampled futures as scenarios. `scene`: from which they were sampled.
void trace_futures(const Scene& scene, const Futures& futures, PlanTrace& trace);

}  // namespace sumogamma
