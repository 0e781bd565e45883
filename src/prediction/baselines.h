#pragma once

#include <span>
#include <string_view>

#include "prediction/observed_scene.h"

namespace sumogamma {

/// Predicts everybody in a scene for `steps` periods from what was seen, and nothing else. A
/// newcomer of one frame is predicted to stand.
using BaselineFunction = Forecast (*)(const ObservedScene& scene, std::size_t steps);

struct Baseline {
  std::string_view name, title;
  BaselineFunction predict;
};

/// All baselines, in the order of the tables.
std::span<const Baseline> baselines();
/// Throws Error listing the known names.
const Baseline& find_baseline(std::string_view name);

/// The last displacement goes on.
Forecast constant_velocity(const ObservedScene& scene, std::size_t steps);
/// Mean speed of the last four displacements, weighted 1, .8, .64, .4096 (the published predictor's
/// filter), along the last displacement.
Forecast smoothed_velocity(const ObservedScene& scene, std::size_t steps);
/// The mean acceleration of the last two changes goes on; stops instead of turning back.
Forecast constant_acceleration(const ObservedScene& scene, std::size_t steps);
/// Speed and turn rate of the last displacements go on.
Forecast constant_turn_rate(const ObservedScene& scene, std::size_t steps);
/// The mean of the last three displacements goes on.
Forecast mean_velocity(const ObservedScene& scene, std::size_t steps);
/// The speed's change goes on along an arc of the present turn rate, both from the last three
/// displacements; stops instead of turning back.
Forecast turning_acceleration(const ObservedScene& scene, std::size_t steps);
/// Constant velocity behind a Kalman filter of position and velocity over the last eight frames
/// (white acceleration 0.5 m/s^2, observations 5 cm).
Forecast kalman_velocity(const ObservedScene& scene, std::size_t steps);
/// Reciprocal avoidance of discs (ORCA): shares of one half, towards where the last velocity leads.
Forecast disc_orca(const ObservedScene& scene, std::size_t steps);
/// The same with the paper's responsibilities by type (PORCA's asymmetry between walkers and
/// wheels).
Forecast porca(const ObservedScene& scene, std::size_t steps);
/// Social force as an energy over the next velocity (Pellegrini et al. 2009, the form that
/// Yamaguchi et al. 2011 extend), with the published parameters.
Forecast social_force(const ObservedScene& scene, std::size_t steps);

}  // namespace sumogamma
