#include "model/way_round.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "geometry/rotation.h"

namespace sumogamma {

namespace {

constexpr double kWay = 3.0, kStep = 0.5;  // looked at [m]
constexpr double kClear = 0.15;            // kept to who stands [m]
constexpr double kCloser = 0.03;           // or from who is nearer than that [m]
constexpr double kStands = 0.3;            // [m/s]
constexpr double kBeyond = 0.3;            // the boundary of its room [m]

/// The box after `way` on an arc of the rear axle.
OrientedBox rolled(const AgentGeometry& agent, double axle, double curvature, double way) {
  const Vec2 turned = rotation(way * curvature);
  const Vec2 moved = curvature == 0.0 ? Vec2(way, 0.0) : way_on_arc(turned, curvature, axle);
  const Vec2 forward = from_body(turned, agent.forward);
  return {agent.position + from_body(moved, agent.forward) + agent.shift * forward, forward,
          agent.half};
}

/// Somebody who stands, and how near one may come to it [m].
struct Standing {
  OrientedBox body;
  double least = 0;
};

std::vector<Standing> standing_around(const Model& model, const Scene& scene,
                                      const TickGeometry& geometry, std::size_t row) {
  const AgentGeometry& own = geometry.agent[row];
  std::vector<Standing> found;
  geometry.grid.visit_within(own.position, kWay + own.radius + kFarthestCorner,
                             [&](std::size_t other, double) {
                               const AgentGeometry& their = geometry.agent[other];
                               if (other == row || their.speed > kStands || !their.is_box ||
                                   on_other_storey(model.road, scene, row, other))
                                 return;
                               const double now = separation(own.box(), their.box());
                               found.push_back({their.box(), std::min(kClear, now - kCloser)});
                             });
  return found;
}

}  // namespace

bool turns_back(const Vec2& forward, const Vec2& way, double turn) {
  constexpr double kAcross = 0.2;  // cosine
  return from_body(rotation(turn), forward).dot(way) < kAcross && turn * cross(forward, way) <= 0.0;
}

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

  const std::vector<Standing> standing = standing_around(model, scene, geometry, row);
  const auto is_free = [&](double share) {
    if (turns_back(own.forward, context.tangent, share * widest)) return false;
    for (double way = kStep; way <= kWay; way += kStep) {
      const OrientedBox box = rolled(own, type.rear_axle_to_center, share * sharpest, way);
      const double aside = cross(context.tangent, box.center - own.box().center);
      const double room = aside > 0.0 ? context.room_left : context.room_right;
      if (std::abs(aside) > std::max(room, 0.0) + kBeyond) return false;
      if (std::any_of(standing.begin(), standing.end(),
                      [&](const Standing& one) { return separation(box, one.body) <= one.least; }))
        return false;
    }
    return true;
  };
  const auto* const free = std::find_if(shares.begin(), shares.end(), is_free);
  if (free == shares.begin() || free == shares.end()) return std::nullopt;
  return *free * widest;
}

}  // namespace sumogamma
