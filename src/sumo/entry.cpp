#include "sumo/entry.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "geometry/oriented_box.h"
#include "geometry/rotation.h"
#include "model/obstacle_constraints.h"
#include "scene/extent.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

bool overlap(const OrientedBox& a, const OrientedBox& b) { return separation(a, b) <= 0.0; }

/// Does somebody drive over `place` until it stands, if it brakes at ease after half a second? On
/// its path, straight on where it has none or points elsewhere. `body`: its own, now.
bool comes_over(const Model& model, const RoadState& road, const Scene& scene, std::size_t row,
                const OrientedBox& body, const OrientedBox& place) {
  constexpr double kReaction = 0.5;  // [s]
  constexpr double kStep = 1.0;      // [m]
  constexpr double kAligned = 0.9;   // cosine to its path
  const double speed = scene.velocity[row].norm();
  const AgentType& type = type_of(model.types, scene.type[row]);
  const double way = speed * (kReaction + 0.5 * speed / type.comfortable_deceleration);
  const Path* path = road.path(scene.path[row]);
  const double begin = scene.path_along[row];
  const Vec2 aside = path ? Vec2(body.center - path->line.point_at(begin)) : Vec2(0, 0);
  // most are too far away to get there, however their path bends
  constexpr double kRounding = 1e-6;  // [m]
  const double reach = way + 2.0 * aside.norm() + place.half.norm() + body.half.norm() + kRounding;
  if ((place.center - body.center).norm() > reach) return false;
  const bool follows = path && path->line.direction_at(begin).dot(body.forward) > kAligned;
  const auto goes_straight_on_over_it = [&](double by) {
    return overlap(place, {body.center + 0.5 * by * body.forward, body.forward,
                           body.half + Vec2(0.5 * by, 0)});
  };
  if (!follows) return goes_straight_on_over_it(way);
  // in a bend bodies turn later than their ways
  if (goes_straight_on_over_it(kReaction * speed)) return true;
  const double offset = aside.dot(left_of(path->line.direction_at(begin)));
  // no faster than this does a body come nearer, be it outside in a bend [m for a step]
  constexpr double kNearer = 2.0 * kStep;
  for (double along = begin + kStep; along < begin + way; along += kStep) {
    const Vec2 forward = path->line.direction_at(along);
    const Vec2 center = path->line.point_at(along) + offset * left_of(forward);
    const double apart = (center - place.center).norm() - place.half.norm() - body.half.norm();
    if (apart > kNearer)
      along += kStep * (std::floor(apart / kNearer) - 1.0);
    else if (overlap(place, {center, forward, body.half}))
      return true;
  }
  return false;
}

/// May somebody have to be waited for at this link?
bool needs_care(const Model& model, const PathLink& link) {
  if (model.road.connection(link.connection).signal != kNoSignal) return true;
  const auto& zones = model.conflicts[index_of(link.connection)];
  return std::any_of(zones.begin(), zones.end(),
                     [](const ConflictZone& zone) { return zone.yields || zone.foe_is_crossing; });
}

// cosine from which somebody goes the same way
constexpr double kSameWay = 0.95;

/// Least gap to others with which people start in a crowd [m].
constexpr double kCrowd = 0.15;

}  // namespace

std::optional<double> entry_speed(const Model& model, const Path& path, const AgentState& agent,
                                  const Ground& ground, const RoadState& road, const Scene& scene) {
  const AgentType& type = type_of(model.types, agent.type);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  const Vec2 direction = path.line.direction_at(0.0);
  const double half_length = agent.footprint.vertices[0].x(),
               half_width = agent.footprint.vertices[1].y();
  // room for the body now, and for what comes from behind and goes ahead
  const double gap = on_foot ? kCrowd : type.min_gap;
  const double ease = 2.0 * 0.7 * type.comfortable_deceleration;
  const Vec2 heading = direction_of(agent.heading);
  const OrientedBox wanted{agent.position, heading,
                           Vec2(half_length + gap, half_width + (on_foot ? 0.1 : 0.2))};
  double speed = on_foot ? 0.0 : std::min(path.profile_at(0.0), agent.preferred_speed);
  for (const PathLink& link : path.links) {
    if (ease * link.stop_line > speed * speed + ease * (half_length + 1.0)) break;
    if (needs_care(model, link))
      speed = std::min(speed, std::sqrt(ease * std::max(link.stop_line - half_length - 1.0, 0.0)));
  }
  const double wish = speed;
  // whoever drives on for so long, beside who comes from aside, has nowhere to go [s]
  constexpr double kAlone = 1.0;
  const double way = on_foot ? 0.0 : kAlone * wish;
  const OrientedBox alone{agent.position + 0.5 * way * direction, heading,
                          wanted.half + Vec2(0.5 * way, 0)};
  struct Follower {
    std::size_t row;
    double gap, speed;
  };
  std::vector<Follower> followers;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Vec2 relative = to_body(scene.position[row] - agent.position, direction);
    if (std::abs(relative.x()) > 80.0 || std::abs(relative.y()) > 30.0) continue;
    if (on_other_storey(model.road, ground, ground_of(scene, row))) continue;
    const OrientedBox other = box_of(scene, row);
    if (overlap(wanted, other)) return std::nullopt;
    // nor does anybody start before somebody who comes from aside or towards it, or on foot before
    // who drives
    const Vec2 velocity = scene.velocity[row];
    const AgentType& kind = type_of(model.types, scene.type[row]);
    const bool drives = kind.kinematics != Kinematics::Holonomic;
    const bool from_aside = velocity.dot(direction) < kSameWay * velocity.norm();
    const bool comes_towards = velocity.dot(direction) < -0.5 * velocity.norm();
    if ((on_foot ? drives : from_aside) &&
        comes_over(model, road, scene, row, other, comes_towards ? wanted : alone))
      return std::nullopt;
    // who is ahead and not quite in this lane may be on its way into it, and is if it says so
    const LaneId lane = path.stretches.front().lane;
    const bool comes_in = scene.lane[row].lane == lane || scene.context[row].merge_to == lane;
    const double aside = relative.x() <= 0.0 ? 0.3 : comes_in ? 3.5 : 0.7;
    if (on_foot) continue;
    // a long body ahead, amid a lane change, has its tail further aside than its middle
    const double across =
        relative.x() > 0.0 ? half_extent(scene, row, left_of(direction)) : other.half.y();
    if (std::abs(relative.y()) > half_width + across + aside) {
      // who comes from behind out of a bend is beside the line straight back
      if (relative.x() < 0.0 && comes_over(model, road, scene, row, other, wanted))
        return std::nullopt;
      continue;
    }
    const double ahead = scene.velocity[row].dot(direction);
    const double free = std::abs(relative.x()) - half_length - scene.footprint[row].radius - gap;
    if (relative.x() > 0.0) {
      // no faster than stops behind it at ease and than keeps most of its headway; where the gap is
      // opening, waiting a moment is better than to start slowly in front of others
      const double leader = std::max(ahead, 0.0);
      const double safe =
          std::min(std::sqrt(leader * leader + ease * std::max(free - 1.0, 0.0)),
                   std::max(free, 0.0) / (0.6 * agent.manners.headway_factor * type.headway));
      if (safe < 0.8 * std::min(wish, leader)) return std::nullopt;
      speed = std::min(speed, safe);
    } else if (ahead > 0.1) {
      followers.push_back({row, free, ahead});
    }
  }
  for (const Follower& other : followers) {
    const AgentType& kind = type_of(model.types, scene.type[other.row]);
    if (following_acceleration(kind, other.speed, std::max(other.speed, 5.0), other.gap + gap,
                               speed) < -kind.comfortable_deceleration)
      return std::nullopt;
  }
  return speed;
}

std::vector<double> entry_offsets(double liked, double most_right, double most_left) {
  constexpr double kStep = 0.25;  // [m]
  std::vector<double> offsets{liked};
  for (const int step : {1, -1, 2, -2, 3, -3, 4, -4}) {
    const double offset = liked + kStep * step;
    if (offset * liked > 0.0 && offset >= most_right && offset <= most_left)
      offsets.push_back(offset);
  }
  return offsets;
}

bool is_walled_off(const Model& model, const AgentState& agent, const Vec2& middle) {
  if (model.obstacles.empty()) return false;
  if (model.obstacles.is_between(middle, agent.position)) return true;
  const ConvexPolygon outline =
      place_polygon(agent.footprint.outline(), direction_of(agent.heading));
  std::vector<std::uint32_t> found;
  model.obstacles.find_near(agent.position, agent.footprint.radius, found);
  return std::any_of(found.begin(), found.end(), [&](std::uint32_t index) {
    const ObstacleIndex::Side& side = model.obstacles.side(index);
    return clearance(outline, side.from - agent.position, side.to - agent.position).distance <= 0.0;
  });
}

}  // namespace sumogamma
