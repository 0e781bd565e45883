#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "prediction/observed_scene.h"

namespace sumogamma {

inline constexpr std::size_t kSpreadSteps = 12, kSpreadKinds = 2, kSpreadBands = 6;

/// Band of the table for somebody at this speed [m/s].
std::size_t spread_band(double speed);

/// Upper ends of the bands but the last [m/s].
inline constexpr std::array<double, kSpreadBands - 1> kSpreadSpeeds = {0.2, 0.5, 1.0, 1.5, 3.0};

/// What the seen frames tell of how far an agent will be from where it is predicted.
struct SpreadClues {
  std::size_t kind = 0, band = 0;  ///< 0 on foot, 1 on wheels; by the last displacement's speed
  double own = 0;    ///< logarithm of its unsteadiness over what is usual of its kind and band
  double scene = 0;  ///< the same of all of its kind in the scene, drawn towards 0 where few are
  /// logarithm of how much the velocities of those within some 5 m differ from its own, 1 m/s of an
  /// unseen half agent among them: in a stream that goes one way less happens
  double mixture = 0;
  double speed = 0;  ///< logarithm of the last displacement's, 0.1 m/s at the least
};

/// How far an agent was from where its displacements, gone on 1 to 4 steps, would have brought it
/// in its last eight frames, by step [m]; a floor at the least, and for those seen under 5 frames.
/// Of "the last goes on" and "the mean of three goes on" the one that errs less.
double unsteadiness(const ObservedAgent& agent);

/// Sums of log unsteadiness over a scene by kind and band, and how many are counted.
struct SceneUnsteadiness {
  std::array<std::array<double, kSpreadBands>, kSpreadKinds> sum{}, count{};
};

/// Clues of everybody in a scene, from the last eight frames alone; `told`, where given, gets the
/// sums that they are made of.
std::vector<SpreadClues> spread_clues(const AgentTypeTable& types, const ObservedScene& scene,
                                      SceneUnsteadiness* told = nullptr);

/// Where an agent may be at the steps to come: ellipses about the prediction. The radius of a
/// normal cloud, 2.146 deviations to hold 90 %, is stretched by `tail`: above 1 there is more at
/// the core and far out.
struct Spread {
  Vec2 forward = Vec2(1, 0);
  std::array<double, kSpreadSteps> along{}, across{};  ///< [m]
  std::array<double, kSpreadSteps> tail{};

  /// Departure at step k (0 is the first) of a draw at `radius` deviations towards `direction`
  /// (unit, first entry forward), in the world's axes [m].
  Vec2 departure(std::size_t k, double radius, const Vec2& direction) const;
};

/// The table of tools/train_spread.py for these clues. `forward`: unit.
Spread spread_for(const SpreadClues& clues, const Vec2& forward);

}  // namespace sumogamma
