#include "sumo/entry.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

/// Nobody further along the path or further aside of it matters to who starts there [m].
constexpr double kAlong = 80.0, kAside = 30.0;

/// Who may start, where, and what it would like.
struct Newcomer {
  const Path& path;
  const AgentState& agent;
  const Ground& ground;
  const AgentType& type;
  bool on_foot;
  Vec2 direction;                  ///< of the path
  double half_length, half_width;  ///< [m]
  double gap;                      ///< that it keeps to others [m]
  double ease;                     ///< twice the deceleration at which it stops at ease [m/s^2]
  double wish;                     ///< speed, if nobody were there [m/s]
  OrientedBox wanted;              ///< room for the body now, and for what comes from behind
  OrientedBox alone;               ///< likewise for who comes from aside
};

/// The speed at which somebody can stop before the first line where it may have to.
double free_entry_speed(const Model& model, const Newcomer& one) {
  double speed = one.on_foot ? 0.0 : std::min(one.path.profile_at(0.0), one.agent.preferred_speed);
  for (const PathLink& link : one.path.links) {
    if (one.ease * link.stop_line > speed * speed + one.ease * (one.half_length + 1.0)) break;
    if (needs_care(model, link))
      speed = std::min(speed,
                       std::sqrt(one.ease * std::max(link.stop_line - one.half_length - 1.0, 0.0)));
  }
  return speed;
}

Newcomer newcomer_at(const Model& model, const Path& path, const AgentState& agent,
                     const Ground& ground, double most) {
  const AgentType& type = type_of(model.types, agent.type);
  const bool on_foot = type.kinematics == Kinematics::Holonomic;
  const Vec2 half(agent.footprint.vertices[0].x(), agent.footprint.vertices[1].y());
  const double gap = on_foot ? kCrowd : type.min_gap;
  const double ease = 2.0 * 0.7 * type.comfortable_deceleration;
  const Vec2 heading = direction_of(agent.heading), direction = path.line.direction_at(0.0);
  const OrientedBox wanted{agent.position, heading, half + Vec2(gap, on_foot ? 0.1 : 0.2)};
  Newcomer one{path,     agent, ground, type, on_foot, direction, half.x(),
               half.y(), gap,   ease,   0.0,  wanted,  wanted};
  one.wish = std::min(free_entry_speed(model, one), most);
  // whoever drives on for so long, beside who comes from aside, has nowhere to go [s]
  constexpr double kAlone = 1.0;
  const double way = on_foot ? 0.0 : kAlone * one.wish;
  one.alone.center += 0.5 * way * direction;
  one.alone.half.x() += 0.5 * way;
  return one;
}

/// What an agent that is there already means to who would start.
struct Bearing {
  bool bars = false;     ///< there is no room
  bool follows = false;  ///< it comes from behind, at `speed`, `gap` behind
  double allowed = std::numeric_limits<double>::infinity();  ///< behind it [m/s]
  double gap = 0, speed = 0;                                 ///< [m], [m/s]
};

/// Nor does anybody start before somebody who comes from aside or towards it, or on foot before who
/// drives.
bool comes_into_its_way(const EntryView& view, const Newcomer& one, std::size_t row,
                        const OrientedBox& body) {
  const Vec2& velocity = view.scene.velocity[row];
  const AgentType& kind = type_of(view.model.types, view.scene.type[row]);
  const bool drives = kind.kinematics != Kinematics::Holonomic;
  const bool from_aside = velocity.dot(one.direction) < kSameWay * velocity.norm();
  const bool comes_towards = velocity.dot(one.direction) < -0.5 * velocity.norm();
  return (one.on_foot ? drives : from_aside) &&
         comes_over(view.model, view.road, view.scene, row, body,
                    comes_towards ? one.wanted : one.alone);
}

Bearing bearing_of(const EntryView& view, const Newcomer& one, std::size_t row) {
  const Scene& scene = view.scene;
  const Vec2 relative = to_body(scene.position[row] - one.agent.position, one.direction);
  if (std::abs(relative.x()) > kAlong || std::abs(relative.y()) > kAside) return {};
  if (on_other_storey(view.model.road, one.ground, ground_of(scene, row))) return {};
  const OrientedBox other = box_of(scene, row);
  if (overlap(one.wanted, other)) return {.bars = true};
  if (comes_into_its_way(view, one, row, other)) return {.bars = true};
  if (one.on_foot) return {};
  // who is ahead and not quite in this lane may be on its way into it, and is if it says so
  const LaneId lane = one.path.stretches.front().lane;
  const bool comes_in = scene.lane[row].lane == lane || scene.context[row].merge_to == lane;
  const bool is_ahead = relative.x() > 0.0;
  const double aside = !is_ahead ? 0.3 : comes_in ? 3.5 : 0.7;
  // a long body ahead, amid a lane change, has its tail further aside than its middle
  const double across = is_ahead ? half_extent(scene, row, left_of(one.direction)) : other.half.y();
  if (std::abs(relative.y()) > one.half_width + across + aside)
    // who comes from behind out of a bend is beside the line straight back
    return {.bars = relative.x() < 0.0 &&
                    comes_over(view.model, view.road, scene, row, other, one.wanted)};
  const double ahead = scene.velocity[row].dot(one.direction);
  const double free =
      std::abs(relative.x()) - one.half_length - scene.footprint[row].radius - one.gap;
  if (!is_ahead) return {.follows = ahead > 0.1, .gap = free, .speed = ahead};
  // no faster than stops behind it at ease and than keeps most of its headway; where the gap is
  // opening, waiting a moment is better than to start slowly in front of others
  const double leader = std::max(ahead, 0.0);
  const double safe =
      std::min(std::sqrt(leader * leader + one.ease * std::max(free - 1.0, 0.0)),
               std::max(free, 0.0) / (0.6 * one.agent.manners.headway_factor * one.type.headway));
  return {.bars = safe < 0.8 * std::min(one.wish, leader), .allowed = safe};
}

}  // namespace

std::optional<double> entry_speed(const EntryView& view, const Path& path, const AgentState& agent,
                                  const Ground& ground, double most,
                                  std::optional<AgentId>& blocker) {
  const Scene& scene = view.scene;
  const Newcomer one = newcomer_at(view.model, path, agent, ground, most);
  if (blocker) {
    const std::size_t row = find_row(scene, *blocker);
    if (row < scene.size() && bearing_of(view, one, row).bars) return std::nullopt;
  }
  blocker.reset();
  struct Follower {
    std::size_t row;
    double gap, speed;
  };
  std::vector<Follower> followers;
  double speed = one.wish;
  const auto look_at = [&](std::size_t row) {
    if (blocker) return;
    const Bearing bearing = bearing_of(view, one, row);
    if (bearing.bars) blocker = scene.id[row];
    if (bearing.follows) followers.push_back({row, bearing.gap, bearing.speed});
    speed = std::min(speed, bearing.allowed);
  };
  view.grid.visit_within(agent.position, std::hypot(kAlong, kAside) + 1.0,
                         [&](std::uint32_t row, double) { look_at(row); });
  for (std::size_t row = view.grid.entries().size(); row < scene.size(); ++row) look_at(row);
  if (blocker) return std::nullopt;
  for (const Follower& other : followers) {
    const AgentType& kind = type_of(view.model.types, scene.type[other.row]);
    if (following_acceleration(kind, other.speed, std::max(other.speed, 5.0), other.gap + one.gap,
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
