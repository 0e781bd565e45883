#pragma once

#include <array>
#include <span>
#include <vector>

#include "prediction/experts.h"
#include "prediction/observed_scene.h"

namespace sumogamma {

/// What the regression looks at, vectors in the world's axes [m a period]: its own last
/// displacement, the mean of the two before and that of the four before those; how companions' mean
/// displacement and last displacement differ from its own; how far its motion is from the axis
/// along which people walk here (near, and far), in either direction; and from the direction of
/// those who go alike. The first five count twice: for recordings where the last displacement tells
/// most, and for those whose noise asks for a mean.
inline constexpr std::size_t kWalkingFeatures = 13;
using WalkingFeatures = std::array<Vec2, kWalkingFeatures>;

/// Features of everybody in a scene, from their last eight frames. Rows of wheels are null. Rotates
/// and mirrors with the world.
void walking_features(const AgentTypeTable& types, const ObservedScene& scene,
                      std::vector<WalkingFeatures>& features);

/// Displacements that the regression expects: the sum of features times k a + k^2 b / 12 at step k,
/// with the coefficients of tools/train_walking_model.py. They hold for periods of 0.4 s.
void walking_path(const WalkingFeatures& features, std::span<Vec2> displacement);
inline constexpr double kWalkingPeriod = 0.4;  // [s]

}  // namespace sumogamma
