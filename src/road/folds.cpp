#include "road/folds.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace sumogamma {

namespace {

/// Looks along the samples of a line, `near` of them at a time.
struct Heading {
  const std::vector<Vec2>& samples;
  std::size_t near;

  Vec2 into(std::size_t i) const { return samples[i] - samples[i - near]; }
  Vec2 out_of(std::size_t i) const { return samples[i + near] - samples[i]; }
  static double cosine(const Vec2& a, const Vec2& b) {
    return a.dot(b) / std::max(a.norm() * b.norm(), 1e-9);
  }
};

/// The shortest straight piece over a tip, up to `farthest` samples to each side, that leaves the
/// line and joins it again at ease: first and last sample.
std::optional<std::pair<std::size_t, std::size_t>> bridge_over(const Heading& heading,
                                                               std::size_t tip,
                                                               std::size_t farthest) {
  constexpr double kAligned = 0.5;  // cosine between the piece and the line at its ends
  const std::size_t before = std::min(farthest, tip - heading.near);
  const std::size_t after = std::min(farthest, heading.samples.size() - 1 - heading.near - tip);
  for (std::size_t span = 2 * heading.near; span <= before + after; ++span)
    for (std::size_t back = span > after ? span - after : 1; back <= std::min(before, span - 1);
         ++back) {
      const std::size_t from = tip - back, to = from + span;
      const Vec2 piece = heading.samples[to] - heading.samples[from];
      if (Heading::cosine(heading.into(from), piece) >= kAligned &&
          Heading::cosine(piece, heading.out_of(to)) >= kAligned)
        return std::make_pair(from, to);
    }
  return std::nullopt;
}

/// First and last sample of the shortest piece across a tip, up to `farthest` samples from it, on
/// which a body that turns with `radius` [m] comes round from the one branch to the other.
std::optional<std::pair<std::size_t, std::size_t>> turn_before(const std::vector<Vec2>& samples,
                                                               std::size_t tip,
                                                               std::size_t farthest,
                                                               double radius) {
  const std::size_t most = std::min({farthest, tip, samples.size() - 1 - tip});
  for (std::size_t reach = 1; reach <= most; ++reach)
    if ((samples[tip + reach] - samples[tip - reach]).norm() >= 2.0 * radius)
      return std::make_pair(tip - reach, tip + reach);
  return std::nullopt;
}

}  // namespace

bool straighten_folds(double step, const Cornering& cornering, std::vector<Vec2>& samples) {
  constexpr double kReversal = -0.35;  // cosine of a turn within kNear
  constexpr double kNear = 1.0;        // [m]
  constexpr double kFarthest = 18.0;   // [m]
  constexpr double kNarrow = 1.2;      // [m]
  const auto farthest = static_cast<std::size_t>(kFarthest / step);
  const auto near = static_cast<std::size_t>(std::max(1.0, kNear / step));
  const Heading heading{samples, near};
  bool any = false;
  for (std::size_t tip = 2 * near; tip + 2 * near < samples.size(); ++tip) {
    const Vec2 in = heading.into(tip), out = heading.out_of(tip);
    if (in.dot(out) >= 0.0 || Heading::cosine(in, out) > kReversal) continue;
    auto bridge = bridge_over(heading, tip, farthest);
    if (!bridge && cornering.width > 0.0 && cornering.width < kNarrow)
      bridge = turn_before(samples, tip, farthest, cornering.turning_radius);
    if (!bridge) continue;
    const auto [from, to] = *bridge;
    const Vec2 begin = samples[from], piece = samples[to] - begin;
    for (std::size_t k = from + 1; k < to; ++k)
      samples[k] = begin + static_cast<double>(k - from) / static_cast<double>(to - from) * piece;
    tip = to;
    any = true;
  }
  return any;
}

}  // namespace sumogamma
