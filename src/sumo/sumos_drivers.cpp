// SUMO's drivers don't see ghosts: what would have them drive into one is kept from them by us, by
// speed, by lane changes and at their insertion (docs/coupling.md).

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/units.h"
#include "scene/extent.h"
#include "scene/locate.h"
#include "sumo/sumo_world.h"

namespace sumogamma {

namespace {

constexpr double kStorey = 2.5;  ///< bodies further apart in height don't meet [m]
constexpr double kForever = std::numeric_limits<double>::infinity();

/// What a body needs about it.
struct Margins {
  double beside, apart;  ///< to its sides, and to whoever is ahead or behind [m]
  double time,
      braking;  ///< of whoever closes in on the other, before and when it brakes [s, m/s^2]
};

/// Does a row leave a body at `speed` [m/s] room: is it beside its lane, or far enough ahead or
/// behind for the one who closes in on the other?
bool leaves_room(const Scene& scene, std::size_t row, const OrientedBox& body, double speed,
                 const Margins& margins) {
  const Vec2 left = left_of(body.forward);
  const Vec2 way = scene.position[row] - body.center;
  const double across = std::abs(way.dot(left)) - half_extent(scene, row, left) - body.half.y();
  if (across > margins.beside) return true;
  const double ahead = way.dot(body.forward);
  const double gap = std::abs(ahead) - half_extent(scene, row, body.forward) - body.half.x();
  const double theirs = scene.velocity[row].dot(body.forward);
  const double closing = std::max(ahead > 0.0 ? speed - theirs : theirs - speed, 0.0);
  return gap >=
         margins.apart + margins.time * closing + closing * closing / (2.0 * margins.braking);
}

/// Is a ghost in the way of a body that jumps sideways by `aside` [m, left positive], as SUMO's
/// lane changes do? Beside it, or so near that whoever is behind would have to brake hard.
bool bars_change(const Scene& scene, std::size_t row, std::size_t ghost, double aside) {
  constexpr Margins kMargins{0.3, 1.5, 1.2, 3.0};
  OrientedBox body = box_of(scene, row);
  body.center += aside * left_of(body.forward);
  return !leaves_room(scene, ghost, body, scene.speed[row], kMargins);
}

/// Would a body at `speed` [m/s] be in nobody's way there, and nobody in its? Whom `counts` names
/// not doesn't count.
template <typename Counts>
bool has_room(const Scene& scene, const SpatialGrid& grid, const OrientedBox& body, double height,
              double speed, Counts counts) {
  constexpr double kAround = 60.0;  // [m]
  constexpr Margins kMargins{0.2, 1.0, 0.4, 3.5};
  bool room = true;
  grid.visit_within(body.center, kAround, [&](std::uint32_t row, double) {
    room = room && (!counts(row) || std::abs(scene.height[row] - height) > kStorey ||
                    leaves_room(scene, row, body, speed, kMargins));
  });
  return room;
}

}  // namespace

/// Has a vehicle room about it, at its speed?
bool SumoWorld::has_room_for(const Scene& scene, std::size_t row) const {
  return has_room(scene, ghosts_, box_of(scene, row), scene.height[row], scene.speed[row],
                  [&](std::uint32_t other) { return other != row; });
}

/// Has SUMO inserted a vehicle into the way of a ghost, or over it? Then it waits off the map until
/// there is room.
bool SumoWorld::delay_insertion(const SumoAgent& seen, Pending& pending, const Scene& scene) {
  if (seen.is_person || !options_.control.any() || pending.resumes || pending.was_delayed ||
      stop_state::stopped(seen.stop_state))
    return false;
  const auto lane = model_.road.lane_by_name.find(seen.lane);
  if (lane == model_.road.lane_by_name.end()) return false;
  Delayed delayed;
  delayed.front = seen.position;
  delayed.angle = seen.angle;
  delayed.speed = seen.speed;
  delayed.lane = lane->second;
  if (fits(delayed, pending.details, delayed.speed, scene, true)) return false;
  backend_.unwatch(seen.id, false);
  backend_.take_over(seen.id, 0.0);
  delayed.pending = std::move(pending);
  delayed.pending.was_delayed = true;
  delayed_.push_back(std::move(delayed));
  ++life_cycle_.insertions_delayed;
  return true;
}

bool SumoWorld::fits(const Delayed& delayed, const SumoAgentDetails& details, double speed,
                     const Scene& scene, bool ghosts_only) const {
  const Lane& lane = model_.road.lane(delayed.lane);
  const Vec2 forward = direction_of(heading_from_sumo(delayed.angle));
  const OrientedBox body{delayed.front - 0.5 * details.length * forward, forward,
                         Vec2(0.5 * details.length, 0.5 * details.width)};
  const double height = elevation_at(lane, lane.centerline.project(delayed.front).along);
  return has_room(scene, ghosts_, body, height, speed, [&](std::uint32_t row) {
    return !ghosts_only || scene.control[row] == Control::Gamma;
  });
}

/// SUMO goes on with those for whom there is room now.
void SumoWorld::insert_delayed(const Scene& scene) {
  if (delayed_.empty()) return;
  ghosts_.rebuild(scene.position);
  std::set<LaneId> taken;  // one a lane and step
  std::erase_if(delayed_, [&](Delayed& delayed) {
    const SumoAgentDetails& details = delayed.pending.details;
    if (taken.contains(delayed.lane)) return false;
    double speed = delayed.speed;
    if (!fits(delayed, details, speed, scene, false)) speed = 0.0;
    if (!fits(delayed, details, speed, scene, false)) return false;
    taken.insert(delayed.lane);
    const SumoPose pose{&details.id, delayed.front, delayed.angle};
    backend_.put_on_lane(pose, model_.road.lane(delayed.lane).name, speed);
    backend_.release(details.id);
    backend_.watch(details.id, false);
    external_arriving_.insert_or_assign({false, details.id}, std::move(delayed.pending));
    return true;
  });
}

/// Which link each lane inside a junction is a piece of.
void SumoWorld::read_links() {
  link_pieces_.resize(model_.road.lanes.size());
  for (std::size_t i = 0; i < model_.road.connections.size(); ++i) {
    const Connection& connection = model_.road.connections[i];
    if (connection.from == kNoLane || model_.road.lane(connection.from).kind != LaneKind::Normal)
      continue;
    double before = 0.0;
    for (LaneId lane = connection.via; lane != kNoLane;) {
      LinkPiece& piece = link_pieces_[index_of(lane)];
      if (piece.link != kNoConnection) break;
      piece = {static_cast<ConnectionId>(i), before};
      before += model_.road.lane(lane).centerline.length();
      LaneId next = kNoLane;
      for (const ConnectionId onward : model_.road.lane(lane).outgoing)
        if (model_.road.connection(onward).to == connection.to)
          next = model_.road.connection(onward).via;
      lane = next;
    }
  }
}

/// The path of a vehicle that SUMO drives is that of the lane on which SUMO has it: where SUMO has
/// changed lanes, or not yet where the path does, another one.
void SumoWorld::follow_lane(const SumoAgent& seen, AgentId id, std::size_t row, Scene& scene,
                            RoadState& road) {
  constexpr double kBack = 20.0;  // [m]
  constexpr double kNear = 2.0;   // [m]
  constexpr double kAgain = 1.0;  // between two looks at the same lane [s]
  Known& known = known_[id.value];
  const bool same = seen.lane == known.lane_name;
  if (!same) {
    known.lane_name = seen.lane;
    const auto found = model_.road.lane_by_name.find(seen.lane);
    known.lane = found == model_.road.lane_by_name.end() ? kNoLane : found->second;
  }
  const Path* path = road.path(scene.path[row]);
  if (path == nullptr || !path->trip || known.lane == kNoLane) return;
  double along = scene.path_along[row];
  // at a lane's end the two may disagree for a step: a path made anew there would have lost what
  // the tail is still on
  const auto is_there = [&](double by) {
    const PathStretch& here = path->stretch_at(along + 0.5 * known.length + by);
    return here.lane == known.lane && !here.changing;
  };
  if (is_there(0.0) || is_there(-kNear) || is_there(kNear)) return;
  if (same && time_ < known.looked_at + kAgain) return;
  known.looked_at = time_;
  const Lane& lane = model_.road.lane(known.lane);
  double on_lane = lane.centerline.project(scene.position[row]).along;
  LaneId from = known.lane;
  const LinkPiece& piece = link_pieces_[index_of(known.lane)];
  if (piece.link != kNoConnection) {
    from = model_.road.connection(piece.link).from;
    on_lane = model_.road.lane(from).centerline.length() + piece.before +
              lane.centerline.project(seen.position).along - 0.5 * known.length;
  } else if (lane.kind != LaneKind::Normal) {
    return;
  }
  auto other = go_on_from(model_.road, *path, along, from, piece.link, on_lane, kBack);
  if (!other) return;
  scene.path_along[row] = along;
  scene.halt[row].next = 0;
  road.paths[id.value] = std::make_shared<const Path>(std::move(*other));
}

/// Nobody whom SUMO moves is faster than ghosts on its way allow, or changes into a lane where one
/// is. Where there is none near it is given back to SUMO.
void SumoWorld::hold_drivers(const Scene& scene) {
  constexpr double kNear = 12.0, kSight = 3.0;  // [m], [s]
  constexpr double kPatience = 30.0;            // [s]
  // for 0 SUMO finds a person no way over the next junction
  constexpr double kSlowest = 0.01;  // [m/s]
  if (std::find(scene.control.begin(), scene.control.end(), Control::External) ==
      scene.control.end())
    return;
  ghosts_.rebuild(scene.position);
  std::vector<std::uint32_t> near;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    if (scene.control[row] != Control::External) continue;
    Known& known = known_[scene.id[row].value];
    near.clear();
    ghosts_.visit_within(scene.position[row],
                         kNear + 0.5 * known.length + kSight * scene.speed[row],
                         [&](std::uint32_t other, double) {
                           if (scene.control[other] == Control::Gamma) near.push_back(other);
                         });
    const RoadContext& context = scene.context[row];
    const std::size_t foe = foe_row(scene, row);
    const bool aside = !known.is_person && overtakes(scene, row);
    const bool bound = !known.is_person && !aside && foe < scene.size() &&
                       scene.control[foe] == Control::Gamma &&
                       context.allowed_speed < scene.speed[row] + 1.0;
    double most = bound ? context.allowed_speed : kForever;
    // where both have waited for long, SUMO's driver goes as if there were nobody
    if (!near.empty() && scene.held[row].standing < kPatience)
      most = std::min(most, free_speed(scene, row, near, aside));
    if (most < kForever)
      backend_.set_speed(known.sumo_id, known.is_person,
                         known.is_person ? std::max(most, kSlowest) : most);
    else if (known.speed_held)
      backend_.set_speed(known.sumo_id, known.is_person, -1.0);
    known.speed_held = most < kForever;
    if (known.is_person) continue;
    if (!aside) hold_overtaking(scene, row);
    // who overtakes has to get back
    const bool barred = time_ < known.keeps_lane_until || (!aside && is_barred(scene, row, near));
    if (barred != known.lane_held) backend_.allow_lane_changes(known.sumo_id, !barred);
    known.lane_held = barred;
  }
}

/// At which somebody whom SUMO moves can still brake for a ghost that its body, as that follows its
/// path, would reach, one that stands, or nearly, or goes the same way: infinite where none is in
/// the way [m/s]. The road's rules know lanes; bodies reach over them, and SUMO may mean to pass
/// whoever binds it by those.
double SumoWorld::free_speed(const Scene& scene, std::size_t row,
                             std::span<const std::uint32_t> near, bool straight_on) const {
  constexpr double kStands = 1.0, kSameWay = 0.7;                   // [m/s], cosine
  constexpr double kStep = 0.5, kAside = 0.1, kBefore = 0.5;        // [m]
  constexpr double kBraking = 3.0, kReaction = 0.3, kOnFoot = 1.0;  // [m/s^2], [s], [m]
  constexpr double kPasses = 0.8;                                   // [s]
  const Known& known = known_[scene.id[row].value];
  const double speed = scene.speed[row];
  straight_on |= known.is_person;
  const Path* path = straight_on ? nullptr : road_->path(scene.path[row]);
  if (path == nullptr && !straight_on) return kForever;
  const double reach = known.is_person
                           ? kOnFoot
                           : speed * speed / (2.0 * kBraking) + kReaction * speed + 2.0 * kBefore;
  const Vec2 heading = direction_of(scene.heading[row]);
  OrientedBox now = box_of(scene, row);
  now.half.y() += kAside;
  const Vec2 half = now.half;
  const double along = scene.path_along[row];
  const auto body_at = [&](double way) {
    if (path == nullptr) return OrientedBox{scene.position[row] + way * heading, heading, half};
    const Vec2 front = path->line.point_at(along + half.x() + way);
    const Vec2 rear = path->line.point_at(std::max(along - half.x() + way, 0.0));
    const Vec2 chord = front - rear;
    const double length = chord.norm();
    const Vec2 forward = length > 0.1 ? Vec2(chord / length) : heading;
    return OrientedBox{front - half.x() * forward, forward, half};
  };
  struct Ahead {
    OrientedBox box;
    double speed;  // along the own way [m/s]
  };
  std::vector<Ahead> ahead;
  for (const std::uint32_t other : near) {
    OrientedBox box = box_of(scene, other);
    const bool same_way = box.forward.dot(heading) > kSameWay;
    // a person lets whoever drives by pass
    const double way = known.is_person ? kPasses * scene.speed[other] : 0.0;
    if ((scene.speed[other] > kStands && !same_way && !known.is_person) ||
        std::abs(scene.height[other] - scene.height[row]) > kStorey)
      continue;
    box.center += 0.5 * way * box.forward;
    box.half.x() += 0.5 * way;
    if (separation(now, box) > 0.0)
      ahead.push_back({box, std::max(scene.velocity[other].dot(heading), 0.0)});
  }
  double most = kForever;
  for (double way = kStep; way <= reach && !ahead.empty(); way += kStep) {
    const OrientedBox body = body_at(way);
    std::erase_if(ahead, [&](const Ahead& one) {
      if (separation(body, one.box) > 0.0) return false;
      const double free = std::max(way - kStep - kBefore, 0.0);
      most = std::min(most, std::sqrt(one.speed * one.speed + 2.0 * kBraking * free));
      return true;
    });
  }
  return most;
}

/// Would a lane change that SUMO may make now, to either side, lead into a ghost?
bool SumoWorld::is_barred(const Scene& scene, std::size_t row,
                          std::span<const std::uint32_t> near) const {
  const LaneId on = known_[scene.id[row].value].lane;
  if (on == kNoLane) return false;
  const Lane& lane = model_.road.lane(on);
  const auto aside = [&](LaneId other) {
    return other == kNoLane ? 0.0 : 0.5 * (lane.width + model_.road.lane(other).width);
  };
  // the inner lane is the one towards the road's middle
  const double side = lane.inner == kNoLane && lane.outer == kNoLane ? 0.0 : inner_side(lane);
  const double to[2] = {side * aside(lane.inner), -side * aside(lane.outer)};
  return std::any_of(near.begin(), near.end(), [&](std::uint32_t ghost) {
    return std::any_of(std::begin(to), std::end(to),
                       [&](double by) { return by != 0.0 && bars_change(scene, row, ghost, by); });
  });
}

/// SUMO's lane change mode doesn't stop overtaking on the opposite lane; the driver's eagerness for
/// it does (vType attribute lcOpposite).
void SumoWorld::hold_overtaking(const Scene& scene, std::size_t row) {
  constexpr const char* kEagerness = "laneChangeModel.lcOpposite";
  Known& known = known_[scene.id[row].value];
  const bool may_overtake =
      known.lane != kNoLane && model_.road.lane(known.lane).opposite != kNoLane;
  const bool held = may_overtake && meets_ghosts(scene, row);
  if (held == known.overtaking_held) return;
  if (held && known.eagerness.empty()) {
    const std::string ids[] = {known.sumo_id};
    const std::vector<std::string> own = backend_.parameters(ids, kEagerness);
    known.eagerness = own.empty() || own.front().empty() ? "1" : own.front();
  }
  backend_.set_parameter(known.sumo_id, kEagerness, held ? "0" : known.eagerness);
  known.overtaking_held = held;
}

/// Is a ghost, which SUMO leaves out of its reckoning, on the stretch of road that overtaking on
/// the opposite lane would take, either way?
bool SumoWorld::meets_ghosts(const Scene& scene, std::size_t row) const {
  constexpr double kTime = 10.0, kLeast = 50.0, kAside = 12.0, kBend = 0.3;  // [s], [m], [m], -
  const Vec2 forward = direction_of(scene.heading[row]);
  bool meets = false;
  ghosts_.visit_within(scene.position[row], kLeast + 2.0 * kTime * scene.speed[row],
                       [&](std::uint32_t other, double) {
                         if (meets || scene.control[other] != Control::Gamma) return;
                         const Vec2 way = scene.position[other] - scene.position[row];
                         const double comes = -scene.velocity[other].dot(forward);
                         const double ahead = way.dot(forward);
                         meets =
                             ahead > -kAside &&
                             ahead < kLeast + kTime * (scene.speed[row] + std::max(comes, 0.0)) &&
                             std::abs(way.dot(left_of(forward))) < kAside + kBend * ahead;
                       });
  return meets;
}

/// Is a vehicle on the lane of those who come the other way?
bool SumoWorld::overtakes(const Scene& scene, std::size_t row) const {
  const LaneId on = known_[scene.id[row].value].lane;
  if (on == kNoLane) return false;
  const Polyline& line = model_.road.lane(on).centerline;
  return line.direction_at(line.project(scene.position[row]).along)
             .dot(direction_of(scene.heading[row])) < 0.0;
}

/// +1 where the lane with the next higher index is on the left, -1 where it is on the right.
double SumoWorld::inner_side(const Lane& lane) const {
  const bool has_inner = lane.inner != kNoLane;
  const Lane& other = model_.road.lane(has_inner ? lane.inner : lane.outer);
  const Vec2 here = lane.centerline.point_at(0.5 * lane.centerline.length());
  const PolylinePosition place = other.centerline.project(here);
  const bool other_on_left = place.offset < 0.0;
  return other_on_left == has_inner ? 1.0 : -1.0;
}

}  // namespace sumogamma
