#include "road/turnaround.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/units.h"
#include "geometry/polyline.h"

namespace sumogamma {

namespace {

constexpr double kRound = 150.0;    // [degrees] a line that turns by so much turns round
constexpr double kWithin = 14.0;    // on so much of its way [m]
constexpr double kStraight = 3.0;   // [degrees] a metre: less is no part of the turn
constexpr double kBranch = 2.0;     // over which a branch's direction is taken [m]
constexpr double kOffBranch = 0.5;  // [m] that samples may lie off a straight branch
constexpr double kEase = 1.06;      // times the tightest radius

/// Samples between which a line turns round, and to which side (1: left).
struct Reversal {
  std::size_t first = 0, last = 0;
  double side = 1.0;
};

/// By how much the line turns at a sample [rad], positive to the left.
double turn_at(const std::vector<Vec2>& samples, std::size_t i) {
  const Vec2 in = samples[i] - samples[i - 1], out = samples[i + 1] - samples[i];
  return std::atan2(cross(in, out), in.dot(out));
}

/// Does the line turn by less than a small angle [rad] there for sure? Tells it without the angle.
bool is_straight_at(const std::vector<Vec2>& samples, std::size_t i, double angle) {
  constexpr double kSure = 0.99;
  const Vec2 in = samples[i] - samples[i - 1], out = samples[i + 1] - samples[i];
  // an angle is less than its tangent
  return std::abs(cross(in, out)) < kSure * angle * in.dot(out);
}

/// The first reversal from sample `begin` on.
std::optional<Reversal> find_reversal(const std::vector<Vec2>& samples, double step,
                                      std::size_t begin) {
  const auto longest = static_cast<std::size_t>(kWithin / step);
  const double least = radians(kStraight) * step;
  for (std::size_t i = std::max<std::size_t>(begin, 1); i + 1 < samples.size(); ++i) {
    if (is_straight_at(samples, i, least)) continue;
    if (std::abs(turn_at(samples, i)) < least) continue;
    const double side = turn_at(samples, i) > 0.0 ? 1.0 : -1.0;
    double sum = 0.0, most = 0.0;
    std::size_t last = i;
    for (std::size_t k = i; k + 1 < samples.size() && k <= i + longest; ++k) {
      sum += side * turn_at(samples, k);
      if (sum < 0.0) break;
      if (sum > most + least) {
        most = sum;
        last = k;
      }
    }
    if (most >= radians(kRound)) return Reversal{i, last, side};
  }
  return std::nullopt;
}

/// One of the two straight pieces that a reversal joins, seen from it: a place, the direction away
/// from the reversal and the normal to the outer side.
struct Branch {
  Vec2 place, away, outer;

  /// How far away from the reversal the arc of `radius` begins that is tangent to the branch and
  /// leads into the circle about `center`; nothing where there is none.
  std::optional<double> begin_of_arc(const Vec2& center, double radius) const {
    const Vec2 way = place + radius * outer - center;
    const double along = way.dot(away);
    const double square = along * along - way.squaredNorm() + 4.0 * radius * radius;
    if (square < 0.0) return std::nullopt;
    return std::sqrt(square) - along;
  }
  Vec2 arc_center(double begin, double radius) const {
    return place + begin * away + radius * outer;
  }
};

/// Appends an arc about `center` from one of its points to another, to the left (side 1) or right.
void append_arc(const Vec2& center, const Vec2& from, const Vec2& to, double side,
                std::vector<Vec2>& points) {
  constexpr double kPiece = 0.1;  // [rad]
  const Vec2 a = from - center, b = to - center;
  double angle = side * std::atan2(cross(a, b), a.dot(b));
  if (angle < -1e-6) angle += 2.0 * kPi;
  const int pieces = std::max(1, static_cast<int>(angle / kPiece));
  for (int k = 0; k <= pieces; ++k) {
    const double turned = side * angle * k / pieces;
    points.push_back(center + Vec2(std::cos(turned) * a.x() - std::sin(turned) * a.y(),
                                   std::sin(turned) * a.x() + std::cos(turned) * a.y()));
  }
}

/// Does the line lie along a branch from the reversal's sample `end` to sample `to`?
bool follows(const Branch& branch, const std::vector<Vec2>& samples, std::size_t end,
             std::size_t to) {
  for (std::size_t k = std::min(end, to); k <= std::max(end, to); ++k)
    if (std::abs(cross(branch.away, samples[k] - branch.place)) > kOffBranch) return false;
  return true;
}

/// The bulb of a reversal, from the sample `from` to the sample `to`.
struct Bulb {
  std::size_t from = 0, to = 0;
  std::vector<Vec2> points;
};

std::optional<Bulb> make_bulb(const std::vector<Vec2>& samples, double step, double radius,
                              const Reversal& reversal) {
  const auto look = static_cast<std::size_t>(std::ceil(kBranch / step));
  const auto [first, last, side] = reversal;
  if (first < look + 1 || last + look + 1 >= samples.size()) return std::nullopt;
  const Vec2 in = (samples[first - look] - samples[first]).normalized();
  const Vec2 out = (samples[last + look] - samples[last]).normalized();
  const Branch entry{samples[first], in, side * left_of(in)},
      exit{samples[last], out, -side * left_of(out)};
  // up is where both branches come from, seen from the tip
  const Vec2 up = -(in + out).normalized(), across = left_of(up);
  if (!up.allFinite() || up.dot(in) > -0.7 || up.dot(out) > -0.7) return std::nullopt;
  double tip = samples[first].dot(up);
  for (std::size_t k = first; k <= last; ++k) tip = std::max(tip, samples[k].dot(up));
  const auto level_with = [&](const Branch& branch, double level) -> Vec2 {
    return branch.place + (level - branch.place.dot(up)) / branch.away.dot(up) * branch.away;
  };
  const Vec2 a = level_with(entry, tip - radius), b = level_with(exit, tip - radius);
  if (std::abs((b - a).dot(across)) >= 2.0 * radius) return std::nullopt;
  const Vec2 center = 0.5 * (a + b);
  const auto before = entry.begin_of_arc(center, radius), after = exit.begin_of_arc(center, radius);
  if (!before || !after) return std::nullopt;
  const auto back = static_cast<std::size_t>(std::ceil(std::max(*before, 0.0) / step));
  const auto on = static_cast<std::size_t>(std::ceil(std::max(*after, 0.0) / step));
  if (back > first || last + on >= samples.size()) return std::nullopt;
  Bulb bulb{first - back, last + on, {}};
  if (!follows(entry, samples, first, bulb.from) || !follows(exit, samples, last, bulb.to))
    return std::nullopt;
  const Vec2 one = entry.arc_center(*before, radius), other = exit.arc_center(*after, radius);
  const Vec2 enters = 0.5 * (one + center), leaves = 0.5 * (other + center);
  bulb.points.push_back(samples[bulb.from]);
  append_arc(one, entry.place + *before * entry.away, enters, -side, bulb.points);
  append_arc(center, enters, leaves, side, bulb.points);
  append_arc(other, leaves, exit.place + *after * exit.away, -side, bulb.points);
  bulb.points.push_back(samples[bulb.to]);
  return bulb;
}

}  // namespace

bool open_turnarounds(double step, double turning_radius, std::vector<Vec2>& samples) {
  const double radius = kEase * turning_radius;
  bool any = false;
  for (std::size_t begin = 1; begin + 1 < samples.size();) {
    const auto reversal = find_reversal(samples, step, begin);
    if (!reversal) break;
    begin = reversal->last + 1;
    const auto bulb = make_bulb(samples, step, radius, *reversal);
    if (!bulb) continue;
    const Polyline line(bulb->points);
    const double each = line.length() / static_cast<double>(bulb->to - bulb->from);
    for (std::size_t k = bulb->from + 1; k < bulb->to; ++k)
      samples[k] = line.point_at(static_cast<double>(k - bulb->from) * each);
    begin = bulb->to;
    any = true;
  }
  return any;
}

}  // namespace sumogamma
