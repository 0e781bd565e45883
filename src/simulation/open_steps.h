#pragma once

#include <vector>

#include "base/parallel.h"
#include "model/gamma_velocity.h"
#include "model/tracking.h"
#include "scene/scene.h"

namespace sumogamma {

/// Steps of open ground, where no rule of the road holds: everybody decides on the frozen scene
/// (Eq. 7, guard), then everybody moves, in steps of `model.options.step`. The model must outlive
/// it. The same bits for any number of workers.
class OpenSteps {
 public:
  OpenSteps(const Model& model, Workers& workers);

  /// Moves the first `rows` rows a step on; the others are seen and stay where they are.
  void make(std::size_t rows, Scene& scene);

 private:
  const Model& model_;
  Workers& workers_;
  TickGeometry geometry_;
  std::vector<Workspace> workspaces_;
  std::vector<BodyState> commands_;
};

}  // namespace sumogamma
