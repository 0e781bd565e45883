#include "road/replan.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>

#include "road/lane_plan.h"
#include "road/path_builder.h"
#include "road/speed_profile.h"

namespace sumogamma {

namespace {

const LaneOption& option_of(const Trip& trip, std::size_t edge, const Lane& lane) {
  return trip.options[edge][static_cast<std::size_t>(lane.index)];
}

/// Is there room on the route's edge `index` for the lane changes that the trip needs from `from`
/// on lane `lane` on?
bool has_room_to_change(const Trip& trip, std::size_t index, const Lane& lane, double from) {
  constexpr double kLeast = 5.0, kMost = 24.0;  // way of a lane change [m]
  constexpr double kCar = 4.0;                  // turning radius where none is known [m]
  const double radius = trip.request.cornering.turning_radius;
  const double shortest = std::clamp(3.0 * (radius > 0.0 ? radius : kCar), kLeast, kMost);
  const RouteStop* stop = stop_on_lane(trip, index, from);
  const int exit = stop ? stop->lane_index : option_of(trip, index, lane).exit_index;
  const double end = stop ? stop->along : end_of(trip, index, lane);
  return from + shortest * std::abs(exit - lane.index) / 0.85 <= end;
}

/// Where somebody is on the lane that it drives, and what its new path begins with.
struct Start {
  const Replan& old;
  LaneId id = old.path.stretch_at(old.along).lane;
  const PathStretch& here = old.path.stretch_at(old.along);
  const Lane& lane = old.network.lane(id);
  double on_lane = here.lane_from + old.along - here.from;
  double begin = std::max(on_lane - old.back, 0.0);

  bool possible() const { return old.path.trip && here.route_index >= 0; }
  const Trip& trip() const { return *old.path.trip; }
  std::size_t edge() const { return static_cast<std::size_t>(here.route_index); }
  /// A builder that has come along the lane to `to`.
  PathBuilder follow(double to) const {
    PathBuilder builder(old.network, trip().request);
    builder.enter_edge(edge());
    builder.follow(id, begin, to);
    return builder;
  }
  /// Goes on from there as the trip does.
  std::optional<Replanned> finish(PathBuilder& builder, const TripPlace& onward) const {
    std::string why;
    if (!builder.drive_on(trip(), onward, why)) return std::nullopt;
    return Replanned{builder.finish(old.path.trip), on_lane - begin};
  }
};

/// Goes on along the lane for `stay` [m] before it changes, if that leaves room for it.
std::optional<Replanned> stay_on(const Start& start, double stay) {
  if (!start.possible()) return std::nullopt;
  const double to = start.on_lane + stay;
  if (option_of(start.trip(), start.edge(), start.lane).cost == kUnreachable ||
      !has_room_to_change(start.trip(), start.edge(), start.lane, to))
    return std::nullopt;
  PathBuilder builder = start.follow(to);
  return start.finish(builder, {start.edge(), start.lane.index, to});
}

}  // namespace

std::optional<Replanned> change_lane(const Replan& from, LaneId target, double distance) {
  const Start start{from};
  if (!start.possible()) return std::nullopt;
  const Lane& lane = from.network.lane(target);
  const double scale = lane.centerline.length() / std::max(start.lane.centerline.length(), 0.1);
  const double changed = (start.on_lane + distance) * scale;
  if (start.lane.edge != lane.edge ||
      option_of(start.trip(), start.edge(), lane).cost == kUnreachable ||
      !has_room_to_change(start.trip(), start.edge(), lane, changed))
    return std::nullopt;
  PathBuilder builder = start.follow(start.on_lane);
  builder.change(start.id, target, start.on_lane, start.on_lane + distance);
  return start.finish(builder, {start.edge(), lane.index, changed});
}

std::optional<Replanned> stay_in_lane(const Replan& from, double stay) {
  return stay_on(Start{from}, stay);
}

std::optional<Replanned> back_to_lane(const Replan& from) {
  constexpr double kGivenUp = 0.65;
  const auto& stretches = from.path.stretches;
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const PathStretch &change = stretches[i], &before = stretches[i - 1];
    if (!change.changing || from.along < change.from ||
        from.along > change.from + kGivenUp * (change.to - change.from))
      continue;
    if (from.network.lane(before.lane).edge != from.network.lane(change.lane).edge)
      return std::nullopt;
    Start start{from, before.lane};
    start.on_lane = before.lane_from + from.along - before.from;
    start.begin = std::max(start.on_lane - from.back, 0.0);
    return stay_on(start, 1.0);
  }
  return std::nullopt;
}

std::optional<Replanned> keep_lane(const Replan& from, double worse) {
  const Start start{from};
  if (!start.possible() || start.here.changing) return std::nullopt;
  const LaneOption& option = option_of(start.trip(), start.edge(), start.lane);
  if (option.leave == kNoConnection || option.leave_cost > option.cost + worse) return std::nullopt;
  const Lane& next = from.network.lane(from.network.connection(option.leave).to);
  if (!has_room_to_change(start.trip(), start.edge() + 1, next, 0.0)) return std::nullopt;
  PathBuilder builder = start.follow(start.lane.centerline.length());
  if (!builder.cross(option.leave)) return std::nullopt;
  return start.finish(builder, {start.edge() + 1, next.index, 0.0});
}

std::optional<Replanned> enter_beside(const Replan& from, LaneId target) {
  const auto link = from.path.link_from(from.along);
  if (link == from.path.links.end() || !from.path.trip) return std::nullopt;
  const Connection& connection = from.network.connection(link->connection);
  const Lane& lane = from.network.lane(target);
  Start start{from, connection.from};
  const bool on_its_lane = start.here.lane == connection.from ||
                           from.network.lane(start.here.lane).kind == LaneKind::Internal;
  const std::size_t next = start.edge() + 1;
  if (lane.edge != from.network.lane(connection.to).edge || !start.possible() ||
      start.here.changing || !on_its_lane || next >= start.trip().options.size() ||
      option_of(start.trip(), next, lane).cost == kUnreachable)
    return std::nullopt;
  const double end = start.lane.centerline.length();
  start.begin = std::max(0.0, end - std::max(link->stop_line - from.along, 0.0) - from.back);
  PathBuilder builder = start.follow(end);
  if (!builder.cross(link->connection, target)) return std::nullopt;
  auto remade = start.finish(builder, {next, lane.index, 0.0});
  // counted from the stop line, which both paths have
  if (remade) remade->along = remade->path.links.front().stop_line + (from.along - link->stop_line);
  return remade;
}

namespace {

/// How somebody leaves the lane onto which it has been put.
struct WayOut {
  std::size_t edge = 0;               ///< of the route
  double until = 0;                   ///< it keeps to the lane up to here [m]
  bool changes = false;               ///< lanes, from there on
  ConnectionId link = kNoConnection;  ///< it takes
  const Lane* next = nullptr;         ///< where that leads
};

/// nullopt where the link leads off the route.
std::optional<WayOut> way_out(const RoadNetwork& network, const Trip& trip, std::size_t edge,
                              const LanePlace& place) {
  constexpr double kStays = 60.0, kShortest = 5.0;  // [m]
  const Lane& lane = network.lane(place.lane);
  const double end = lane.centerline.length();
  const LaneOption& option = option_of(trip, edge, lane);
  double stays = place.link == kNoConnection ? kStays : 0.0;
  while (stays > kShortest && (option.cost == kUnreachable ||
                               !has_room_to_change(trip, edge, lane, place.along + stays)))
    stays *= 0.5;
  WayOut out{edge, end, stays > kShortest, place.link, nullptr};
  if (out.changes) out.until = std::min(place.along + stays, end);
  if (out.link == kNoConnection && !out.changes) out.link = option.leave;
  if (out.link == kNoConnection) return out;
  out.next = &network.lane(network.connection(out.link).to);
  if (edge + 1 >= trip.route.size() || out.next->edge != trip.route[edge + 1]) return std::nullopt;
  return out;
}

/// As far as the trip's lanes lead on from there; false where they don't.
bool lead_on(const Trip& trip, const Lane& lane, const WayOut& out, PathBuilder& builder) {
  std::string why;
  if (out.changes) return builder.drive_on(trip, {out.edge, lane.index, out.until}, why);
  return out.next != nullptr && option_of(trip, out.edge + 1, *out.next).cost < kUnreachable &&
         builder.drive_on(trip, {out.edge + 1, out.next->index, 0.0}, why);
}

}  // namespace

std::optional<Replanned> go_on_from(const Replan& from, const LanePlace& place) {
  if (!from.path.trip) return std::nullopt;
  const RoadNetwork& network = from.network;
  const Trip& trip = *from.path.trip;
  const Lane& lane = network.lane(place.lane);
  const int here = std::max(from.path.stretch_at(from.along).route_index - 1, 0);
  const auto edge = std::find(trip.route.begin() + here, trip.route.end(), lane.edge);
  if (edge == trip.route.end()) return std::nullopt;
  const auto out =
      way_out(network, trip, static_cast<std::size_t>(edge - trip.route.begin()), place);
  if (!out) return std::nullopt;
  const double start = std::clamp(place.along - from.back, 0.0, lane.centerline.length());
  // to the trip's end, else to the end of the lane
  for (const bool to_the_end : {true, false}) {
    PathBuilder builder(network, trip.request);
    builder.enter_edge(out->edge);
    builder.follow(place.lane, start, out->until);
    if (out->next != nullptr && !builder.cross(out->link)) return std::nullopt;
    if (to_the_end && !lead_on(trip, lane, *out, builder)) continue;
    if (!to_the_end && out->next != nullptr) {
      builder.enter_edge(out->edge + 1);
      builder.follow(network.connection(out->link).to, 0.0, out->next->centerline.length());
    }
    return Replanned{builder.finish(from.path.trip), place.along - start};
  }
  return std::nullopt;
}

std::optional<Replanned> take_route(const Replan& from, std::vector<EdgeId> route) {
  const Start start{from};
  const bool halts = std::any_of(from.path.stops.begin(), from.path.stops.end(),
                                 [&](const PathStop& stop) { return stop.along > from.along; });
  if (!start.possible() || halts || start.here.changing || route.empty() ||
      route.front() != start.lane.edge)
    return std::nullopt;
  auto trip = std::make_shared<Trip>();
  trip->route = std::move(route);
  trip->request = start.trip().request;
  trip->request.route = trip->route;
  trip->request.stops.clear();
  trip->options = plan_lanes(from.network, trip->request);
  const LaneOption& option = option_of(*trip, 0, start.lane);
  if (option.cost == kUnreachable || option.exit_index != start.lane.index) return std::nullopt;
  std::string why;
  PathBuilder builder(from.network, trip->request);
  if (!builder.drive_on(*trip, {0, start.lane.index, start.begin}, why)) return std::nullopt;
  return Replanned{builder.finish(std::move(trip)), start.on_lane - start.begin};
}

Path with_speed_limits(const Path& path, const std::vector<double>& limits) {
  Path changed = path;
  for (PathStretch& stretch : changed.stretches)
    if (stretch.lane != kNoLane) stretch.speed_limit = limits[index_of(stretch.lane)];
  compute_speed_profile(path.trip->request, changed);
  return changed;
}

}  // namespace sumogamma
