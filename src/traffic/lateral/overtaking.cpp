#include "traffic/lateral/overtaking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "traffic/lateral/passing.h"
#include "traffic/longitudinal/car_following.h"

namespace sumogamma {

namespace {

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
bool is_in_way(const TrafficParameters& parameters, const Surroundings& around,
               const PathUser& user, double liked, double behind = 0) {
  return user.front > around.along - around.half_length - behind &&
         std::abs(user.offset - liked) <
             user.half_width + around.half_width + parameters.ample_side;
}

/// Is somebody narrow in the way that the body comes back into, behind it by no more than `within`
/// [m] and by what that one closes up in so many seconds?
bool has_passed(const TrafficParameters& parameters, const Surroundings& around, double liked,
                double within, double seconds) {
  const double rear = around.along - around.half_length;
  return std::any_of(around.users.begin(), around.users.end(), [&](const PathUser& user) {
    const double closes = std::max(user.speed - around.speed, 0.0) * seconds;
    return user.aligned && is_narrow(2.0 * user.half_width) && user.front < rear &&
           is_in_way(parameters, around, user, liked, within + closes);
  });
}

/// Would the body, which has got past everybody in its way, cut somebody off if it came back now?
bool is_just_past(const TrafficParameters& parameters, const Surroundings& around, double liked) {
  return has_passed(parameters, around, liked, parameters.closed_up_gap, parameters.time_gap);
}

/// Gap between two who are overtaken that a body can come back into [m].
double way_back(const TrafficParameters& parameters, const Surroundings& around) {
  return 2.0 * (around.half_length + parameters.near_line);
}

Overtaken find_overtaken(const TrafficParameters& parameters, const Surroundings& around,
                         double liked, double inner_side) {
  Overtaken found;
  // the nearest ahead again and again, until a gap
  for (double from = -std::numeric_limits<double>::infinity();;) {
    const PathUser* next = nullptr;
    for (const PathUser& user : around.users)
      if (is_in_way(parameters, around, user, liked) && user.front > from &&
          (!next || user.front < next->front))
        next = &user;
    if (next == nullptr) {
      found.open = true;
      return found;
    }
    if (found.any) {
      // the gap that is left once it is past, should who is ahead be slower
      const double closes = parameters.overtaking_time * std::max(found.speed - next->speed, 0.0);
      found.open = next->rear - found.front - closes > way_back(parameters, around);
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
double straight_ahead(const TrafficParameters& parameters, const Path& path, double along,
                      double most) {
  const Vec2 tangent = path.line.direction_at(along);
  double end = std::min(most, path.line.length() - along);
  for (double way = parameters.path_step; way < end; way += parameters.path_step)
    if (path.line.direction_at(along + way).dot(tangent) < parameters.straight) end = way;
  return end;
}

/// The lane of who overtakes.
struct OwnSide {
  double lane_width = 0;  ///< [m]
  double inner = 1;       ///< sign of the side on which it overtakes: 1 left, -1 right
};

/// How somebody would overtake.
struct Plan {
  double target = 0;      ///< of its middle, on the inner side [m]
  double time = 0;        ///< it takes to get past and back [s]
  double way = 0;         ///< over that [m]
  double mean_speed = 0;  ///< meanwhile [m/s]
  double top = 0;         ///< at the end [m/s]
};

/// How long it takes to get past and back, and how far. It gathers speed while it gets aside, and
/// is aside before it gets beside.
Plan plan_for(const TrafficParameters& parameters, const Surroundings& around,
              const Overtaken& overtaken, const AgentType& type, double top, const OwnSide& side) {
  const double front = around.along + around.half_length;
  Plan plan;
  plan.top = top;
  plan.target = overtaken.offset + parameters.overtaking_gap + around.half_width;
  const double getting_out =
      std::max(plan.target - side.inner * around.offset, 0.0) / parameters.lateral_speed;
  const double past = overtaken.front + parameters.near_line - (around.along - around.half_length);
  const double beside = past - std::max(overtaken.rear - front, 0.0);
  const auto time_for = [&](double way, double from) {
    return time_to_cover(way, std::max(from, 0.0), top - overtaken.speed,
                         0.9 * type.max_acceleration);
  };
  const double passing = std::max(time_for(past, around.speed - overtaken.speed),
                                  getting_out + time_for(beside, 0.5 * (top - overtaken.speed)));
  const double over = std::max(plan.target + around.half_width - 0.5 * side.lane_width, 0.0);
  plan.time = passing + over / parameters.lateral_speed;
  plan.mean_speed = 0.5 * (std::max(around.speed, overtaken.speed) + top);
  plan.way = plan.mean_speed * plan.time;
  return plan;
}

/// Does the lane go on, straight and clear of junctions, and does who may come from where nobody
/// sees it come too late? It comes as fast as the road allows; where the road begins somebody may
/// start just now, but hardly will.
bool is_road_clear(const TrafficParameters& parameters, const Path& path,
                   const Surroundings& around, const Plan& plan, const Lane& opposite, bool begun) {
  const PathStretch& here = path.stretch_at(around.along);
  const double front = around.along + around.half_length;
  if (here.to < around.along + plan.way && !begun) return false;
  for (const PathLink& link : path.links)
    if (link.end > around.along &&
        link.stop_line < front + (begun ? 0.5 * plan.way : plan.way + parameters.nearby))
      return false;
  const double sight = straight_ahead(parameters, path, around.along, parameters.sight);
  const bool begins = opposite.incoming.empty() && around.along + sight > here.to - 1.0;
  const double closing_speed = plan.mean_speed + opposite.speed_limit;
  const double unseen =
      closing_speed *
      (plan.time + (begins || begun ? parameters.time_gap : parameters.overtaking_time_gap));
  return begun || sight >= unseen;
}

/// Does nobody come, neither towards it nor from behind? `margin` [s].
bool comes_nobody(const TrafficParameters& parameters, const Surroundings& around,
                  const Surroundings& far, const Plan& plan, const OwnSide& side, double margin) {
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  for (const PathUser& user : far.users) {
    const double aside = side.inner * user.offset;
    if (aside + user.half_width < 0.5 * side.lane_width && user.aligned) continue;
    if (std::abs(aside - plan.target) > user.half_width + around.half_width + parameters.ample_side)
      continue;
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
  const Scene& scene = view.scene;
  const RoadNetwork& network = view.model.road;
  const Path& path = *view.road.path(scene.path[row]);
  const Lane* opposite = lane_to_use(network, path, around);
  if (opposite == nullptr) return 0.0;
  const double lane_width = network.lane(path.stretch_at(around.along).lane).width;
  const double inner_side = network.left_hand ? -1.0 : 1.0;
  const double liked = scene.manners[row].path_offset;
  const Overtaken overtaken = find_overtaken(view.parameters, around, liked, inner_side);
  const double aside_now = inner_side * around.offset;
  const bool over_now =
      aside_now + around.half_width > 0.5 * lane_width - view.parameters.tight_side;
  const double front = around.along + around.half_length;
  const double room_now = view.traffic.overtaking_room[row];
  const bool out = room_now > 0.0 && over_now;
  // past, with room before the next, if any: back to its own side, but not right before a nose; the
  // next one is overtaken only if that could be begun now
  const bool past_them =
      out &&
      (!overtaken.any || (overtaken.rear - front > way_back(view.parameters, around) &&
                          has_passed(view.parameters, around, liked, view.parameters.nearby, 0.0)));
  if (past_them && is_just_past(view.parameters, around, liked)) return room_now;
  if (!overtaken.any) return 0.0;
  const bool begun = out && !past_them;

  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const double free_speed = std::min(path.profile_at(around.along), scene.preferred_speed[row]);
  const double top = std::min(free_speed, overtaken.speed + view.parameters.flow_speed);
  if (!overtaken.open || top < overtaken.speed + 2.0) return 0.0;
  const Plan plan =
      plan_for(view.parameters, around, overtaken, type, top, {lane_width, inner_side});
  // abreast already, or as good as that, it is safer to get past than to brake hard beside it
  const double faster = std::max(around.speed - overtaken.speed, 0.0);
  if (begun && front + faster * faster / (2.0 * view.parameters.easy_braking) > overtaken.rear)
    return opposite->width;
  if (!is_road_clear(view.parameters, path, around, plan, *opposite, begun)) return 0.0;
  look_around(view, row, view.parameters.sight, 8.0, far);
  const double margin = begun ? view.parameters.time_gap : view.parameters.overtaking_time_gap;
  return comes_nobody(view.parameters, around, far, plan, {lane_width, inner_side}, margin)
             ? opposite->width
             : 0.0;
}

}  // namespace sumogamma
