#include "model/way_round.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/rotation.h"

namespace sumogamma {

namespace {

constexpr double kWay = 3.0, kStep = 0.5;  // looked at [m]
constexpr double kClear = 0.15;            // kept to who stands [m]
constexpr double kCloser = 0.03;           // or from who is nearer than that [m]
constexpr double kStands = 0.3;            // [m/s]
constexpr double kLargest = 12.0;          // from a body's position to its farthest corner [m]
constexpr double kBeyond = 0.3;            // the boundary of its room [m]

/// The box after `way` on an arc of the rear axle.
OrientedBox rolled(const AgentGeometry& agent, double axle, double curvature, double way) {
  const Vec2 turned = rotation(way * curvature);
  const Vec2 arc = std::abs(curvature) < 1e-6
                       ? Vec2(way, 0.0)
                       : Vec2(turned.y() / curvature, (1.0 - turned.x()) / curvature);
  const Vec2 forward = from_body(turned, agent.forward);
  const Vec2 centre = agent.position - axle * agent.forward + from_body(arc, agent.forward) +
                      (axle + agent.shift) * forward;
  return {centre, forward, agent.half};
}

}  // namespace

std::optional<double> way_round(const Model& model, const Scene& scene,
                                const TickGeometry& geometry, std::size_t row,
                                const Vec2& preferred) {
  const AgentGeometry& own = geometry.agent[row];
  const AgentType& type = type_of(model.types, own.type);
  const RoadContext& context = scene.context[row];
  const double sharpest = std::tan(type.max_steering) / type.wheelbase;
  const double widest = 0.999 * std::atan(std::max(sharpest * type.rear_axle_to_center, 0.2));
  const double wish = std::atan2(cross(own.forward, preferred), own.forward.dot(preferred));
  std::array<double, 5> shares = {0.0, 0.5, -0.5, 1.0, -1.0};
  std::sort(shares.begin(), shares.end(), [&](double a, double b) {
    return std::abs(a * widest - wish) < std::abs(b * widest - wish);
  });

  const auto is_free = [&](double share) {
    for (double way = kStep; way <= kWay; way += kStep) {
      const OrientedBox box = rolled(own, type.rear_axle_to_center, share * sharpest, way);
      const double aside = cross(context.tangent, box.center - own.box().center);
      const double room = aside > 0.0 ? context.room_left : context.room_right;
      if (std::abs(aside) > std::max(room, 0.0) + kBeyond) return false;
      bool clear = true;
      geometry.grid.visit_within(box.center, own.radius + kLargest, [&](std::size_t other, double) {
        const AgentGeometry& their = geometry.agent[other];
        if (!clear || other == row || their.speed > kStands || !their.is_box ||
            on_other_storey(model.road, scene, row, other))
          return;
        const OrientedBox body = their.box();
        clear = separation(box, body) > std::min(kClear, separation(own.box(), body) - kCloser);
      });
      if (!clear) return false;
    }
    return true;
  };
  const auto* const free = std::find_if(shares.begin(), shares.end(), is_free);
  if (free == shares.begin() || free == shares.end()) return std::nullopt;
  return *free * widest;
}

}  // namespace sumogamma
