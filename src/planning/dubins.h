#pragma once

#include <array>

#include "planning/wheeled_pose.h"

namespace sumogamma {

/// The shortest way of a body that only rolls forwards and turns no tighter than a radius: three
/// arcs or straight pieces (L. E. Dubins, 1957).
struct DubinsWay {
  struct Piece {
    double length = 0;     ///< [m]
    double curvature = 0;  ///< [1/m], positive left, 0 straight
  };
  std::array<Piece, 3> pieces{};

  double length() const { return pieces[0].length + pieces[1].length + pieces[2].length; }
};

/// Between two poses; `radius` [m] > 0. There always is one.
DubinsWay dubins_way(const AxlePose& from, const AxlePose& to, double radius);

}  // namespace sumogamma
