#include "model/geometric_constraints.h"

#include <algorithm>
#include <optional>

#include "model/attention.h"
#include "model/bending.h"
#include "model/velocity_obstacle.h"

namespace sumogamma {

namespace {

/// Horizon of a pair [s].
double pair_horizon(const ModelOptions& options, const AgentType& own, const AgentType& their) {
  switch (options.pair_horizon) {
    case PairHorizon::Own:
      return own.horizon;
    case PairHorizon::Longest:
      return std::max(own.horizon, their.horizon);
    case PairHorizon::Shortest:
      break;
  }
  return std::min(own.horizon, their.horizon);
}

constexpr double kAbreast = 0.85;  ///< cosine of the angle between two who drive the same way
constexpr double kLeader = 0.7;    ///< horizon towards who is followed [s]

/// Horizon of a pair on the road [s].
/// differs from the paper: who follows a lane bends with it, so that straight lines over the whole
/// horizon see collisions with oncoming traffic in every curve; leaders, signals and right of way
/// look far ahead instead (C). Avoidance is what is left: the near term. People on foot who look
/// far ahead on a full sidewalk meet face to face and stop, all of them; so they do round a bicycle
/// that stands among them.
double road_horizon(const RoadContext& context, const AgentGeometry& own,
                    const AgentGeometry& other, std::int64_t foe, double horizon) {
  constexpr double kLanes = kBendTime, kSidewalk = 1.2;
  constexpr double kCrawls = 1.0;  // whatever is no faster is walked round [m/s]
  if (!context.active) return horizon;
  if (!own.on_wheels && (!other.on_wheels || other.speed < kCrawls))
    return std::min(horizon, kSidewalk);
  if (own.on_wheels != other.on_wheels) return horizon;
  const bool leader = context.reason == LimitReason::Leader && context.foe == foe;
  return std::min(horizon, leader ? kLeader : kLanes);
}

/// The velocity that an agent would have if nobody were in its way [m/s]: onwards at the speed it
/// likes, on foot towards its sub-goal, however it has to turn and step aside now.
Vec2 intended_velocity(const Scene& scene, const AgentGeometry& agent, std::size_t row) {
  if (!agent.yields) return agent.velocity;
  const RoadContext& context = scene.context[row];
  double speed = scene.preferred_speed[row];
  if (context.active) speed = std::min({speed, context.speed_limit, context.allowed_speed});
  const Vec2 onwards = context.sub_goal - agent.position;
  const bool on_foot = context.active && !agent.on_wheels && onwards.squaredNorm() > 1e-6;
  return std::max(speed, 0.0) * (on_foot ? Vec2(onwards.normalized()) : agent.forward);
}

/// A row and one neighbour: all that their velocity obstacle depends on.
struct Pair {
  const Model& model;
  const Scene& scene;
  const TickGeometry& geometry;
  std::size_t row, other;
  Vec2 preferred;  ///< of the row [m/s]
  Vec2 intended;   ///< relative [m/s]
  double horizon;  ///< [s]

  const AgentGeometry& own() const { return geometry.agent[row]; }
  const AgentGeometry& their() const { return geometry.agent[other]; }
  /// Free way between the two at the least [m].
  double gap() const {
    return (their().position - own().position).norm() - own().radius - their().radius;
  }
  /// Mean velocity over the horizon of somebody who moves at `velocity` now.
  /// differs from the paper: a straight line at a steady speed sees collisions with whoever bends
  /// with its lane in every curve, and with whoever is about to halt before it gets there.
  Vec2 on_course(std::size_t who, const Vec2& velocity) const {
    constexpr double kClose = 1.0;  // where the next moment counts [m]
    constexpr double kFast = 6.0;   // bodies that crawl keep out of each other's way as they are
    const RoadContext& context = scene.context[who];
    if (!context.active || horizon <= kLeader) return velocity;
    if (own().on_wheels && their().on_wheels) {
      const bool abreast = own().forward.dot(their().forward) > kAbreast;
      const bool fast = std::max(own().speed, their().speed) > kFast;
      return fast && !abreast && gap() > kClose ? from_body(velocity, context.bend) : velocity;
    }
    const double way = velocity.norm() * horizon;
    const bool halts =
        own().on_wheels != their().on_wheels && way > context.to_halt && gap() > context.to_halt;
    return halts ? Vec2(velocity * (context.to_halt / way)) : velocity;
  }
  /// Do both bend with their paths, and stay apart as they do, at the present speed and at the one
  /// preferred? Bodies that turn take less room where the other comes by than the present outline
  /// moved along would.
  bool bend_past_each_other() const {
    constexpr double kClose = 0.5;    // where the next moment counts [m]
    constexpr double kCloseBy = 0.1;  // likewise of two who drive abreast [m]
    constexpr double kFast = 2.0;     // bodies that crawl keep out of each other's way as they are
    const RoadContext &here = scene.context[row], &there = scene.context[other];
    if (!here.active || !there.active || horizon <= kLeader || !own().on_wheels ||
        !their().on_wheels)
      return false;
    const bool abreast = own().forward.dot(their().forward) > kAbreast;
    if (!abreast && std::max(own().speed, their().speed) < kFast) return false;
    if (separation(own().guarded_box(), their().guarded_box()) < (abreast ? kCloseBy : kClose))
      return false;
    const Arc mine(own(), here.bend), theirs(their(), there.bend);
    return bend_past(mine, own().speed, theirs, their().speed, horizon) &&
           bend_past(mine, preferred.norm(), theirs, their().speed, horizon);
  }
  Vec2 their_velocity() const { return on_course(other, their().velocity); }
  Vec2 relative() const { return on_course(row, own().velocity) - their_velocity(); }
  /// How soon the two are to be apart [s].
  double separation_time() const {
    const ModelOptions& options = model.options;
    if (!own().on_wheels || !their().on_wheels) return options.walker_separation_time;
    return overlap_depth(scene, geometry, row, other) > 0 ? options.separation_time
                                                          : options.margin_time;
  }
};

Escape escape_from(const NearSide& near, const Pair& pair) {
  const PassingSide side = pair.model.options.keep_left ? PassingSide::Left : PassingSide::Right;
  // differs from the paper: the side on which to pass follows from where both want to go, so that
  // two who stand face to face go round each other instead of waiting
  if (pair.model.options.pass_as_intended)
    return intended_escape(near, pair.relative(), pair.intended, pair.horizon, side);
  return nearest_escape(near, pair.relative(), pair.horizon, side);
}

/// The pair's escape; none where its half-plane can't bind, because neither now nor as preferred
/// does the row come near within the horizon.
std::optional<Escape> escape_of(const Pair& pair) {
  if (pair.own().is_box && pair.their().is_box) {
    const BoxDifference difference(pair.their().guarded_box(), pair.own().guarded_box());
    const Vec2 preferred = pair.on_course(pair.row, pair.preferred) - pair.their_velocity();
    if (difference.stays_apart(pair.relative(), pair.horizon, kSideStep) &&
        difference.stays_apart(preferred, pair.horizon, kSideStep))
      return std::nullopt;
    if (pair.bend_past_each_other()) return std::nullopt;
    const NearSide near = difference.near_side();
    if (near.inside)
      return overlap_escape(difference.polygon(), pair.relative(), pair.separation_time());
    return escape_from(near, pair);
  }
  const PolygonDifference difference =
      minkowski_difference(guarded_polygon(pair.model, pair.scene, pair.geometry, pair.other),
                           guarded_polygon(pair.model, pair.scene, pair.geometry, pair.row),
                           pair.their().position - pair.own().position);
  const NearSide near = near_side(difference);
  if (near.inside) return overlap_escape(difference, pair.relative(), pair.separation_time());
  return escape_from(near, pair);
}

/// Of two narrow vehicles side by side the one whose middle is behind keeps apart: who is ahead
/// would else be pressed away from the gap that both make for.
bool falls_behind(const AgentGeometry& own, const AgentGeometry& their) {
  constexpr double kNarrow = 0.6, kBehind = 0.3;  // [m]
  return own.on_wheels && their.on_wheels && own.half.y() < kNarrow && their.half.y() < kNarrow &&
         their.forward.dot(own.forward) > 0.7 &&
         (their.position - own.position).dot(own.forward) < -kBehind;
}

}  // namespace

double responsibility_share(const Model& model, const Scene& scene, const TickGeometry& geometry,
                            std::size_t row, std::size_t other, const BehaviorState& behavior) {
  if (!model.options.share_responsibility) return behavior.responsibility;
  // SUMO's drivers and those who don't look this way do nothing for this pair
  const AgentGeometry& their = geometry.agent[other];
  if (!their.yields) return 1.0;
  if (!attends(their, geometry.agent[row], their.attention)) return 1.0;
  const double own = std::max(behavior.responsibility, 0.0);
  const double theirs = std::max(scene.behavior[other].responsibility, 0.0);
  return own + theirs > 0 ? own / (own + theirs) : 0.5;
}

void append_geometric_constraints(const Model& model, const Scene& scene,
                                  const TickGeometry& geometry, std::size_t row,
                                  const RowHypothesis& hypothesis,
                                  std::span<const Attended> attended, ConstraintSet& constraints) {
  const ModelOptions& options = model.options;
  if (!options.use_avoidance) return;
  const AgentGeometry& own = geometry.agent[row];
  const AgentType& type = type_of(model.types, own.type);
  const Vec2 intended = intended_velocity(scene, own, row);
  for (const Attended& neighbour : attended) {
    const std::size_t other = neighbour.row;
    const AgentGeometry& their = geometry.agent[other];
    // differs from the paper: on a road who follows keeps apart from who is ahead (see following)
    if (scene.context[row].active && (comes_from_behind(own, their) || falls_behind(own, their)))
      continue;
    const std::int64_t foe = scene.id[other].value;
    const double horizon =
        road_horizon(scene.context[row], own, their, foe,
                     pair_horizon(options, type, type_of(model.types, their.type)));
    const std::optional<Escape> escape =
        escape_of({model, scene, geometry, row, other, hypothesis.preferred,
                   intended - intended_velocity(scene, their, other), horizon});
    if (!escape) continue;
    // differs from the paper: a safe pair is held to its safety (as ORCA does) unless the option
    // says otherwise
    if (!escape->colliding && !options.constrain_safe_pairs) continue;
    const double share =
        responsibility_share(model, scene, geometry, row, other, hypothesis.behavior);
    constraints.append({own.velocity + share * escape->change, escape->normal},
                       {ConstraintKind::Neighbour, foe});
  }
}

}  // namespace sumogamma
