#include "traffic/lateral/overtaking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "traffic/lateral/passing.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

constexpr double kSight = 300.0;              // [m]
constexpr double kAtMiddle = 0.2;             // of the road [m]
constexpr double kInWay = 0.5;                // aside that counts as in the way [m]
constexpr double kSideways = 0.7;             // [m/s]
constexpr double kFaster = 7.0;               // than who is overtaken, at most [m/s]
constexpr double kPassing = 6.0;              // takes so long [s]
constexpr double kMargin = 3.5, kKept = 1.2;  // to who comes, before and after it has begun [s]
constexpr double kRoomToReturn = 2.5;         // behind and ahead of the body [m]

/// Who is overtaken, from the nearest to the last that leaves no gap to return into.
struct Overtaken {
  double rear = 0;    ///< of the nearest along the path [m]
  double front = 0;   ///< of the last [m]
  double offset = 0;  ///< of the side that reaches furthest to the middle of the road [m]
  double speed = 0;   ///< of the fastest [m/s]
  bool any = false;
  bool open = false;  ///< there is a gap ahead of the last
};

/// In the way of the body where it likes to be, and not behind it.
bool is_in_way(const Surroundings& around, const PathUser& user, double liked, double behind = 0) {
  return user.front > around.along - around.half_length - behind &&
         std::abs(user.offset - liked) < user.half_width + around.half_width + kInWay;
}

/// Is somebody narrow in the way that the body comes back into, behind it by no more than `within`
/// [m] and by what that one closes up in so many seconds?
bool has_passed(const Surroundings& around, double liked, double within, double seconds) {
  const double rear = around.along - around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const double closes = std::max(user.speed - around.speed, 0.0) * seconds;
    return user.aligned && is_narrow(2.0 * user.half_width) && user.front < rear &&
           is_in_way(around, user, liked, within + closes);
  });
}

/// Would the body, which has got past everybody in its way, cut somebody off if it came back now?
bool is_just_past(const Surroundings& around, double liked) {
  constexpr double kNoseRoom = 1.0, kSoon = 1.0;  // [m], [s]
  return has_passed(around, liked, kNoseRoom, kSoon);
}

/// Gap between two who are overtaken that a body can come back into [m].
double way_back(const Surroundings& around) { return 2.0 * (around.half_length + kRoomToReturn); }

Overtaken find_overtaken(const Surroundings& around, double liked, double inner_side) {
  Overtaken found;
  // the nearest ahead again and again, until a gap
  for (double from = -std::numeric_limits<double>::infinity();;) {
    const PathUser* next = nullptr;
    for (const PathUser& user : around.users)
      if (is_in_way(around, user, liked) && user.front > from &&
          (!next || user.front < next->front))
        next = &user;
    if (next == nullptr) {
      found.open = true;
      return found;
    }
    if (found.any) {
      // the gap that is left once it is past, should who is ahead be slower
      const double closes = kPassing * std::max(found.speed - next->speed, 0.0);
      found.open = next->rear - found.front - closes > way_back(around);
      if (found.open) return found;
    }
    if (!next->aligned || next->on_foot || !is_narrow(2.0 * next->half_width)) return found;
    const double side = inner_side * next->offset + next->half_width;
    found.offset = found.any ? std::max(found.offset, side) : side;
    found.speed = std::max({found.speed, next->speed, 0.0});
    if (!found.any) found.rear = next->rear;
    found.front = from = next->front;
    found.any = true;
  }
}

/// The road ahead, as far as it is straight and no junction or end of the path comes.
double straight_ahead(const Path& path, double along, double most) {
  constexpr double kStep = 10.0, kStraight = 0.985;  // [m], cosine
  const Vec2 tangent = path.line.direction_at(along);
  double end = std::min(most, path.line.length() - along);
  for (double way = kStep; way < end; way += kStep)
    if (path.line.direction_at(along + way).dot(tangent) < kStraight) end = way;
  return end;
}

/// How somebody would overtake.
struct Plan {
  double target = 0;      ///< of its middle, on the inner side [m]
  double time = 0;        ///< it takes to get past and back [s]
  double way = 0;         ///< over that [m]
  double mean_speed = 0;  ///< meanwhile [m/s]
  double top = 0;         ///< at the end [m/s]
};

/// How long it takes to get past and back, and how far; `lane_width` [m] of the own lane. It
/// gathers speed while it gets aside, and is aside before it gets beside.
Plan plan_for(const Surroundings& around, const Overtaken& overtaken, const AgentType& type,
              double top, double aside_now, double lane_width) {
  const double front = around.along + around.half_length;
  Plan plan;
  plan.top = top;
  plan.target = overtaken.offset + kOvertakingGap + around.half_width;
  const double getting_out = std::max(plan.target - aside_now, 0.0) / kSideways;
  const double past = overtaken.front + kRoomToReturn - (around.along - around.half_length);
  const double beside = past - std::max(overtaken.rear - front, 0.0);
  const auto time_for = [&](double way, double from) {
    return time_to_cover(way, std::max(from, 0.0), top - overtaken.speed,
                         0.9 * type.max_acceleration);
  };
  const double passing = std::max(time_for(past, around.speed - overtaken.speed),
                                  getting_out + time_for(beside, 0.5 * (top - overtaken.speed)));
  const double over = std::max(plan.target + around.half_width - 0.5 * lane_width, 0.0);
  plan.time = passing + over / kSideways;
  plan.mean_speed = 0.5 * (std::max(around.speed, overtaken.speed) + top);
  plan.way = plan.mean_speed * plan.time;
  return plan;
}

/// Does the lane go on, straight and clear of junctions, and does who may come from where nobody
/// sees it come too late? It comes as fast as the road allows; where the road begins somebody may
/// start just now, but hardly will.
bool is_road_clear(const Path& path, const Surroundings& around, const Plan& plan,
                   const Lane& opposite, bool begun) {
  constexpr double kStarts = 2.0;  // likewise to who may start in sight [s]
  constexpr double kClear = 15.0;  // before a junction [m]
  const PathStretch& here = path.stretch_at(around.along);
  const double front = around.along + around.half_length;
  if (here.to < around.along + plan.way && !begun) return false;
  for (const PathLink& link : path.links)
    if (link.end > around.along &&
        link.stop_line < front + (begun ? 0.5 * plan.way : plan.way + kClear))
      return false;
  const double sight = straight_ahead(path, around.along, kSight);
  const bool begins = opposite.incoming.empty() && around.along + sight > here.to - 1.0;
  const double closing_speed = plan.mean_speed + opposite.speed_limit;
  const double unseen = closing_speed * (plan.time + (begins ? kStarts : begun ? kKept : kMargin));
  return begun || sight >= unseen;
}

/// Does nobody come, neither towards it nor from behind? `margin` [s].
bool comes_nobody(const Surroundings& around, const Surroundings& far, const Plan& plan,
                  double inner_side, double lane_width, double margin) {
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  for (const PathUser& user : far.users) {
    const double side = inner_side * user.offset;
    if (side + user.half_width < 0.5 * lane_width && user.aligned) continue;
    if (std::abs(side - plan.target) > user.half_width + around.half_width + kInWay) continue;
    if (user.rear > front) {
      const double closing = plan.mean_speed - user.speed, at_end = plan.top - user.speed;
      if (closing > 0.0 && user.rear - front < closing * plan.time + at_end * margin) return false;
    } else if (user.front > rear) {
      return false;
    } else if (user.aligned) {
      if ((user.speed - around.speed) * plan.time > rear - user.front) return false;
    }
  }
  return true;
}

/// The opposite lane that a wide vehicle may use; null where there is none, or the own lane isn't
/// the one beside it.
const Lane* lane_to_use(const RoadNetwork& network, const Path& path, const Surroundings& around) {
  const PathStretch& here = path.stretch_at(around.along);
  const Lane& lane = network.lane(here.lane);
  if (is_narrow(2.0 * around.half_width) || here.changing || lane.kind != LaneKind::Normal ||
      lane.opposite == kNoLane || lane.inner != kNoLane)
    return nullptr;
  const Lane& opposite = network.lane(lane.opposite);
  const bool shared = (opposite.allowed & lane.allowed & vehicle_class::kPassenger) != 0;
  return shared ? &opposite : nullptr;
}

}  // namespace

double overtaking_room(const TrafficView& view, const Surroundings& around, std::size_t row,
                       Surroundings& far) {
  constexpr double kPassed = 20.0;  // [m]
  constexpr double kAtEase = 1.5;   // [m/s^2]
  const Scene& scene = view.scene;
  const RoadNetwork& network = view.model.road;
  const Path& path = *view.road.path(scene.path[row]);
  const Lane* opposite = lane_to_use(network, path, around);
  if (opposite == nullptr) return 0.0;
  const double lane_width = network.lane(path.stretch_at(around.along).lane).width;
  const double inner_side = network.left_hand ? -1.0 : 1.0;
  const double liked = scene.manners[row].path_offset;
  const Overtaken overtaken = find_overtaken(around, liked, inner_side);
  const double aside_now = inner_side * around.offset;
  const bool over_now = aside_now + around.half_width > 0.5 * lane_width - kAtMiddle;
  const double front = around.along + around.half_length;
  const double room_now = view.traffic.overtaking_room[row];
  const bool out = room_now > 0.0 && over_now;
  // past, with room before the next, if any: back to its own side, but not right before a nose; the
  // next one is overtaken only if that could be begun now
  const bool past_them = out && (!overtaken.any || (overtaken.rear - front > way_back(around) &&
                                                    has_passed(around, liked, kPassed, 0.0)));
  if (past_them && is_just_past(around, liked)) return room_now;
  if (!overtaken.any) return 0.0;
  const bool begun = out && !past_them;

  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const double free_speed = std::min(path.profile_at(around.along), scene.preferred_speed[row]);
  const double top = std::min(free_speed, overtaken.speed + kFaster);
  if (!overtaken.open || top < overtaken.speed + 2.0) return 0.0;
  const Plan plan = plan_for(around, overtaken, type, top, aside_now, lane_width);
  // abreast already, or as good as that, it is safer to get past than to brake hard beside it
  const double faster = std::max(around.speed - overtaken.speed, 0.0);
  if (begun && front + faster * faster / (2.0 * kAtEase) > overtaken.rear) return opposite->width;
  if (!is_road_clear(path, around, plan, *opposite, begun)) return 0.0;
  look_around(view, row, kSight, 8.0, far);
  const double margin = begun ? kKept : kMargin;
  return comes_nobody(around, far, plan, inner_side, lane_width, margin) ? opposite->width : 0.0;
}

}  // namespace sumogamma
