#include "traffic/lateral/passing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "traffic/lateral/overtaking.h"

namespace sumogamma {

namespace {

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
int turning_side(const TrafficView& view, const Path& path, double along, double speed) {
  const auto link = path.link_from(along);
  const double way = std::max(view.parameters.near, view.parameters.soon * speed);
  const bool soon = link != path.links.end() && link->stop_line - along <= way;
  return soon ? side_of_turn(view.model.road, *link) : 0;
}

/// A narrow vehicle among those around it.
struct Filtering {
  const TrafficView& view;
  const Surroundings& around;
  double free_speed;  ///< [m/s]
  int turns;          ///< see turning_side
};

/// Does a user ahead turn across the place at `offset` right beside it? Who stands lets others by.
bool turns_across(const Filtering& rider, const PathUser& user, double offset) {
  const Path* path = rider.view.road.path(rider.view.scene.path[user.row]);
  if (path == nullptr || user.speed < rider.view.parameters.crawling_speed ||
      std::abs(offset - user.offset) > rider.view.parameters.farthest_aside ||
      user.front < rider.around.along + rider.around.half_length)
    return false;
  const int side =
      turning_side(rider.view, *path, rider.view.scene.path_along[user.row], user.speed);
  return side != 0 && side != rider.turns && side * (offset - user.offset) > 0.0;
}

/// Would a narrow vehicle that moves over to `offset` cut off somebody who comes from behind there?
bool cuts_off(const Filtering& rider, const PathUser& user, double offset, double margin) {
  const Surroundings& around = rider.around;
  const double sides = user.half_width + around.half_width;
  const double gap = around.along - around.half_length - user.front;
  const bool moves_before_it = std::abs(user.offset - offset) < sides + margin &&
                               std::abs(user.offset - around.offset) > sides;
  const double closing = user.speed - around.speed;
  return moves_before_it && user.aligned && closing > 0.0 &&
         closing * closing > 2.0 * rider.view.parameters.easy_braking * std::max(gap, 0.0);
}

/// See hoped_speed: that of a narrow vehicle, which looks further ahead. It goes by slowly where it
/// is close, counts on other narrow ones to go on as it does, and passes nobody on the side to
/// which that one turns, or just before somebody who comes from behind.
double filtering_hope(const Filtering& rider, double offset, double margin) {
  const Surroundings& around = rider.around;
  const double front = around.along + around.half_length;
  const double rear = around.along - around.half_length;
  double hoped = rider.free_speed;
  for (const PathUser& user : around.users) {
    if (user.front < rear - 0.3) {
      if (cuts_off(rider, user, offset, margin)) return 0.0;
      continue;
    }
    const double clearance = std::abs(user.offset - offset) - user.half_width - around.half_width;
    const bool vehicle = user.aligned && !user.on_foot;
    const double braking =
        std::min(rider.view.scene.acceleration[user.row].dot(around.tangent), 0.0);
    double pace = std::max(user.speed + rider.view.parameters.soon * braking, 0.0);
    if (clearance > margin) {
      if (!vehicle) continue;
      const bool cut_off = turns_across(rider, user, offset);
      hoped = std::min(hoped,
                       cut_off ? pace : pace + filtering_speed(rider.view.parameters, clearance));
      continue;
    }
    const double gap = user.rear - front;
    const bool goes_on = vehicle && is_narrow(2.0 * user.half_width);
    if (gap < 0.0 && !goes_on) return 0.0;
    if (goes_on) pace = std::max(pace, rider.view.parameters.queue_speed);
    hoped = std::min(hoped, pace + std::max(gap, 0.0) / rider.view.parameters.filtering_outlook);
  }
  return hoped;
}

/// Where beside `user` a narrow vehicle passes it: in the middle of what is free up to the next
/// wide body on that side, at most so far aside that it need not mind its sides.
double place_beside(const TrafficParameters& parameters, const Surroundings& around,
                    const PathUser& user, double side) {
  const double edge = user.offset + side * user.half_width;
  double free = 2.0 * (around.half_width + parameters.ample_side);
  for (const PathUser& other : around.users) {
    if (is_narrow(2.0 * other.half_width) || other.rear > user.front + parameters.near ||
        other.front < user.rear - parameters.near)
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

Manner filtering_manner(const TrafficParameters& parameters) {
  return {parameters.side_clearance, parameters.slow_walk, parameters.gap_closing_rate};
}

Manner overtaking_manner(const TrafficParameters& parameters) {
  return {parameters.overtaking_gap, parameters.lateral_speed, 3.0 * parameters.gap_closing_rate};
}

double filtering_speed(const TrafficParameters& parameters, double clearance) {
  return std::max(parameters.filtering_rate * (clearance - parameters.tight_side), 0.0);
}

double passing_speed(const TrafficParameters& parameters, const Passed& passed,
                     const AgentType& type) {
  const double past = filtering_speed(parameters, passed.meant);
  if (passed.gap <= 0.0)
    return passed.speed + std::clamp(filtering_speed(parameters, passed.now),
                                     passed.manner.sideways,
                                     std::max(past, passed.manner.sideways));
  const double far = std::sqrt(past * past + 2.0 * type.comfortable_deceleration * passed.gap);
  const double aside = passed.aside();
  if (aside < parameters.touching) return passed.speed + far;
  const double curvature = parameters.lock_share * std::tan(type.max_steering) / type.wheelbase;
  const double spare = std::max(passed.gap - way_aside(aside, passed.turned, curvature), 0.0);
  const double least = passed.taken ? 0.0 : passed.manner.sideways;
  const double steady =
      std::min(passed.manner.sideways * passed.gap / aside, passed.manner.closes * spare);
  return passed.speed + std::min(far, std::max(least, steady));
}

namespace {

/// Between which places beside its path a body may be, and where it likes to be there [m].
struct Places {
  double most_left = 0, most_right = 0, liked = 0;
};

/// Those links, one close behind the other where roads between junctions are short.
std::span<const PathLink> links_ahead(const TrafficParameters& parameters, const Path& path,
                                      const Surroundings& around) {
  const auto first = path.link_from(around.along);
  const auto last = std::find_if(first, path.links.end(), [&](const PathLink& link) {
    return link.stop_line - around.along > parameters.junction_outlook;
  });
  return {first, last};
}

/// Who is about to turn filters beside its lane only on the side to which it turns: on the other
/// one the way of the lane beside, or of who goes straight on from its own, crosses its way, and
/// the two press against each other on the junction.
void keep_to_turning_side(const TrafficView& view, const Path& path, const Surroundings& around,
                          Places& places) {
  for (const PathLink& link : links_ahead(view.parameters, path, around)) {
    const int side = side_of_turn(view.model.road, link);
    const Lane& lane = view.model.road.lane(path.stretch_at(link.stop_line - 0.1).lane);
    const double within = std::max(0.5 * lane.width - around.half_width, 0.0);
    if (side < 0) places.most_left = std::min(places.most_left, within);
    if (side > 0) places.most_right = std::max(places.most_right, -within);
  }
}

/// Before a signal who filters stays over the edge of its own lane, whose light it goes by: the one
/// of the lane beside may be red when its own is green.
void keep_to_light(const TrafficView& view, const Path& path, const Surroundings& around,
                   Places& places) {
  const RoadNetwork& network = view.model.road;
  const auto link =
      std::find_if(path.link_from(around.along), path.links.end(), [&](const PathLink& ahead) {
        return ahead.stop_line >= around.along &&
               network.connection(ahead.connection).signal != kNoSignal;
      });
  if (link == path.links.end() || link->stop_line - around.along > view.parameters.junction_outlook)
    return;
  const Connection& connection = network.connection(link->connection);
  const double within = 0.5 * network.lane(connection.from).width + 0.5 * around.half_width;
  places.most_left = std::min(places.most_left, within);
  places.most_right = std::max(places.most_right, -within);
}

/// How far to the left and to the right of the path a body aims at the most where there is so much
/// room [m].
double farthest_left(const TrafficParameters& parameters, double room, double half_width) {
  return std::max(room - half_width - parameters.tight_side, 0.0);
}
double farthest_right(const TrafficParameters& parameters, double room, double half_width) {
  return std::min(half_width + parameters.tight_side - room, 0.0);
}

/// What the stretch leaves on which a body is, less at the kerb where a corner is rounded ahead:
/// there the path lies nearer to it than the middle of the lane does.
Sides sides_of(const TrafficView& view, const Path& path, const Surroundings& around) {
  const TrafficParameters& parameters = view.parameters;
  const bool left_hand = view.model.road.left_hand;
  const PathStretch& here = path.stretch_at(around.along);
  const Cut cut =
      path.cut_between(around.along - around.half_length,
                       around.along + around.half_length + parameters.time_gap * around.speed);
  Sides sides{here.room_left, here.room_right};
  double& at_kerb = left_hand ? sides.left : sides.right;
  if (here.kerb < at_kerb + parameters.tight_side)
    at_kerb -= std::max((left_hand ? cut.left : cut.right) - parameters.tight_side, 0.0);
  return sides;
}

/// Nobody passes on a junction where there is no room behind it: who is beside a bus as it turns
/// into a road with fewer lanes comes out over the middle of that or on its sidewalk.
void keep_to_exit(const TrafficView& view, const Path& path, const Surroundings& around,
                  Places& places) {
  const TrafficParameters& parameters = view.parameters;
  for (const PathLink& link : links_ahead(parameters, path, around)) {
    const PathStretch& exit = path.stretch_at(link.end + 0.1);
    if (view.model.road.lane(exit.lane).kind != LaneKind::Normal) continue;
    places.most_left =
        std::min(places.most_left, farthest_left(parameters, exit.room_left, around.half_width));
    places.most_right =
        std::max(places.most_right, farthest_right(parameters, exit.room_right, around.half_width));
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
  const Lane& lane = view.model.road.lane(id);
  if (lane.kind != LaneKind::Normal) return std::nullopt;
  const double within = 0.5 * lane.width - around.half_width - view.parameters.tight_side;
  double least = -within, most = within;
  bool any = false;
  for (const PathUser& user : around.users) {
    if (!may_be_passed(around, user) || !stands_beside_lane(view, user.row, id, user.offset))
      continue;
    const double apart = user.half_width + around.half_width + view.parameters.side_clearance;
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
  const AgentType& type = type_of(model.types, scene.type[other]);
  return type.kinematics != Kinematics::Holonomic && !is_narrow(type.width) &&
         scene.speed[other] < view.parameters.halting_speed &&
         std::abs(offset) > 0.5 * model.road.lane(lane).width && traffic.merge_to[other] != lane &&
         scene.lane[other].lane != lane;
}

namespace {

/// `over`: room over the middle of the road [m].
Places places_of(const TrafficView& view, const Path& path, const Surroundings& around,
                 std::size_t row, double over) {
  const RoadNetwork& network = view.model.road;
  const double half = around.half_width;
  const double over_left = network.left_hand ? 0.0 : over, over_right = over - over_left;
  const Sides sides = sides_of(view, path, around);
  Places places;
  places.most_left = farthest_left(view.parameters, sides.left + over_left, half);
  places.most_right = farthest_right(view.parameters, sides.right + over_right, half);
  keep_to_turning_side(view, path, around, places);
  if (over == 0.0) keep_to_light(view, path, around, places);
  // what a junction has beside its lanes is for who has to get past, and for bodies that swing
  const Lane& lane = network.lane(path.stretch_at(around.along).lane);
  const double on_lane = std::clamp(view.scene.manners[row].path_offset,
                                    std::min(places.most_right + lane.beside_right, 0.0),
                                    std::max(places.most_left - lane.beside_left, 0.0));
  keep_to_exit(view, path, around, places);
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
                  : hoped_speed(rider.view.parameters, around, offset, rider.free_speed, margin);
  }
};

/// A place, and the speed that can be hoped for there [m/s].
struct Hope {
  double place = 0, speed = 0;
};

/// The best place beside anybody who is in the way, if it is worth it. Only who is in the way is
/// passed, and not by changing lanes; wide vehicles pass narrow ones alone, on the inner side.
double pass_somebody(const Passer& passer, const Places& places, double inner_side, Hope best) {
  const TrafficParameters& parameters = passer.rider.view.parameters;
  const Surroundings& around = passer.around;
  const bool narrow = passer.narrow;
  const double half = around.half_width;
  const double worth = best.speed + (narrow ? parameters.small_gain : parameters.worthwhile_gain);
  const double gap_wanted =
      passer.over > 0.0 ? parameters.overtaking_gap : side_gap(narrow, around.speed);
  for (const PathUser& user : around.users) {
    if ((!user.aligned && !user.on_foot) || !may_be_passed(around, user)) continue;
    if (!narrow && user.half_width > 0.5 * kNarrowWidth) continue;
    if (std::abs(user.offset - places.liked) > user.half_width + half + gap_wanted) continue;
    for (const double side : {inner_side, -inner_side}) {
      if (!narrow && side != inner_side) continue;
      const double offset = narrow ? std::clamp(place_beside(parameters, around, user, side),
                                                places.most_right, places.most_left)
                                   : user.offset + side * (user.half_width + half + gap_wanted);
      if (offset > places.most_left || offset < places.most_right ||
          std::abs(offset) > parameters.farthest_aside + passer.over)
        continue;
      const double hoped =
          passer.hope(offset, narrow ? parameters.filtering_clearance : 0.9 * gap_wanted);
      if (hoped > std::max(best.speed, worth)) best = {offset, hoped};
    }
  }
  return best.place;
}

}  // namespace

double passing_offset(const TrafficView& view, const Path& path, const Surroundings& around,
                      std::size_t row) {
  const RoadNetwork& network = view.model.road;
  const double over = view.traffic.overtaking_room[row];
  const Places places = places_of(view, path, around, row, over);
  const double free_speed =
      std::min(path.profile_at(around.along), view.scene.preferred_speed[row]);
  const bool narrow = is_narrow(2.0 * around.half_width);
  const int turns = turning_side(view, path, around.along, around.speed);
  const Passer passer{around, {view, around, free_speed, turns}, narrow, over};
  const double as_liked = passer.hope(places.liked, view.parameters.tight_side);
  Hope best{places.liked, as_liked};
  // what was begun is gone on with unless something is clearly better
  const double present = view.traffic.passing_offset[row];
  if (std::abs(present - places.liked) > 0.2 && present <= places.most_left &&
      present >= places.most_right) {
    const double hoped = passer.hope(present, 0.8 * view.parameters.tight_side);
    if (hoped > best.speed + 0.3 || (narrow && best.speed < view.parameters.queue_speed))
      best = {present, std::max(best.speed, hoped)};
  }
  if (best.speed > 0.8 * free_speed) return best.place;
  if (!narrow && over == 0.0) {
    const LaneId lane = path.stretch_at(around.along).lane;
    const auto place = place_beside_tails(view, lane, around, places.liked);
    if (place &&
        passer.hope(*place, view.parameters.tight_side) > as_liked + view.parameters.small_gain)
      return *place;
  }
  // wide vehicles keep to their lane where ways cross
  if (!narrow && is_near_junction(path, around)) return places.liked;
  return pass_somebody(passer, places, network.left_hand ? -1.0 : 1.0, best);
}

}  // namespace sumogamma
