#include "osm/repairs/bend_room.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"

namespace sumogamma::osm {
namespace {

constexpr double kReach = 8.7;      // [m] from a bus's rear axle to its nose
constexpr double kSpare = 0.3;      // [m] that a bus leaves of its lane to each side
constexpr double kLeast = 1.2;      // [m] that is worth moving a road for
constexpr double kMost = 2.5;       // [m]
constexpr double kWindow = 7.5;     // [m] to each side, over which a bend is measured
constexpr double kSlope = 1.0 / 6;  // [m] sideways per metre along

/// Direction of the line at a place along it [rad].
double direction_at(const RoadBody& body, double along) {
  const auto behind = std::upper_bound(body.along.begin() + 1, body.along.end() - 1, along);
  const auto i = static_cast<std::size_t>(behind - body.along.begin());
  return heading_of(body.points[i] - body.points[i - 1]);
}

/// Curvature about a point, to the left [1/m].
double curvature(const RoadBody& body, std::size_t i) {
  const double from = body.along[i] - kWindow, to = body.along[i] + kWindow;
  return wrap_angle(direction_at(body, to) - direction_at(body, from)) / (to - from);
}

/// Lets room begin and end no more sharply than it may, and before lanes end.
void fade(const RoadBody& body, std::vector<double>& room) {
  fade_out(body.along, kSlope, room);
  for (std::size_t i = 0; i < room.size(); ++i) {
    const double to_end = std::min(body.along[i] - body.from, body.to - body.along[i]);
    room[i] = std::min(room[i], std::max(0.0, to_end * kSlope));
  }
}

}  // namespace

BendRoom room_in_bends(const RoadBody& body, bool left_hand) {
  const std::size_t n = body.points.size();
  BendRoom room{std::vector<double>(n, 0.0), std::vector<double>(n, 0.0)};
  if (n < 3 || body.twin == kNoEdge || !body.drives) return room;
  // the edge that runs along the line lies to its right where traffic keeps right
  std::vector<double>&on_right = left_hand ? room.twin : room.edge,
  &on_left = left_hand ? room.edge : room.twin;
  for (std::size_t i = 0; i < n; ++i) {
    const double bend = curvature(body, i);
    const double needed = kReach * kReach * std::abs(bend) / 2 - kSpare;
    if (needed > kLeast) (bend > 0 ? on_right : on_left)[i] = std::min(needed, kMost);
  }
  fade(body, on_left);
  fade(body, on_right);
  for (double& move : on_right) move = -move;
  return room;
}

}  // namespace sumogamma::osm
