#include "scene/footprint.h"

namespace sumogamma {

Footprint box_footprint(double length, double width) {
  const double x = 0.5 * length, y = 0.5 * width;
  Footprint box;
  box.vertices[0] = {x, -y};
  box.vertices[1] = {x, y};
  box.vertices[2] = {-x, y};
  box.vertices[3] = {-x, -y};
  box.count = 4;
  box.radius = std::hypot(x, y);
  return box;
}

}  // namespace sumogamma
