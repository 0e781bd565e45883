#include "study/safety/pair_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/closing.h"
#include "geometry/heading.h"
#include "geometry/rotation.h"
#include "geometry/segment.h"

namespace sumogamma {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kStraight = 1e-3;  // slower turns are none [rad/s]
constexpr double kTouch = 1e-3;     // [m]

ConvexPolygon outline_of(const MovingBody& body) {
  return place_polygon(body.footprint.outline(), rotation(body.heading));
}

PolygonDifference difference_of(const MovingBody& a, const MovingBody& b) {
  return minkowski_difference(outline_of(b), outline_of(a), b.position - a.position);
}

/// Is the origin in the outline, its edge included?
bool holds_origin(const PolygonDifference& polygon) {
  if (polygon.count < 3) return false;
  for (std::uint32_t k = 0; k < polygon.count; ++k)
    if (polygon.normals[k].dot(polygon.vertices[k]) < 0.0) return false;
  return true;
}

double distance_to_origin(const PolygonDifference& polygon) {
  if (holds_origin(polygon)) return 0.0;
  double least = kNever;
  for (std::uint32_t k = 0; k < polygon.count; ++k)
    least = std::min(
        least, distance_to_segment(polygon.vertices[k], polygon.vertices[(k + 1) % polygon.count],
                                   Vec2::Zero()));
  return least;
}

/// When a point that sets out from the origin is in the outline first: clipped against the
/// half-planes of its edges (Cyrus and Beck).
double time_to_enter(const PolygonDifference& polygon, const Vec2& velocity) {
  if (holds_origin(polygon)) return 0.0;
  double enters = 0.0, leaves = kNever;
  for (std::uint32_t k = 0; k < polygon.count; ++k) {
    const double height = polygon.normals[k].dot(polygon.vertices[k]);
    const double speed = polygon.normals[k].dot(velocity);
    if (speed == 0.0) {
      if (height < 0.0) return kNever;
    } else if (speed < 0.0) {
      enters = std::max(enters, height / speed);
    } else {
      leaves = std::min(leaves, height / speed);
    }
  }
  return enters <= leaves ? enters : kNever;
}

bool turns(const MovingBody& body) { return std::abs(body.turn_rate) >= kStraight; }

Vec2 velocity_after(const MovingBody& body, double time) {
  const Vec2 turned = rotation(body.turn_rate * time);
  return {turned.x() * body.velocity.x() - turned.y() * body.velocity.y(),
          turned.y() * body.velocity.x() + turned.x() * body.velocity.y()};
}

Vec2 position_after(const MovingBody& body, double time) {
  if (!turns(body)) return body.position + time * body.velocity;
  // integral of the turning velocity: its change, turned back by a right angle, over the rate
  const Vec2 change = velocity_after(body, time) - body.velocity;
  return body.position + Vec2(change.y(), -change.x()) / body.turn_rate;
}

/// How fast a body's velocity turns [m/s^2].
double change_of(const MovingBody& body) {
  return turns(body) ? body.velocity.norm() * std::abs(body.turn_rate) : 0.0;
}

/// How long two bodies stay apart by a gap at least [s], whatever they turn; `swing` [m/s]: of
/// their outlines' ends.
double time_apart(const MovingBody& a, const MovingBody& b, double gap, double swing) {
  return time_to_close(gap, (a.velocity - b.velocity).norm() + swing, change_of(a) + change_of(b));
}

/// When the circles around two outlines come so near that these could touch [s]; never where not
/// within the horizon, as of most pairs. Circles cost no polygons.
double time_to_circles(const MovingBody& a, const MovingBody& b, double horizon) {
  constexpr double kUnclear = 0.05, kLeastStep = 0.04;  // nearer circles tell nothing [m]
  const double reach = a.footprint.radius + b.footprint.radius + kUnclear;
  // straight ahead, give or take what their turning takes them aside
  const Vec2 offset = b.position - a.position, relative = a.velocity - b.velocity;
  const double square = relative.squaredNorm();
  const double nearest =
      square > 0.0 ? std::clamp(offset.dot(relative) / square, 0.0, horizon) : 0.0;
  const double aside = 0.5 * horizon * horizon * (change_of(a) + change_of(b));
  if ((offset - nearest * relative).norm() > reach + aside) return kNever;
  if (!turns(a) && !turns(b)) return 0.0;
  for (double time = 0; time <= horizon;) {
    const MovingBody one = moved(a, time), other = moved(b, time);
    const double apart = (other.position - one.position).norm() - reach;
    if (apart <= 0.0) return time;
    time += time_apart(one, other, std::max(apart, kLeastStep), 0.0);
  }
  return kNever;
}

/// `time`: before that they can't touch [s].
double time_on_arcs(const MovingBody& a, const MovingBody& b, double time, double horizon) {
  const double swing =
      a.footprint.radius * std::abs(a.turn_rate) + b.footprint.radius * std::abs(b.turn_rate);
  while (time <= horizon) {
    const MovingBody one = moved(a, time), other = moved(b, time);
    const double gap = outline_gap(one, other);
    if (gap <= kTouch) return time;
    time += time_apart(one, other, gap, swing);
  }
  return kNever;
}

}  // namespace

MovingBody moved(const MovingBody& body, double time) {
  MovingBody later = body;
  later.position = position_after(body, time);
  if (!turns(body)) return later;
  later.heading += body.turn_rate * time;
  later.velocity = velocity_after(body, time);
  return later;
}

double outline_gap(const MovingBody& a, const MovingBody& b) {
  return distance_to_origin(difference_of(a, b));
}

double time_to_collision(const MovingBody& a, const MovingBody& b, double horizon) {
  const double earliest = time_to_circles(a, b, horizon);
  if (earliest > horizon) return kNever;
  if (turns(a) || turns(b)) return time_on_arcs(a, b, earliest, horizon);
  // A moves against a B that stands
  const double time = time_to_enter(difference_of(a, b), a.velocity - b.velocity);
  return time <= horizon ? time : kNever;
}

double deceleration_to_avoid(double relative_speed, double time_to_collision) {
  if (!std::isfinite(time_to_collision)) return 0.0;
  return time_to_collision > 0.0 ? relative_speed / (2.0 * time_to_collision) : kNever;
}

double modified_deceleration_to_avoid(double relative_speed, double time_to_collision,
                                      double reaction) {
  if (!std::isfinite(time_to_collision)) return 0.0;
  return deceleration_to_avoid(relative_speed, std::max(time_to_collision - reaction, 0.0));
}

}  // namespace sumogamma
