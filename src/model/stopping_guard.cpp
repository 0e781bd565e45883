#include "model/stopping_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/random.h"
#include "base/units.h"
#include "geometry/rotation.h"
#include "model/preferred_velocity.h"
#include "model/way_round.h"

namespace sumogamma {

namespace {

// a body slower than this is held up, and creeps at most this fast [m/s]
constexpr double kCreep = 0.5;
// who may go slower than this doesn't creep [m/s]
constexpr double kLeastWish = 0.4;
// and one that is slower than this stands [m/s]
constexpr double kStill = 0.01;
// people shuffle without turning round, see tracking
constexpr double kShuffle = 0.28;       // [m/s]
constexpr double kShufflesAfter = 2.0;  // that they have stood [s]
// rounding: neither an overlap nor a smaller gap [m]
constexpr double kSame = 1e-6;
// on a road nobody comes closer than this: halving what is left, bodies touch in the end [m]
constexpr double kLeastGap = 0.01;
// bodies that overlap on a road may do so deeper by this a look [m]
constexpr double kHair = 2e-3;
// but no deeper than this [m]
constexpr double kDeepest = 0.05;

using Braking = StoppingGuard::Braking;

StoppingGuard::Pose pose_after(const Braking& body, double time) {
  const double braked = std::min(time, body.duration());
  const double way = (body.speed - 0.5 * body.deceleration * braked) * braked;
  const double turn = way * body.curvature;
  if (std::abs(turn) < 1e-3) return {body.position + way * body.direction, body.forward};
  const Vec2 turned = rotation(turn);
  return {body.position + from_body(way_on_arc(turned, body.curvature, body.axle), body.forward),
          from_body(turned, body.forward)};
}

Braking braking_now(const AgentGeometry& agent, const AgentType& type) {
  const Vec2 direction =
      agent.on_wheels ? agent.forward : Vec2(agent.velocity / std::max(agent.speed, 1e-9));
  return {agent.position,  agent.forward,           direction, agent.speed, type.max_deceleration,
          agent.curvature, type.rear_axle_to_center};
}

OrientedBox box_at(const StoppingGuard::Pose& pose, const AgentGeometry& agent) {
  return {pose.position + agent.shift * pose.forward, pose.forward, agent.half};
}

/// How far a box reaches along a direction, from the origin.
double reach_along(const OrientedBox& box, const Vec2& direction) {
  return box.center.dot(direction) + std::abs(box.forward.dot(direction)) * box.half.x() +
         std::abs(cross(box.forward, direction)) * box.half.y();
}

/// Separating axis of two boxes from a to b, and the gap along it.
double widest_gap(const OrientedBox& a, const OrientedBox& b, Vec2& axis) {
  double widest = -std::numeric_limits<double>::infinity();
  for (const Vec2& side : {a.forward, left_of(a.forward), b.forward, left_of(b.forward)}) {
    const Vec2 direction = side.dot(b.center - a.center) < 0 ? Vec2(-side) : side;
    const double gap = -reach_along(b, -direction) - reach_along(a, direction);
    if (gap <= widest) continue;
    widest = gap;
    axis = direction;
  }
  return widest;
}

double instant_of(double duration, std::size_t k) {
  return duration * static_cast<double>(k) / static_cast<double>(StoppingGuard::kInstants - 1);
}

}  // namespace

double StoppingGuard::gap_between(const Pose& own, const Pose& theirs, std::size_t other) const {
  const AgentGeometry &a = geometry_->agent[row_], &b = geometry_->agent[other];
  if (a.is_box && b.is_box) return separation(box_at(own, a), box_at(theirs, b));
  return -overlap_depth(place_polygon(scene_->footprint[row_].outline(), own.forward),
                        place_polygon(scene_->footprint[other].outline(), theirs.forward),
                        theirs.position - own.position);
}

void StoppingGuard::prepare(const Model& model, const Scene& scene, const TickGeometry& geometry,
                            std::size_t row, std::span<const std::uint32_t> near) {
  model_ = &model;
  scene_ = &scene;
  geometry_ = &geometry;
  row_ = row;
  near_ = near;
  looked_at_.setConstant(std::numeric_limits<double>::quiet_NaN());
  foes_.clear();
}

bool is_wedged(const Scene& scene, std::size_t row) { return scene.held[row].wedge_left > 0.0; }

void update_held(double dt, Scene& scene, std::size_t row) {
  constexpr double kStands = 0.3;                   // [m/s]
  constexpr double kPatience = 5.0, kLasts = 10.0;  // [s]
  constexpr double kNoGapPatience = 15.0;           // [s]
  const RoadContext& context = scene.context[row];
  Held& held = scene.held[row];
  held.standing = scene.velocity[row].norm() < kStands ? held.standing + dt : 0.0;
  // two who want to change into each other's lane at its end wait for each other
  const bool no_gap = context.reason == LimitReason::Merge && held.standing > kNoGapPatience;
  const bool may_go = context.allowed_speed > kLeastWish;
  const bool blocked = context.active && held.standing > 0.0 && (may_go || no_gap);
  // at a red light nobody beside can leave a gap: that is no time lost
  const double more = may_go || !context.at_red ? dt : 0.0;
  held.blocked = blocked ? held.blocked + more : 0.0;
  const double patience = no_gap ? kNoGapPatience : kPatience;
  held.wedge_left = held.blocked > patience ? kLasts : std::max(0.0, held.wedge_left - dt);
}

bool StoppingGuard::on_road() const { return scene_->context[row_].active; }

bool StoppingGuard::in_lane() const { return geometry_->agent[row_].on_wheels && on_road(); }

bool StoppingGuard::overlapping() const {
  return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t other) {
    return overlap_depth(*scene_, *geometry_, row_, other) > kSame;
  });
}

Braking StoppingGuard::braking_after(const Vec2& velocity) {
  const AgentGeometry& own = geometry_->agent[row_];
  const AgentType& type = type_of(model_->types, own.type);
  looked_at_ = velocity;
  next_ = advance_body(type, body_of(*scene_, row_), own.forward, velocity, model_->options.step);
  Braking braking;
  braking.position = next_.body.position;
  braking.forward = next_.forward;
  braking.speed = own.on_wheels ? next_.body.speed : next_.body.velocity.norm();
  braking.direction =
      own.on_wheels ? next_.forward : Vec2(next_.body.velocity / std::max(braking.speed, 1e-9));
  braking.deceleration = type.max_deceleration;
  braking.curvature = own.on_wheels ? next_.lock / type.wheelbase : 0.0;
  braking.axle = type.rear_axle_to_center;
  return braking;
}

StoppingGuard::Foe& StoppingGuard::foe_of(std::uint32_t other) {
  for (Foe& foe : foes_)
    if (foe.row == other) return foe;
  return foes_.emplace_back(look_closely(other));
}

StoppingGuard::Foe StoppingGuard::look_closely(std::uint32_t other) const {
  const AgentGeometry &own = geometry_->agent[row_], &their = geometry_->agent[other];
  Foe foe;
  foe.row = other;
  foe.overlaps = overlap_depth(*scene_, *geometry_, row_, other) > kSame;
  if (foe.overlaps && !on_road()) return foe;
  const double step = model_->options.step;
  Braking theirs = braking_now(their, type_of(model_->types, their.type));
  // nobody makes others brake; whoever goes the same way may
  if (!their.yields && their.velocity.dot(own.velocity) <= 0) theirs.deceleration = 1e-3;
  const double stop = own.speed / type_of(model_->types, own.type).max_deceleration;
  foe.duration = std::max(stop + step, their.yields ? theirs.duration() : 0.0);
  foe.free_way = model_->options.guard_margin + their.throttle_way;
  for (std::size_t k = 0; k < kInstants; ++k)
    foe.poses[k] = pose_after(theirs, step + instant_of(foe.duration, k));
  return foe;
}

const StoppingGuard::Room& StoppingGuard::room_at(Foe& foe, std::size_t instant) const {
  Room& room = foe.room[instant];
  if (room.known) return room;
  room.known = true;
  const AgentGeometry &own = geometry_->agent[row_], &their = geometry_->agent[foe.row];
  const Braking mine = braking_now(own, type_of(model_->types, own.type));
  const Pose now = pose_after(mine, model_->options.step + instant_of(foe.duration, instant));
  if (own.is_box && their.is_box) {
    const OrientedBox a = box_at(now, own), b = box_at(foe.poses[instant], their);
    room.gap = widest_gap(a, b, room.axis);
    room.middle = 0.5 * (reach_along(a, room.axis) - reach_along(b, -room.axis));
  } else {
    room.gap = gap_between(now, foe.poses[instant], foe.row);
  }
  return room;
}

bool StoppingGuard::clear_by_far(const OrientedBox& swept, std::uint32_t other) const {
  const AgentGeometry &own = geometry_->agent[row_], &their = geometry_->agent[other];
  if (!own.is_box || !their.is_box || !their.yields) return false;
  const double room = model_->options.guard_margin + their.throttle_way;
  return separation(swept, their.braking) >= room;
}

bool StoppingGuard::clear_at(Foe& foe, std::size_t instant, const Pose& pose) const {
  const AgentGeometry &own = geometry_->agent[row_], &their = geometry_->agent[foe.row];
  const double discs = own.radius + their.radius + foe.free_way;
  if ((pose.position - foe.poses[instant].position).squaredNorm() > discs * discs) return true;
  const double gap = gap_between(pose, foe.poses[instant], foe.row);
  if (gap >= foe.free_way) return true;
  const Room& room = room_at(foe, instant);
  // no closer than by braking now is as good as braking
  if (gap >= room.gap - kSame) return true;
  // deeper by a hair is what it takes to roll out of each other side by side
  if (foe.overlaps) return gap >= room.gap - kHair && gap > -kDeepest;
  // closer than the margin already: half of what is left may be used, so that bodies side by side
  // can turn apart
  const double least = in_lane() ? kLeastGap : 0.0;
  if (gap < std::max(least, std::min(model_->options.guard_margin, 0.5 * room.gap))) return false;
  return !own.is_box || reach_along(box_at(pose, own), room.axis) <= room.middle;
}

bool StoppingGuard::admits(const Vec2& velocity) {
  if (near_.empty()) return true;
  const AgentGeometry& own = geometry_->agent[row_];
  const Braking braking = braking_after(velocity);
  const double way = 0.5 * braking.speed * braking.duration();
  const OrientedBox swept = swept_box(own, braking.position, braking.forward, braking.direction,
                                      way, braking.curvature, braking.axle);
  for (const std::uint32_t other : near_) {
    if (clear_by_far(swept, other)) continue;
    // braking for who comes from behind helps nobody
    if (in_lane() && comes_from_behind(own, geometry_->agent[other])) continue;
    Foe& foe = foe_of(other);
    if (foe.overlaps && !on_road()) continue;
    for (std::size_t k = 0; k < kInstants; ++k)
      if (!clear_at(foe, k, pose_after(braking, instant_of(foe.duration, k)))) return false;
  }
  return true;
}

namespace {

/// A way to creep: turn [rad] from the heading (wheels) or the preferred direction (on foot), and
/// speed [m/s].
struct Creep {
  double turn = 0, speed = kCreep;
};

std::array<Creep, 3> wheeled_creeps(const AgentGeometry& own, const AgentType& type,
                                    double passing) {
  const double lock = std::tan(type.max_steering) * type.rear_axle_to_center / type.wheelbase;
  const double most = 0.999 * std::atan(std::max(lock, 0.2));
  // wheels that point somewhere already decide, so that it doesn't dither
  const double side = std::abs(own.curvature) > 0.02 ? std::copysign(1.0, own.curvature) : passing;
  return {Creep{side * most}, Creep{-side * most}, Creep{0.0}};
}

/// People shuffle aside to the passing side, or back, by a turn that every second is drawn anew
/// from id and time alone: this opens crowds in which everybody waits for everybody, however even
/// they are.
std::array<Creep, 3> walking_creeps(const Scene& scene, std::size_t row, double passing) {
  const auto second = static_cast<std::uint64_t>(scene.time);
  const double turn =
      passing * random_uniform(0, scene.id[row].value, second, Draw::Intention, 0.3, kPi);
  return {Creep{turn, kShuffle}, Creep{-turn, kShuffle}, Creep{0.0, kShuffle}};
}

/// Hardly a velocity: it has the wheels of a wedged vehicle turned to one side, then to the other,
/// so that a way out shows that only opens with them; those of others straight, so that the tail
/// doesn't swing into who is beside when it rolls off.
Vec2 turned_wheels(const Scene& scene, const AgentGeometry& own, std::size_t row) {
  constexpr double kTry = 2.0;                                // [s]
  constexpr std::array<double, 3> kTurns = {-0.5, 0.5, 0.0};  // [rad]
  if (!is_wedged(scene, row)) return 1e-5 * own.forward;
  const auto tries = static_cast<std::size_t>(scene.held[row].standing / kTry);
  return 1e-5 * from_body(rotation(kTurns[tries % kTurns.size()]), own.forward);
}

bool keeps(std::span<const HalfPlane> hard, const Vec2& velocity) {
  return std::all_of(hard.begin(), hard.end(),
                     [&](const HalfPlane& plane) { return slack(plane, velocity) >= 0; });
}

/// Of a wedged vehicle on a road, along the way round whoever stands there.
std::optional<Vec2> creep_along_way_round(StoppingGuard& guard, const Model& model,
                                          const Scene& scene, const TickGeometry& geometry,
                                          std::size_t row, const Vec2& preferred,
                                          std::span<const HalfPlane> hard) {
  const AgentGeometry& own = geometry.agent[row];
  if (!own.on_wheels || !own.is_box || !is_wedged(scene, row) || !scene.context[row].active ||
      preferred.norm() <= kLeastWish)
    return std::nullopt;
  const auto turn = way_round(model, scene, geometry, row, preferred);
  if (!turn) return std::nullopt;
  const Vec2 velocity =
      std::min(kCreep, preferred.norm()) * from_body(rotation(*turn), own.forward);
  if (!keeps(hard, velocity) || !guard.admits(velocity)) return std::nullopt;
  return velocity;
}

/// The first way to creep that the hard planes and the guard admit.
std::optional<Vec2> creep_round(StoppingGuard& guard, const Model& model, const Scene& scene,
                                const AgentGeometry& own, std::size_t row, const Vec2& preferred,
                                std::span<const HalfPlane> hard) {
  const double passing = model.options.keep_left ? 1.0 : -1.0;
  const Vec2 ahead = own.on_wheels ? own.forward : Vec2(preferred.normalized());
  const auto creeps = own.on_wheels
                          ? wheeled_creeps(own, type_of(model.types, own.type), passing)
                          : walking_creeps(scene, row, side_to_pass(model.options, scene, row));
  // on a road whoever is ahead is waited for: a vehicle that creeps out of its lane gets wedged
  const RoadContext& context = scene.context[row];
  const bool on_road = own.on_wheels && context.active;
  const bool in_lane = on_road && !is_wedged(scene, row);
  for (const Creep& creep : creeps) {
    if (in_lane && creep.turn != 0.0) continue;
    if (on_road && turns_back(own.forward, context.tangent, creep.turn)) continue;
    const double speed = std::min(creep.speed, preferred.norm());
    const Vec2 velocity = speed * from_body(rotation(creep.turn), ahead);
    if (keeps(hard, velocity) && guard.admits(velocity)) return velocity;
  }
  return std::nullopt;
}

}  // namespace

Vec2 guarded_velocity(StoppingGuard& guard, const Model& model, const Scene& scene,
                      const TickGeometry& geometry, std::size_t row, const Vec2& velocity,
                      const Vec2& preferred, std::span<const HalfPlane> hard) {
  const AgentGeometry& own = geometry.agent[row];
  const double asked = velocity.norm(), now = own.velocity.norm();
  const double brake = type_of(model.types, own.type).max_deceleration * model.options.step;
  if (const auto round = creep_along_way_round(guard, model, scene, geometry, row, preferred, hard))
    return *round;
  // a crowd sets off by small steps, each into the room that whoever is ahead has left: who
  // shuffles instead, to whatever side, is in the way of those behind
  const bool sets_off = !own.on_wheels && scene.held[row].standing < kShufflesAfter;
  const double slowest = sets_off ? kStill : 0.5 * kCreep;
  // as asked, or the same way but slower: no faster than now, braking by half, braking
  const bool stands = asked < slowest;
  if (!stands && guard.admits(velocity)) return velocity;
  const Vec2 along = asked > 1e-6 ? Vec2(velocity / asked) : Vec2(Vec2::Zero());
  for (const double speed : {now, now - 0.5 * brake, now - brake})
    if (!stands && speed < asked && speed >= slowest && guard.admits(speed * along))
      return speed * along;

  if (model.options.creep_when_held && !sets_off && preferred.norm() > kLeastWish &&
      now < 2.0 * kCreep && !guard.overlapping()) {
    const auto creep = creep_round(guard, model, scene, own, row, preferred, hard);
    if (creep) return *creep;
  }
  const bool may_go = preferred.norm() > kLeastWish && scene.context[row].active;
  if (own.on_wheels && now < kStill && (is_wedged(scene, row) || may_go)) {
    const Vec2 turned = turned_wheels(scene, own, row);
    if (guard.admits(turned)) return turned;
  }
  const Vec2 least = std::min(asked, std::max(now - brake, 0.01 * asked)) * along;
  for (const Vec2& last : {stands ? velocity : least, least})
    if (guard.admits(last)) return last;
  return Vec2::Zero();
}

}  // namespace sumogamma
