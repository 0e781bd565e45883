#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "model/gamma_velocity.h"
#include "model/tracking.h"
#include "traffic/pipeline.h"

namespace sumogamma {

/// What of a step is done. What is left out is left out for everybody.
struct AdvanceOptions {
  double dt = 0.05;   ///< [s]; the guard reckons with ModelOptions::step, which should be the same
  bool rules = true;  ///< right of way, signals, leaders, courtesy, lanes as borders; without them
                      ///< a path is the way that somebody means to take, and nothing more
  bool lanes = true;  ///< lane choice, places in the lane, detours
};

/// Scratch of a step: means nothing between steps.
struct AdvanceWork {
  TickGeometry geometry;
  std::vector<Workspace> workspaces;  ///< one a worker
  std::vector<BodyState> commands;    ///< one a row
  std::vector<Binding> bindings;      ///< one a row: what held its velocity, for whoever watches
};

/// The velocity that the planner of a row (Control::Planned) asks of its body [m/s], from the
/// frozen scene with this step's contexts. Called once a step for each such row, in order, before
/// anybody else's velocity is chosen.
using PlannedVelocity = std::function<Vec2(const TrafficView&, std::size_t row)>;

/// A step's world. All of it is plain data: copies of road, scene and traffic are a fork, and
/// advancing that changes nothing in what it was copied from.
struct Advance {
  const Model& model;
  Workers& workers;
  RoadState& road;
  Scene& scene;
  Traffic& traffic;
  AdvanceWork& work;
};

/// The first part of a step: where everybody is on its path, lanes and places in them, and what
/// the road says to each row (RoadContext).
void look_about(const Advance& world, const AdvanceOptions& options);

/// The second: everybody's command from the frozen scene. Eq. 7 for rows of Control::Gamma,
/// `planned` for those of Control::Planned (null: they brake), nothing for others.
void choose_commands(const Advance& world, const AdvanceOptions& options,
                     const PlannedVelocity& planned);

/// The third: bodies move as commanded, halts and standing are counted, time goes on. Returns how
/// many rows moved.
std::int64_t move_bodies(const Advance& world, const AdvanceOptions& options);

/// All three: what a tick does between observing the world and advancing it. Rows that are
/// nobody's of ours (Control::External, Parked) stay where they are.
void advance_rows(const Advance& world, const AdvanceOptions& options,
                  const PlannedVelocity& planned = {});

}  // namespace sumogamma
