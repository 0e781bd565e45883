#pragma once

#include "geometry/vec2.h"

namespace sumogamma {

/// A heading [rad] that keeps the unit vector along it: it is asked for far more often than it
/// changes.
class Heading {
 public:
  Heading() = default;
  Heading(double angle) : angle_(angle), direction_(sumogamma::direction_of(angle)) {}
  operator double() const { return angle_; }

  friend const Vec2& direction_of(const Heading& heading) { return heading.direction_; }

 private:
  double angle_ = 0.0;
  Vec2 direction_ = Vec2(1.0, 0.0);
};

}  // namespace sumogamma
