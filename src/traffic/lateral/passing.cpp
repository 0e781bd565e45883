#include "traffic/lateral/passing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "traffic/lateral/overtaking.h"

namespace sumogamma {

namespace {

constexpr double kNarrow = 1.2;     ///< vehicles below this width share lanes [m]
constexpr double kFarthest = 2.3;   ///< aside of the path [m]
constexpr double kGain = 1.0;       ///< worth passing for [m/s]
constexpr double kSmallGain = 0.3;  ///< likewise for narrow vehicles [m/s]
constexpr double kQueue = 3.0;      ///< slower than this is a queue [m/s]
constexpr double kOffEdge = 0.15;   ///< kept to the edge of its room [m]
constexpr double kLeast = 0.2;      ///< to the side of whoever a narrow vehicle passes [m]

/// What is left between two bodies side by side [m].
double side_gap(bool narrow, double speed) {
  return narrow ? 0.25 + 0.02 * speed : 0.45 + 0.03 * speed;
}

/// Is the body on a junction, or about to be?
bool is_near_junction(const Path& path, const Surroundings& around) {
  const double ahead = around.along + around.half_length + 8.0 + 1.5 * around.speed;
  return std::any_of(path.links.begin(), path.links.end(), [&](const PathLink& link) {
    return link.stop_line < ahead && link.end > around.along - around.half_length;
  });
}

/// The side to which a link turns: 1 left, -1 right, 0 neither.
int side_of_turn(const RoadNetwork& network, const PathLink& link) {
  switch (network.connection(link.connection).direction) {
    case TurnDirection::Left:
    case TurnDirection::PartlyLeft:
    case TurnDirection::Turnaround:
      return 1;
    case TurnDirection::Right:
    case TurnDirection::PartlyRight:
      return -1;
    default:
      return 0;
  }
}

/// Likewise of somebody who is on a junction, or will be soon at its speed [m/s].
int turning_side(const RoadNetwork& network, const Path& path, double along, double speed) {
  constexpr double kSoon = 3.0, kNear = 6.0;  // [s], [m]
  const auto link = path.link_from(along);
  const bool soon =
      link != path.links.end() && link->stop_line - along <= std::max(kNear, kSoon * speed);
  return soon ? side_of_turn(network, *link) : 0;
}

/// A narrow vehicle among those around it.
struct Filtering {
  const Model& model;
  const RoadState& road;
  const Scene& scene;
  const Surroundings& around;
  double free_speed;  ///< [m/s]
  int turns;          ///< see turning_side
};

/// Does a user ahead turn across the place at `offset` right beside it? Who stands lets others by.
bool turns_across(const Filtering& rider, const PathUser& user, double offset) {
  constexpr double kStands = 1.0;  // [m/s]
  constexpr double kBeside = 2.5;  // between the middles [m]
  const Path* path = rider.road.path(rider.scene.path[user.row]);
  if (path == nullptr || user.speed < kStands || std::abs(offset - user.offset) > kBeside ||
      user.front < rider.around.along + rider.around.half_length)
    return false;
  const int side =
      turning_side(rider.model.road, *path, rider.scene.path_along[user.row], user.speed);
  return side != 0 && side != rider.turns && side * (offset - user.offset) > 0.0;
}

/// Would a narrow vehicle that moves over to `offset` cut off somebody who comes from behind there?
bool cuts_off(const Surroundings& around, const PathUser& user, double offset, double margin) {
  constexpr double kAsked = 1.5;  // of whoever is behind at the most [m/s^2]
  const double sides = user.half_width + around.half_width;
  const double gap = around.along - around.half_length - user.front;
  const bool moves_before_it = std::abs(user.offset - offset) < sides + margin &&
                               std::abs(user.offset - around.offset) > sides;
  const double closing = user.speed - around.speed;
  return moves_before_it && user.aligned && closing > 0.0 &&
         closing * closing > 2.0 * kAsked * std::max(gap, 0.0);
}

/// See hoped_speed: that of a narrow vehicle, which looks further ahead. It goes by slowly where it
/// is close, counts on other narrow ones to go on as it does, and passes nobody on the side to
/// which that one turns, or just before somebody who comes from behind.
double filtering_hope(const Filtering& rider, double offset, double margin) {
  constexpr double kOutlook = 20.0;  // [s]
  constexpr double kGoesOn = 2.0;    // [m/s]
  constexpr double kBrakesOn = 2.0;  // [s]
  const Surroundings& around = rider.around;
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  double hoped = rider.free_speed;
  for (const PathUser& user : around.users) {
    if (user.front < rear - 0.3) {
      if (cuts_off(around, user, offset, margin)) return 0.0;
      continue;
    }
    const double clearance = std::abs(user.offset - offset) - user.half_width - around.half_width;
    const bool vehicle = user.aligned && !user.on_foot;
    const double braking = std::min(rider.scene.acceleration[user.row].dot(around.tangent), 0.0);
    double pace = std::max(user.speed + kBrakesOn * braking, 0.0);
    if (clearance > margin) {
      if (!vehicle) continue;
      const bool cut_off = turns_across(rider, user, offset);
      hoped = std::min(hoped, cut_off ? pace : pace + filtering_speed(clearance));
      continue;
    }
    const double gap = user.rear - front;
    const bool goes_on = vehicle && is_narrow(2.0 * user.half_width);
    if (gap < 0.0 && !goes_on) return 0.0;
    if (goes_on) pace = std::max(pace, kGoesOn);
    hoped = std::min(hoped, pace + std::max(gap, 0.0) / kOutlook);
  }
  return hoped;
}

/// Where beside `user` a narrow vehicle passes it: in the middle of what is free up to the next
/// wide body on that side, at most so far aside that it need not mind its sides.
double place_beside(const Surroundings& around, const PathUser& user, double side) {
  constexpr double kRoomy = 0.6;  // to a side [m]
  constexpr double kNear = 6.0;   // along the path, of who is beside or soon will be [m]
  const double edge = user.offset + side * user.half_width;
  double free = 2.0 * (around.half_width + kRoomy);
  for (const PathUser& other : around.users) {
    if (is_narrow(2.0 * other.half_width) || other.rear > user.front + kNear ||
        other.front < user.rear - kNear)
      continue;
    const double way = side * (other.offset - edge) - other.half_width;
    if (way > 0.0) free = std::min(free, way);
  }
  return edge + 0.5 * side * free;
}

/// Way on which a body that is turned to a side already (a sine) gets `distance` [m] further to it
/// with a steady curvature [1/m].
double way_aside(double distance, double turned, double curvature) {
  const double root = turned * turned + 2.0 * curvature * std::max(distance, 0.0);
  return std::max(std::sqrt(root) - turned, 0.0) / curvature;
}

}  // namespace

bool is_narrow(double width) { return width < kNarrow; }

double filtering_speed(double clearance) {
  constexpr double kClosest = 0.16;  // [m]
  constexpr double kRate = 25.0;     // [m/s] a metre
  return std::max(kRate * (clearance - kClosest), 0.0);
}

double passing_speed(const Passed& passed, const AgentType& type) {
  constexpr double kThere = 0.05;  // [m]
  constexpr double kLock = 0.55;   // of its tightest turn
  const double past = filtering_speed(passed.meant);
  if (passed.gap <= 0.0)
    return passed.speed + std::clamp(filtering_speed(passed.now), passed.manner.sideways,
                                     std::max(past, passed.manner.sideways));
  const double far = std::sqrt(past * past + 2.0 * type.comfortable_deceleration * passed.gap);
  const double aside = passed.aside();
  if (aside < kThere) return passed.speed + far;
  const double curvature = kLock * std::tan(type.max_steering) / type.wheelbase;
  const double spare = std::max(passed.gap - way_aside(aside, passed.turned, curvature), 0.0);
  const double least = passed.taken ? 0.0 : passed.manner.sideways;
  const double steady =
      std::min(passed.manner.sideways * passed.gap / aside, passed.manner.closes * spare);
  return passed.speed + std::min(far, std::max(least, steady));
}

namespace {

constexpr double kBeforeJunction = 40.0;  ///< from here on it says where to filter [m]

/// Those links, one close behind the other where roads between junctions are short.
std::span<const PathLink> links_ahead(const Path& path, const Surroundings& around) {
  const auto first = path.link_from(around.along);
  const auto last = std::find_if(first, path.links.end(), [&](const PathLink& link) {
    return link.stop_line - around.along > kBeforeJunction;
  });
  return {first, last};
}

/// Who is about to turn filters beside its lane only on the side to which it turns: on the other
/// one the way of the lane beside, or of who goes straight on from its own, crosses its way, and
/// the two press against each other on the junction.
void keep_to_turning_side(const RoadNetwork& network, const Path& path, const Surroundings& around,
                          double& most_left, double& most_right) {
  for (const PathLink& link : links_ahead(path, around)) {
    const int side = side_of_turn(network, link);
    const Lane& lane = network.lane(path.stretch_at(link.stop_line - 0.1).lane);
    const double within = std::max(0.5 * lane.width - around.half_width, 0.0);
    if (side < 0) most_left = std::min(most_left, within);
    if (side > 0) most_right = std::max(most_right, -within);
  }
}

/// Before a signal who filters stays over the edge of its own lane, whose light it goes by: the one
/// of the lane beside may be red when its own is green.
void keep_to_light(const RoadNetwork& network, const Path& path, const Surroundings& around,
                   double& most_left, double& most_right) {
  constexpr double kReaches = 0.5;  // of half the body, into the own lane
  const auto link =
      std::find_if(path.link_from(around.along), path.links.end(), [&](const PathLink& ahead) {
        return ahead.stop_line >= around.along &&
               network.connection(ahead.connection).signal != kNoSignal;
      });
  if (link == path.links.end() || link->stop_line - around.along > kBeforeJunction) return;
  const Connection& connection = network.connection(link->connection);
  const double within =
      0.5 * network.lane(connection.from).width + (1.0 - kReaches) * around.half_width;
  most_left = std::min(most_left, within);
  most_right = std::max(most_right, -within);
}

/// How far to the left and to the right of the path a body aims at the most where there is so much
/// room [m].
double farthest_left(double room, double half_width) {
  return std::max(room - half_width - kOffEdge, 0.0);
}
double farthest_right(double room, double half_width) {
  return std::min(half_width + kOffEdge - room, 0.0);
}

/// What the stretch leaves on which a body is, less at the kerb where a corner is rounded ahead:
/// there the path lies nearer to it than the middle of the lane does.
Sides sides_of(const RoadNetwork& network, const Path& path, const Surroundings& around) {
  constexpr double kSteers = 1.0;  // it takes to get to another place beside the path [s]
  constexpr double kSpare = 0.15;  // bends are smoothed by as much [m]
  const PathStretch& here = path.stretch_at(around.along);
  const Cut cut = path.cut_between(around.along - around.half_length,
                                   around.along + around.half_length + kSteers * around.speed);
  Sides sides{here.room_left, here.room_right};
  double& at_kerb = network.left_hand ? sides.left : sides.right;
  if (here.kerb < at_kerb + kOffEdge)
    at_kerb -= std::max((network.left_hand ? cut.left : cut.right) - kSpare, 0.0);
  return sides;
}

/// Nobody passes on a junction where there is no room behind it: who is beside a bus as it turns
/// into a road with fewer lanes comes out over the middle of that or on its sidewalk.
void keep_to_exit(const RoadNetwork& network, const Path& path, const Surroundings& around,
                  double& most_left, double& most_right) {
  for (const PathLink& link : links_ahead(path, around)) {
    const PathStretch& exit = path.stretch_at(link.end + 0.1);
    if (network.lane(exit.lane).kind != LaneKind::Normal) continue;
    most_left = std::min(most_left, farthest_left(exit.room_left, around.half_width));
    most_right = std::max(most_right, farthest_right(exit.room_right, around.half_width));
  }
}

/// Is somebody beside the agent, or so near ahead that it would pass that one next?
bool may_be_passed(const Surroundings& around, const PathUser& user) {
  return user.front >= around.along - around.half_length &&
         user.rear <= around.along + around.half_length + 10.0 + 3.0 * around.speed;
}

/// Where in its own lane a wide vehicle gets past the tails of those who stand in a lane beside, if
/// there is such a place: who changed into a full lane stands with a corner of its body in this
/// one.
std::optional<double> place_beside_tails(const TrafficView& view, LaneId id,
                                         const Surroundings& around, double liked) {
  constexpr double kGap = 0.35;  // to the side [m]
  const Lane& lane = view.model.road.lane(id);
  if (lane.kind != LaneKind::Normal) return std::nullopt;
  const double within = 0.5 * lane.width - around.half_width - kOffEdge;
  double least = -within, most = within;
  bool any = false;
  for (const PathUser& user : around.users) {
    if (!may_be_passed(around, user) || !stands_beside_lane(view, user.row, id, user.offset))
      continue;
    const double apart = user.half_width + around.half_width + kGap;
    any = any || std::abs(user.offset - liked) < apart;
    if (user.offset > 0.0) most = std::min(most, user.offset - apart);
    if (user.offset < 0.0) least = std::max(least, user.offset + apart);
  }
  if (!any || least > most) return std::nullopt;
  return std::clamp(liked, least, most);
}

}  // namespace

bool stands_beside_lane(const TrafficView& view, std::size_t other, LaneId lane, double offset) {
  const Model& model = view.model;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  constexpr double kStands = 0.5;  // [m/s]
  const AgentType& type = type_of(model.types, scene.type[other]);
  return type.kinematics != Kinematics::Holonomic && !is_narrow(type.width) &&
         scene.speed[other] < kStands && std::abs(offset) > 0.5 * model.road.lane(lane).width &&
         traffic.merge_to[other] != lane && scene.lane[other].lane != lane;
}

namespace {

/// Between which places beside its path a body may be, and where it likes to be there [m].
struct Places {
  double most_left = 0, most_right = 0, liked = 0;
};

/// `over`: room over the middle of the road [m].
Places places_of(const TrafficView& view, const Path& path, const Surroundings& around,
                 std::size_t row, double over) {
  const RoadNetwork& network = view.model.road;
  const double half = around.half_width;
  const double over_left = network.left_hand ? 0.0 : over, over_right = over - over_left;
  const Sides sides = sides_of(network, path, around);
  Places places;
  places.most_left = farthest_left(sides.left + over_left, half);
  places.most_right = farthest_right(sides.right + over_right, half);
  keep_to_turning_side(network, path, around, places.most_left, places.most_right);
  if (over == 0.0) keep_to_light(network, path, around, places.most_left, places.most_right);
  // what a junction has beside its lanes is for who has to get past, and for bodies that swing
  const Lane& lane = network.lane(path.stretch_at(around.along).lane);
  const double on_lane = std::clamp(view.scene.manners[row].path_offset,
                                    std::min(places.most_right + lane.beside_right, 0.0),
                                    std::max(places.most_left - lane.beside_left, 0.0));
  keep_to_exit(network, path, around, places.most_left, places.most_right);
  places.liked = std::clamp(on_lane, places.most_right, places.most_left);
  return places;
}

/// Somebody who looks for a place to pass.
struct Passer {
  const Surroundings& around;
  Filtering rider;
  bool narrow;
  double over;  ///< room over the middle of the road [m]

  /// See hoped_speed.
  double hope(double offset, double margin) const {
    return narrow ? filtering_hope(rider, offset, margin)
                  : hoped_speed(around, offset, rider.free_speed, margin);
  }
};

/// A place, and the speed that can be hoped for there [m/s].
struct Hope {
  double place = 0, speed = 0;
};

/// The best place beside anybody who is in the way, if it is worth it. Only who is in the way is
/// passed, and not by changing lanes; wide vehicles pass narrow ones alone, on the inner side.
double pass_somebody(const Passer& passer, const Places& places, double inner_side, Hope best) {
  const Surroundings& around = passer.around;
  const bool narrow = passer.narrow;
  const double half = around.half_width;
  const double worth = best.speed + (narrow ? kSmallGain : kGain);
  const double gap_wanted = passer.over > 0.0 ? kOvertakingGap : side_gap(narrow, around.speed);
  for (const PathUser& user : around.users) {
    if ((!user.aligned && !user.on_foot) || !may_be_passed(around, user)) continue;
    if (!narrow && user.half_width > 0.5 * kNarrow) continue;
    if (std::abs(user.offset - places.liked) > user.half_width + half + gap_wanted) continue;
    for (const double side : {inner_side, -inner_side}) {
      if (!narrow && side != inner_side) continue;
      const double offset =
          narrow ? std::clamp(place_beside(around, user, side), places.most_right, places.most_left)
                 : user.offset + side * (user.half_width + half + gap_wanted);
      if (offset > places.most_left || offset < places.most_right ||
          std::abs(offset) > kFarthest + passer.over)
        continue;
      const double hoped = passer.hope(offset, narrow ? kLeast : 0.9 * gap_wanted);
      if (hoped > std::max(best.speed, worth)) best = {offset, hoped};
    }
  }
  return best.place;
}

}  // namespace

double passing_offset(const TrafficView& view, const Path& path, const Surroundings& around,
                      std::size_t row) {
  constexpr double kMargin = 0.15;  // [m]
  const RoadNetwork& network = view.model.road;
  const double over = view.traffic.overtaking_room[row];
  const Places places = places_of(view, path, around, row, over);
  const double free_speed =
      std::min(path.profile_at(around.along), view.scene.preferred_speed[row]);
  const bool narrow = is_narrow(2.0 * around.half_width);
  const int turns = turning_side(network, path, around.along, around.speed);
  const Passer passer{
      around, {view.model, view.road, view.scene, around, free_speed, turns}, narrow, over};
  const double as_liked = passer.hope(places.liked, kMargin);
  Hope best{places.liked, as_liked};
  // what was begun is gone on with unless something is clearly better
  const double present = view.traffic.passing_offset[row];
  if (std::abs(present - places.liked) > 0.2 && present <= places.most_left &&
      present >= places.most_right) {
    const double hoped = passer.hope(present, 0.8 * kMargin);
    if (hoped > best.speed + 0.3 || (narrow && best.speed < kQueue))
      best = {present, std::max(best.speed, hoped)};
  }
  if (best.speed > 0.8 * free_speed) return best.place;
  if (!narrow && over == 0.0) {
    const LaneId lane = path.stretch_at(around.along).lane;
    const auto place = place_beside_tails(view, lane, around, places.liked);
    if (place && passer.hope(*place, kMargin) > as_liked + kSmallGain) return *place;
  }
  // wide vehicles keep to their lane where ways cross
  if (!narrow && is_near_junction(path, around)) return places.liked;
  return pass_somebody(passer, places, network.left_hand ? -1.0 : 1.0, best);
}

}  // namespace sumogamma
