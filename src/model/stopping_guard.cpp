#include "model/stopping_guard.h"

#include <algorithm>
#include <cmath>

#include "model/tracking.h"

namespace sumogamma {

namespace {

// instants at which two braking bodies are compared, from now until the later one stands
constexpr int kInstants = 3;

/// A body that holds its wheels and brakes.
struct Braking {
  Vec2 position, forward, direction;  ///< direction of motion, unit
  double speed, deceleration, curvature;
  double axle = 0;  ///< rear axle behind the position [m]

  double time() const { return speed / deceleration; }
};

struct Pose {
  Vec2 position, forward;
};

/// Where it is after braking for `time` [s].
Pose pose_after(const Braking& body, double time) {
  const double braked = std::min(time, body.time());
  const double way = (body.speed - 0.5 * body.deceleration * braked) * braked;
  const double turn = way * body.curvature;
  if (std::abs(turn) < 1e-3) return {body.position + way * body.direction, body.forward};
  const double c = std::cos(turn), s = std::sin(turn);
  const Vec2 forward = from_body({c, s}, body.forward);
  // arc of the rear axle, and the centre's swing about it
  const Vec2 arc = from_body({s / body.curvature, (1.0 - c) / body.curvature}, body.forward);
  return {body.position + arc + body.axle * (forward - body.forward), forward};
}

Braking braking_now(const AgentGeometry& agent, const AgentType& type) {
  const Vec2 direction =
      agent.on_wheels ? agent.forward : Vec2(agent.velocity / std::max(agent.speed, 1e-9));
  return {agent.position,  agent.forward,           direction, agent.speed, type.max_deceleration,
          agent.curvature, type.rear_axle_to_center};
}

/// Everything that one call asks about.
class Guard {
 public:
  Guard(const Model& model, const Scene& scene, const TickGeometry& geometry, std::size_t row,
        GuardScratch& scratch)
      : model_(model),
        scene_(scene),
        geometry_(geometry),
        row_(row),
        own_(geometry.agent[row]),
        type_(type_of(model.types, own_.type)),
        near_(scratch.near) {
    near_.clear();
    const double gained = type_.max_acceleration * model.options.step;
    // a tick at full acceleration adds at most this to the way to a stop
    const double more = std::min(gained, type_.max_speed) *
                            (model.options.step + own_.speed / type_.max_deceleration) +
                        0.1;
    const double reach = own_.reach + std::min(more, 5.0);
    geometry.grid.visit_within(own_.position, reach + largest_reach(),
                               [&](std::uint32_t other, double square) {
                                 if (other == row) return;
                                 const double both = reach + geometry.agent[other].reach;
                                 if (square <= both * both && !overlapping(other))
                                   near_.push_back(other);
                               });
  }

  bool has_neighbours() const { return !near_.empty(); }

  bool admits(const Vec2& velocity) const {
    const BodyState next =
        advance_body(type_, body_of(scene_, row_), velocity, model_.options.step);
    Braking own;
    own.position = next.position;
    own.forward = direction_of(next.heading);
    own.speed = own_.on_wheels ? next.speed : next.velocity.norm();
    own.direction = own_.on_wheels ? own.forward : Vec2(next.velocity / std::max(own.speed, 1e-9));
    own.deceleration = type_.max_deceleration;
    own.curvature = own_.on_wheels ? std::tan(next.steering) / type_.wheelbase : 0.0;
    own.axle = type_.rear_axle_to_center;
    for (std::uint32_t other : near_)
      if (!clear_of(own, other)) return false;
    return true;
  }

 private:
  double largest_reach() const { return geometry_.largest_reach; }

  bool overlapping(std::uint32_t other) const {
    return overlap_depth(scene_, geometry_, row_, other) > 0;
  }

  double gap(const Pose& own, const Pose& theirs, std::uint32_t other) const {
    const AgentGeometry& their = geometry_.agent[other];
    if (own_.is_box && their.is_box)
      return separation(
          {own.position + own_.shift * own.forward, own.forward, own_.half},
          {theirs.position + their.shift * theirs.forward, theirs.forward, their.half});
    return -overlap_depth(place_polygon(scene_.footprint[row_].outline(), own.forward),
                          place_polygon(scene_.footprint[other].outline(), theirs.forward),
                          theirs.position - own.position);
  }

  bool clear_of(const Braking& own, std::uint32_t other) const {
    const AgentGeometry& their = geometry_.agent[other];
    const Braking theirs = braking_now(their, type_of(model_.types, their.type));
    const double margin = model_.options.guard_margin;
    const double stop = std::max(own.time(), theirs.time() - model_.options.step);
    const double discs = own_.radius + their.radius;
    double least_allowed = margin;
    for (int k = 0; k <= kInstants; ++k) {
      const double time = stop * k / kInstants;
      const Pose mine = pose_after(own, time),
                 yours = pose_after(theirs, time + model_.options.step);
      if ((mine.position - yours.position).squaredNorm() > discs * discs) continue;
      const double room = gap(mine, yours, other);
      if (room >= margin) continue;
      // closer than the margin already: part of what is left may be used, so that bodies side by side can turn apart
      if (least_allowed == margin)
        least_allowed = std::min(margin, 0.5 * gap({own_.position, own_.forward},
                                                   {their.position, their.forward}, other));
      if (room < least_allowed) return false;
    }
    return true;
  }

  const Model& model_;
  const Scene& scene_;
  const TickGeometry& geometry_;
  std::size_t row_;
  const AgentGeometry& own_;
  const AgentType& type_;
  std::vector<std::uint32_t>& near_;
};

}  // namespace

Vec2 guarded_velocity(const Model& model, const Scene& scene, const TickGeometry& geometry,
                      std::size_t row, const Vec2& velocity, GuardScratch& scratch) {
  const Guard guard(model, scene, geometry, row, scratch);
  if (!guard.has_neighbours() || guard.admits(velocity)) return velocity;
  const AgentGeometry& own = geometry.agent[row];
  const AgentType& type = type_of(model.types, own.type);
  const double asked = velocity.norm(), now = own.velocity.norm();
  const double brake = std::min(type.max_deceleration * model.options.step, now);
  if (asked > 1e-6) {
    // the same way, but slower: no faster than now, braking by half, braking
    const Vec2 along = velocity / asked;
    if (asked > now && guard.admits(along * now)) return along * now;
    for (double speed : {now - 0.5 * brake, now - brake}) {
      const Vec2 slower = along * std::max(std::min(asked, speed), 0.01);
      if (guard.admits(slower)) return slower;
    }
  }
  const Vec2 straight = 0.001 * own.forward;
  return guard.admits(straight) ? straight : Vec2(Vec2::Zero());
}

}  // namespace sumogamma
