#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/vec2.h"
#include "prediction/track_set.h"

namespace sumogamma {

/// What has been seen of one agent so far: a view that ends now, so that nobody can look ahead.
struct ObservedAgent {
  std::uint32_t id = 0;
  AgentTypeId type{};
  std::span<const Vec2> position;   ///< oldest first, the last one is now [m]
  std::span<const double> heading;  ///< likewise [rad]

  const Vec2& now() const { return position.back(); }
  /// Last displacement over the period; null for a newcomer [m/s].
  Vec2 last_velocity(double period) const {
    const std::size_t n = position.size();
    return n < 2 ? Vec2(Vec2::Zero()) : Vec2((position[n - 1] - position[n - 2]) / period);
  }
};

/// Everybody present at one frame, in order of id.
struct ObservedScene {
  int frame = 0;
  double period = 0.4;  ///< [s]
  std::vector<ObservedAgent> agents;
};

/// The agents of a recording at a frame. The views point into `set`.
inline ObservedScene observe(const TrackSet& set, int frame) {
  ObservedScene scene{frame, set.period, {}};
  for (const Track& track : set.tracks) {
    if (!track.present(frame)) continue;
    const auto seen = static_cast<std::size_t>(frame - track.first) + 1;
    scene.agents.push_back({track.id, track.type, std::span(track.position).first(seen),
                            std::span(track.heading).first(seen)});
  }
  return scene;
}

/// Positions and headings of every agent at the steps to come; row by row, `steps` entries a row.
struct Forecast {
  std::size_t steps = 0;
  std::vector<Vec2> position;   ///< of the reference points [rows x steps, m]
  std::vector<double> heading;  ///< [rows x steps, rad]

  void resize(std::size_t rows, std::size_t step_count) {
    steps = step_count;
    position.assign(rows * steps, Vec2::Zero());
    heading.assign(rows * steps, 0.0);
  }
  std::span<const Vec2> row(std::size_t r) const { return {position.data() + r * steps, steps}; }
  std::span<const double> headings(std::size_t r) const {
    return {heading.data() + r * steps, steps};
  }
};

}  // namespace sumogamma
