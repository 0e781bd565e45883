#include "road/path_builder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "geometry/smooth_step.h"
#include "road/path_pieces.h"
#include "road/smoothing.h"
#include "road/speed_profile.h"

namespace sumogamma {

namespace {

constexpr double kAskew = 2.0, kOneLane = 4.5;  // sideways [m]

double length_of(const RoadNetwork& network, const Edge& edge, int lane) {
  return network.lane(edge.lanes[static_cast<std::size_t>(lane)]).centerline.length();
}

/// Adds the halts of a trip to a path of it, but for those behind its beginning.
void place_stops(const RoadNetwork& network, const Trip& trip, Path& path) {
  constexpr double kForever = std::numeric_limits<double>::infinity();
  constexpr double kSame = 0.5;  // [m]
  for (const RouteStop& stop : trip.request.stops) {
    for (const PathStretch& stretch : path.stretches) {
      if (stretch.route_index != static_cast<int>(stop.route_index) ||
          network.lane(stretch.lane).kind == LaneKind::Internal)
        continue;
      const double place = stretch.from + stop.along - stretch.lane_from;
      if (place > stretch.to + kSame) continue;
      if (place > -kSame)
        path.stops.push_back({std::max(place, stretch.from), kForever, stop.room, stop.plan});
      break;
    }
  }
}

}  // namespace

double end_of(const Trip& trip, std::size_t index, const Lane& lane) {
  const double length = lane.centerline.length();
  const bool last = index + 1 == trip.route.size();
  return last && trip.request.arrival_position >= 0.0
             ? std::min(trip.request.arrival_position, length)
             : length;
}

const RouteStop* stop_on_lane(const Trip& trip, std::size_t index, double from) {
  for (const RouteStop& stop : trip.request.stops)
    if (stop.route_index == index && stop.lane_index >= 0 && stop.along > from) return &stop;
  return nullptr;
}

void PathBuilder::begin_stretch(LaneId id, double lane_from) {
  PathStretch stretch = stretch_on(id);
  stretch.from = length();
  stretch.lane_from = lane_from;
  path_.stretches.push_back(stretch);
}

// What the lane says about a stretch on it.
PathStretch PathBuilder::stretch_on(LaneId id) const {
  const Lane& lane = network_.lane(id);
  PathStretch stretch;
  stretch.lane = id;
  stretch.route_index = route_index_;
  stretch.speed_limit =
      request_.speed_limits ? (*request_.speed_limits)[index_of(id)] : lane.speed_limit;
  const auto may_use = [&](const Lane& beside) { return allows(beside, request_.vehicle_class); };
  const double inner = 0.5 * lane.width + width_beside(network_, lane, true, may_use);
  const double outer = 0.5 * lane.width + width_beside(network_, lane, false, may_use);
  // lanes count from the kerb, so the inner side is the left one unless traffic keeps left
  stretch.room_left = (network_.left_hand ? outer : inner) + lane.beside_left;
  stretch.room_right = (network_.left_hand ? inner : outer) + lane.beside_right;
  stretch.kerb = width_to_kerb(network_, lane);
  return stretch;
}

double PathBuilder::length() {
  while (measured_ < points_.size()) {
    if (measured_ > 0) length_ += (points_[measured_] - points_[measured_ - 1]).norm();
    ++measured_;
  }
  return length_;
}

void PathBuilder::follow(LaneId id, double from, double to) {
  const Lane& lane = network_.lane(id);
  begin_stretch(id, from);
  append_span(lane.centerline, from, std::max(to, from), points_);
  end_stretch();
}

double PathBuilder::change(LaneId old_lane, LaneId new_lane, double from, double to) {
  const Polyline& start = network_.lane(old_lane).centerline;
  const Polyline& end = network_.lane(new_lane).centerline;
  const double scale = start.length() > 0 ? end.length() / start.length() : 1.0;
  begin_stretch(new_lane, from * scale);
  // the kerb is as near as seen from either lane
  PathStretch& stretch = path_.stretches.back();
  stretch.changing = true;
  const PathStretch beside = stretch_on(old_lane);
  stretch.room_left = std::min(stretch.room_left, beside.room_left);
  stretch.room_right = std::min(stretch.room_right, beside.room_right);
  const int steps = std::max(4, static_cast<int>((to - from) / 3.0));
  for (int k = 0; k <= steps; ++k) {
    const double t = static_cast<double>(k) / steps;
    const double blend = smooth_step(t);
    const double along = from + t * (to - from);
    points_.push_back((1.0 - blend) * start.point_at(along) + blend * end.point_at(along * scale));
  }
  end_stretch();
  return scale;
}

bool PathBuilder::cross(ConnectionId id, LaneId beside) {
  const Connection& connection = network_.connection(id);
  const LaneId to = beside == kNoLane ? connection.to : beside;
  PathLink link{id, length(), 0.0, std::max(length() - connection.setback, 0.0), length()};
  const bool may_wait = may_stop_inside(network_, connection);
  LaneId lane = connection.via;
  for (int hops = 0; lane != kNoLane; ++hops) {
    if (hops > 8) return false;
    LaneId next = kNoLane;
    bool arrived = false;
    for (const ConnectionId onward : network_.lane(lane).outgoing) {
      if (network_.connection(onward).to != connection.to) continue;
      next = network_.connection(onward).via;
      arrived = true;
      break;
    }
    follow_link(lane, next == kNoLane ? to : kNoLane, beside == kNoLane ? kAskew : kOneLane);
    if (!arrived && !network_.lane(lane).outgoing.empty()) return false;
    if (hops == 0 && next != kNoLane && may_wait) link.inside = length();
    lane = next;
  }
  link.end = length();
  path_.links.push_back(link);
  return true;
}

// Runs along an internal lane. netconvert begins and ends links of narrow lanes up to a metre
// beside the lanes that they join: they are led over to them, by less than `most` [m].
void PathBuilder::follow_link(LaneId id, LaneId to, double most) {
  constexpr double kStep = 0.3;                        // sideways [m]
  constexpr double kReach = kEntryReach, kEach = 1.0;  // along the link [m]
  const Polyline& line = network_.lane(id).centerline;
  const double whole = line.length(), reach = std::min(0.5 * whole, kReach);
  const auto step = [&](const Vec2& there, double along) -> Vec2 {
    const Vec2 way = there - line.point_at(along);
    const double aside = std::abs(sumogamma::cross(line.direction_at(along), way));
    if (aside <= kStep || way.norm() >= most) return Vec2::Zero();
    return way;
  };
  const Vec2 before = step(points_.empty() ? line.point_at(0.0) : points_.back(), 0.0);
  const Vec2 after = step(
      to == kNoLane ? line.point_at(whole) : network_.lane(to).centerline.point_at(0.0), whole);
  if (reach < kEach || (before.isZero() && after.isZero())) return follow(id, 0.0, whole);
  begin_stretch(id, 0.0);
  const auto share = [&](double way) {
    return smooth_step(std::clamp(1.0 - way / reach, 0.0, 1.0));
  };
  const int pieces = static_cast<int>(std::ceil(whole / kEach));
  for (int k = 0; k <= pieces; ++k) {
    const double along = whole * k / pieces;
    points_.push_back(line.point_at(along) + share(along) * before + share(whole - along) * after);
  }
  end_stretch();
}

// Covers one edge from a place on it to lane `exit`, `to` along the lane that it begins on, with
// lane changes spread early.
void PathBuilder::cover_edge(const Edge& edge, const TripPlace& from, int exit, double to) {
  const double room = to - from.along;
  const int changes = std::abs(exit - from.lane);
  int index = from.lane;
  double along = from.along;
  if (changes > 0) {
    const double speed = network_.lane(edge.lanes[static_cast<std::size_t>(index)]).speed_limit;
    double each = std::min(std::clamp(3.5 * speed, 15.0, 60.0), 0.85 * room / changes);
    const double lead_in = std::min(0.1 * room, 20.0);
    follow(edge.lanes[static_cast<std::size_t>(index)], along, along + lead_in);
    along += lead_in;
    for (int k = 0; k < changes; ++k) {
      const int next = index + (exit > index ? 1 : -1);
      const double scale = change(edge.lanes[static_cast<std::size_t>(index)],
                                  edge.lanes[static_cast<std::size_t>(next)], along, along + each);
      along = (along + each) * scale;
      each *= scale;
      to *= scale;
      index = next;
    }
  }
  const LaneId lane = edge.lanes[static_cast<std::size_t>(index)];
  follow(lane, along, std::max(along, std::min(to, network_.lane(lane).centerline.length())));
}

bool PathBuilder::drive_on(const Trip& trip, TripPlace from, std::string& why) {
  for (;; ++from.edge) {
    const Edge& edge = network_.edge(trip.route[from.edge]);
    enter_edge(from.edge);
    const LaneOption& option = trip.options[from.edge][static_cast<std::size_t>(from.lane)];
    while (const RouteStop* stop = stop_on_lane(trip, from.edge, from.along)) {
      const double scale = length_of(network_, edge, from.lane) /
                           std::max(length_of(network_, edge, stop->lane_index), 0.1);
      cover_edge(edge, from, stop->lane_index, stop->along * scale);
      from.lane = stop->lane_index;
      from.along = stop->along;
    }
    const LaneId lane = edge.lanes[static_cast<std::size_t>(from.lane)];
    const double to = end_of(trip, from.edge, network_.lane(lane));
    from.along = std::min(from.along, to);
    cover_edge(edge, from, option.exit_index, to);
    if (from.edge + 1 == trip.route.size()) return true;
    if (!cross(option.next)) {
      why = "the junction after edge '" + edge.name + "' has no complete internal lane";
      return false;
    }
    from.lane = network_.lane(network_.connection(option.next).to).index;
    from.along = 0.0;
  }
}

Path PathBuilder::finish() {
  path_.line = Polyline(points_);
  round_corners(request_.cornering, path_);
  move_stop_lines(network_, path_);
  path_.arrival = path_.line.length();
  if (path_.stretches.empty()) path_.stretches.push_back({});
  path_.stretches.back().to = path_.arrival;
  compute_speed_profile(request_, path_);
  // every agent keeps one
  path_.stretches.shrink_to_fit();
  path_.links.shrink_to_fit();
  return std::move(path_);
}

Path PathBuilder::finish(std::shared_ptr<const Trip> trip) {
  Path path = finish();
  place_stops(network_, *trip, path);
  path.trip = std::move(trip);
  return path;
}

}  // namespace sumogamma
