#pragma once

#include <span>
#include <vector>

#include "model/gamma_velocity.h"
#include "model/tracking.h"
#include "prediction/observed_scene.h"

namespace sumogamma {

/// A copy of what was seen as a scene of the model: boxes about their centres, speeds and headings
/// of now. `velocity` by row: of the reference points [m/s].
void build_scene(const AgentTypeTable& types, const ObservedScene& seen,
                 std::span<const Vec2> velocity, Scene& scene);

/// How a roll-out follows what is wanted.
struct RollOutOptions {
  bool use_bodies =
      true;             ///< the types' controllers and bodies move (f_A); false: exactly as asked
  double rejoin = 1.0;  ///< share of a detour that is made good within a period
};

/// Joint roll-out of a scene: everybody asks for the next point of its own wanted path, Eq. 7
/// answers with everybody's present state, and all move at once; newcomers are unknown and leavers
/// stay in the roll-out, for nobody knows when they leave. `path` [rows x steps]: points of the
/// reference points [m]. Moves `scene` to the last step. Scratch is kept between calls.
class RollOut {
 public:
  void run(const Model& model, const RollOutOptions& options, double period,
           std::span<const Vec2> path, std::size_t steps, Scene& scene, Forecast& forecast);

 private:
  TickGeometry geometry_;
  Workspace work_;
  Workers workers_{1};
  std::vector<BodyState> next_;
};

}  // namespace sumogamma
