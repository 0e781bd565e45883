#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "realism/motion_features.h"
#include "scene/scene.h"
#include "study/distribution_distance.h"

namespace sumogamma {

/// Distributions that are compared beside the composite.
enum class CountedMeasure : std::uint8_t {
  Speed,
  Acceleration,      ///< of who goes faster than 0.5 m/s
  YawRate,           ///< of who goes faster than 1 m/s
  Nearest,           ///< signed distance to the nearest other box
  TimeToCollision,   ///< to who is ahead; 5 s where there is none
  TimeGap,           ///< gap to who is ahead over the speed, of who goes faster than 2 m/s, to 6 s
  PostEncroachment,  ///< the least of a pair, up to 5 s (EncroachmentMonitor)
};
inline constexpr std::size_t kCountedMeasures = 7;

struct CountedMeasureInfo {
  const char *name, *unit;
  Bins bins;
};
/// In the order of the enumeration.
const std::array<CountedMeasureInfo, kCountedMeasures>& counted_measures();

/// Counts of every measure over its bins: of a recording, or of a method's rollouts. Sums add up.
struct MotionCounts {
  std::array<std::vector<double>, kCountedMeasures> counts;

  MotionCounts();
  void add(const MotionCounts& other);
  double total(CountedMeasure measure) const;
  /// Counts everybody every half second of a window.
  void add_motion(const MotionFeatures& features);
  /// Counts the pairs of a window of which one crosses where the other was.
  void add_encroachments(const Poses& poses, const Bodies& bodies);
  /// The same of scenes that follow each other, kScoreStep apart, whose ids stay the same bodies;
  /// up to `longest` [s].
  void add_encroachments(std::size_t steps, const std::function<Scene(std::size_t step)>& scene_at,
                         double longest);
};

/// Appends a box to a scene, by its row and as it moves. Precondition: as append_agent has.
void append_body(Scene& scene, std::size_t row, const MotionState& state, const Vec2& size);

/// Hellinger distances by measure; NaN where either side has no value.
std::array<double, kCountedMeasures> hellinger(const MotionCounts& a, const MotionCounts& b);

/// How far parts of five minutes of one recording are apart: mean over all pairs of parts. Empty
/// with fewer than two parts.
std::vector<double> noise_floor(const std::vector<MotionCounts>& parts);

}  // namespace sumogamma
