#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>

#include "geometry/smooth_step.h"
#include "road/lane_plan.h"
#include "road/path.h"
#include "road/path_pieces.h"
#include "road/smoothing.h"
#include "road/speed_profile.h"

namespace sumogamma {

namespace {

bool allows(const Lane& lane, VehicleClassMask vehicle_class) {
  return (lane.allowed & vehicle_class) != 0;
}

class Builder {
 public:
  Builder(const RoadNetwork& network, const PathRequest& request)
      : network_(network), request_(request) {}

  /// What comes now belongs to this edge of the route.
  void enter_edge(std::size_t route_index) { route_index_ = static_cast<int>(route_index); }

  /// Runs along one lane between two places on it.
  void follow(LaneId id, double from, double to) {
    const Lane& lane = network_.lane(id);
    begin_stretch(id, from);
    append_span(lane.centerline, from, std::max(to, from), points_);
    end_stretch();
  }

  /// Moves over from one lane to its neighbour on the same edge while covering [from, to] of the
  /// old one. Returns how many metres of the new lane lie beside one of the old: in a bend not one.
  double change(LaneId old_lane, LaneId new_lane, double from, double to) {
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
      points_.push_back((1.0 - blend) * start.point_at(along) +
                        blend * end.point_at(along * scale));
    }
    end_stretch();
    return scale;
  }

  /// Crosses a junction by a connection, into `beside` instead of its own lane where that is one;
  /// nullopt-like false where its internal lanes don't lead to the target.
  bool cross(ConnectionId id, LaneId beside = kNoLane) {
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

  static constexpr double kAskew = 2.0, kOneLane = 4.5;  // sideways [m]

  /// Runs along an internal lane. netconvert begins and ends links of narrow lanes up to a metre
  /// beside the lanes that they join: they are led over to them, by less than `most` [m].
  void follow_link(LaneId id, LaneId to, double most) {
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
      points_.push_back(line.point_at(along) + share(along) * before +
                        share(whole - along) * after);
    }
    end_stretch();
  }

  double length() {
    while (measured_ < points_.size()) {
      if (measured_ > 0) length_ += (points_[measured_] - points_[measured_ - 1]).norm();
      ++measured_;
    }
    return length_;
  }

  Path finish() {
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

 private:
  void begin_stretch(LaneId id, double lane_from) {
    PathStretch stretch = stretch_on(id);
    stretch.from = length();
    stretch.lane_from = lane_from;
    path_.stretches.push_back(stretch);
  }
  void end_stretch() { path_.stretches.back().to = length(); }

  /// What the lane says about a stretch on it.
  PathStretch stretch_on(LaneId id) const {
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

  const RoadNetwork& network_;
  const PathRequest& request_;
  int route_index_ = 0;
  Path path_;
  std::vector<Vec2> points_;
  std::size_t measured_ = 0;
  double length_ = 0.0;
};

/// Covers one edge from lane `entry` to lane `exit`, [from, to] along it, with lane changes spread
/// early.
LaneId cover_edge(const RoadNetwork& network, const Edge& edge, int entry, int exit, double from,
                  double to, Builder& builder) {
  const double room = to - from;
  const int changes = std::abs(exit - entry);
  int index = entry;
  double along = from;
  if (changes > 0) {
    const double speed = network.lane(edge.lanes[static_cast<std::size_t>(entry)]).speed_limit;
    double each = std::min(std::clamp(3.5 * speed, 15.0, 60.0), 0.85 * room / changes);
    const double lead_in = std::min(0.1 * room, 20.0);
    builder.follow(edge.lanes[static_cast<std::size_t>(index)], along, along + lead_in);
    along += lead_in;
    for (int k = 0; k < changes; ++k) {
      const int next = index + (exit > index ? 1 : -1);
      const double scale =
          builder.change(edge.lanes[static_cast<std::size_t>(index)],
                         edge.lanes[static_cast<std::size_t>(next)], along, along + each);
      along = (along + each) * scale;
      each *= scale;
      to *= scale;
      index = next;
    }
  }
  const LaneId lane = edge.lanes[static_cast<std::size_t>(index)];
  builder.follow(lane, along,
                 std::max(along, std::min(to, network.lane(lane).centerline.length())));
  return lane;
}

/// Where the route's edge `index` is left, along its lane `lane` [m].
double end_of(const Trip& trip, std::size_t index, const Lane& lane) {
  const double length = lane.centerline.length();
  const bool last = index + 1 == trip.route.size();
  return last && trip.request.arrival_position >= 0.0
             ? std::min(trip.request.arrival_position, length)
             : length;
}

double length_of(const RoadNetwork& network, const Edge& edge, int lane) {
  return network.lane(edge.lanes[static_cast<std::size_t>(lane)]).centerline.length();
}

/// The first stop on the route's edge `index` beyond `from` along it that has to be in a lane.
const RouteStop* stop_on_lane(const Trip& trip, std::size_t index, double from) {
  for (const RouteStop& stop : trip.request.stops)
    if (stop.route_index == index && stop.lane_index >= 0 && stop.along > from) return &stop;
  return nullptr;
}

/// Goes on from lane `entry` of the route's edge `index`, `from` along it, to the trip's end.
bool drive_on(const RoadNetwork& network, const Trip& trip, std::size_t index, int entry,
              double from, Builder& builder, std::string& why) {
  for (std::size_t i = index; i < trip.route.size(); ++i) {
    const Edge& edge = network.edge(trip.route[i]);
    builder.enter_edge(i);
    const LaneOption& option = trip.options[i][static_cast<std::size_t>(entry)];
    while (const RouteStop* stop = stop_on_lane(trip, i, from)) {
      const double scale = length_of(network, edge, entry) /
                           std::max(length_of(network, edge, stop->lane_index), 0.1);
      cover_edge(network, edge, entry, stop->lane_index, from, stop->along * scale, builder);
      entry = stop->lane_index;
      from = stop->along;
    }
    const double to = end_of(trip, i, network.lane(edge.lanes[static_cast<std::size_t>(entry)]));
    cover_edge(network, edge, entry, option.exit_index, std::min(from, to), to, builder);
    if (i + 1 == trip.route.size()) break;
    if (!builder.cross(option.next)) {
      why = "the junction after edge '" + edge.name + "' has no complete internal lane";
      return false;
    }
    entry = network.lane(network.connection(option.next).to).index;
    from = 0.0;
  }
  return true;
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

std::optional<Path> build_driving_path(const RoadNetwork& network, const PathRequest& request,
                                       std::string& why) {
  if (request.route.empty()) {
    why = "the route has no edges";
    return std::nullopt;
  }
  auto trip = std::make_shared<Trip>();
  trip->route.assign(request.route.begin(), request.route.end());
  trip->request = request;
  trip->request.route = trip->route;
  trip->options = plan_lanes(network, request);
  const std::vector<LaneOption>& options = trip->options.front();
  const Edge& first = network.edge(request.route.front());
  int entry = -1;
  if (request.start_lane != kNoLane &&
      network.lane(request.start_lane).edge == request.route.front() &&
      options[static_cast<std::size_t>(network.lane(request.start_lane).index)].cost < kUnreachable)
    entry = network.lane(request.start_lane).index;
  for (std::size_t k = 0; entry < 0 && k < first.lanes.size(); ++k) {
    const bool better = options[k].cost < kUnreachable &&
                        std::all_of(options.begin(), options.end(), [&](const LaneOption& other) {
                          return options[k].cost <= other.cost;
                        });
    if (better) entry = static_cast<int>(k);
  }
  if (entry < 0) {
    why = "no lane leads from edge '" + first.name + "' along the route to '" +
          network.edge(request.route.back()).name + "' for this vehicle class";
    return std::nullopt;
  }
  Builder builder(network, trip->request);
  if (!drive_on(network, *trip, 0, entry, request.start_along, builder, why)) return std::nullopt;
  Path path = builder.finish();
  place_stops(network, *trip, path);
  path.trip = std::move(trip);
  return path;
}

namespace {

/// A path that is made again from where its agent is: the old one, the place on its lane and what
/// is appended from there.
struct Remade {
  const RoadNetwork& network;
  const Path& path;
  double along, back;
  LaneId id;  ///< where it drives
  const PathStretch& here = path.stretch_at(along);
  const Lane& lane = network.lane(id);
  double on_lane = here.lane_from + along - here.from;
  double begin = std::max(on_lane - back, 0.0);

  bool possible() const { return path.trip && here.route_index >= 0; }
  std::size_t index() const { return static_cast<std::size_t>(here.route_index); }

  /// Goes on from lane `entry`, `from` along it, to the trip's end.
  std::optional<Path> finish(Builder& builder, int entry, double from, double& place) const {
    return finish(builder, path.trip, index(), entry, from, place);
  }
  /// Likewise to the end of another trip, from its edge `first` on.
  std::optional<Path> finish(Builder& builder, std::shared_ptr<const Trip> trip, std::size_t first,
                             int entry, double from, double& place) const {
    std::string why;
    if (!drive_on(network, *trip, first, entry, from, builder, why)) return std::nullopt;
    Path remade = builder.finish();
    place_stops(network, *trip, remade);
    remade.trip = std::move(trip);
    place = on_lane - begin;
    return remade;
  }
};

}  // namespace

namespace {

/// Is there room on the route's edge `index` for the lane changes that the trip needs from `from`
/// on lane `lane` on?
bool has_room_to_change(const Trip& trip, std::size_t index, const Lane& lane, double from) {
  constexpr double kLeast = 5.0, kMost = 24.0;  // way of a lane change [m]
  constexpr double kCar = 4.0;                  // turning radius where none is known [m]
  const double radius = trip.request.cornering.turning_radius;
  const double shortest = std::clamp(3.0 * (radius > 0.0 ? radius : kCar), kLeast, kMost);
  const LaneOption& option = trip.options[index][static_cast<std::size_t>(lane.index)];
  const RouteStop* stop = stop_on_lane(trip, index, from);
  const int changes = std::abs((stop ? stop->lane_index : option.exit_index) - lane.index);
  return from + shortest * changes / 0.85 <= (stop ? stop->along : end_of(trip, index, lane));
}

}  // namespace

std::optional<Path> change_lane(const RoadNetwork& network, const Path& path, double& along,
                                LaneId target, double distance, double back) {
  const Remade old{network, path, along, back, path.stretch_at(along).lane};
  if (!old.possible()) return std::nullopt;
  const Lane& lane = network.lane(target);
  const LaneOption& option = path.trip->options[old.index()][static_cast<std::size_t>(lane.index)];
  const double scale = lane.centerline.length() / std::max(old.lane.centerline.length(), 0.1);
  const double changed = (old.on_lane + distance) * scale;
  if (old.lane.edge != lane.edge || option.cost == kUnreachable ||
      !has_room_to_change(*path.trip, old.index(), lane, changed))
    return std::nullopt;
  Builder builder(network, path.trip->request);
  builder.enter_edge(old.index());
  builder.follow(old.here.lane, old.begin, old.on_lane);
  builder.change(old.here.lane, target, old.on_lane, old.on_lane + distance);
  return old.finish(builder, lane.index, changed, along);
}

namespace {

/// Goes on along `old`'s lane for `stay` [m] before it changes, if that leaves room for it.
std::optional<Path> stay_on(const Remade& old, double stay, double& along) {
  if (!old.possible()) return std::nullopt;
  const Trip& trip = *old.path.trip;
  const LaneOption& option = trip.options[old.index()][static_cast<std::size_t>(old.lane.index)];
  const double from = old.on_lane + stay;
  if (option.cost == kUnreachable || !has_room_to_change(trip, old.index(), old.lane, from))
    return std::nullopt;
  Builder builder(old.network, trip.request);
  builder.enter_edge(old.index());
  builder.follow(old.id, old.begin, from);
  return old.finish(builder, old.lane.index, from, along);
}

}  // namespace

std::optional<Path> stay_in_lane(const RoadNetwork& network, const Path& path, double& along,
                                 double stay, double back) {
  return stay_on({network, path, along, back, path.stretch_at(along).lane}, stay, along);
}

std::optional<Path> back_to_lane(const RoadNetwork& network, const Path& path, double& along,
                                 double back) {
  constexpr double kGivenUp = 0.65;
  const auto& stretches = path.stretches;
  for (std::size_t i = 1; i < stretches.size(); ++i) {
    const PathStretch &change = stretches[i], &before = stretches[i - 1];
    if (!change.changing || along < change.from ||
        along > change.from + kGivenUp * (change.to - change.from))
      continue;
    if (network.lane(before.lane).edge != network.lane(change.lane).edge) return std::nullopt;
    Remade old{network, path, along, back, before.lane};
    old.on_lane = before.lane_from + along - before.from;
    old.begin = std::max(old.on_lane - back, 0.0);
    return stay_on(old, 1.0, along);
  }
  return std::nullopt;
}

std::optional<Path> keep_lane(const RoadNetwork& network, const Path& path, double& along,
                              double worse, double back) {
  const Remade old{network, path, along, back, path.stretch_at(along).lane};
  if (!old.possible() || old.here.changing) return std::nullopt;
  const auto lane = static_cast<std::size_t>(old.lane.index);
  const LaneOption& option = path.trip->options[old.index()][lane];
  if (option.leave == kNoConnection || option.leave_cost > option.cost + worse) return std::nullopt;
  const Lane& next = network.lane(network.connection(option.leave).to);
  if (!has_room_to_change(*path.trip, old.index() + 1, next, 0.0)) return std::nullopt;
  Builder builder(network, path.trip->request);
  builder.enter_edge(old.index());
  builder.follow(old.id, old.begin, old.lane.centerline.length());
  if (!builder.cross(option.leave)) return std::nullopt;
  return old.finish(builder, path.trip, old.index() + 1, next.index, 0.0, along);
}

std::optional<Path> enter_beside(const RoadNetwork& network, const Path& path, double& along,
                                 LaneId target, double back) {
  const auto link = path.link_from(along);
  if (link == path.links.end() || !path.trip) return std::nullopt;
  const Connection& connection = network.connection(link->connection);
  const Lane &lane = network.lane(target), &from = network.lane(connection.from);
  const Remade old{network, path, along, back, connection.from};
  const bool on_its_lane =
      old.here.lane == connection.from || network.lane(old.here.lane).kind == LaneKind::Internal;
  const std::size_t next = old.index() + 1;
  if (lane.edge != network.lane(connection.to).edge || !old.possible() || old.here.changing ||
      !on_its_lane || next >= path.trip->options.size() ||
      path.trip->options[next][static_cast<std::size_t>(lane.index)].cost == kUnreachable)
    return std::nullopt;
  const double end = from.centerline.length();
  const double begin = std::max(0.0, end - std::max(link->stop_line - along, 0.0) - back);
  Builder builder(network, path.trip->request);
  builder.enter_edge(old.index());
  builder.follow(connection.from, begin, end);
  if (!builder.cross(link->connection, target)) return std::nullopt;
  // counted from the stop line, which both paths have
  const double past_line = along - link->stop_line;
  auto remade = old.finish(builder, path.trip, next, lane.index, 0.0, along);
  if (remade) along = remade->links.front().stop_line + past_line;
  return remade;
}

std::optional<Path> go_on_from(const RoadNetwork& network, const Path& path, double& along,
                               LaneId lane, ConnectionId link, double on_lane, double back) {
  constexpr double kStays = 60.0, kShortest = 5.0;  // [m]
  if (!path.trip) return std::nullopt;
  const Trip& trip = *path.trip;
  const Lane& there = network.lane(lane);
  const auto here = static_cast<std::size_t>(std::max(path.stretch_at(along).route_index - 1, 0));
  const auto edge = std::find(trip.route.begin() + static_cast<std::ptrdiff_t>(here),
                              trip.route.end(), there.edge);
  if (edge == trip.route.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(edge - trip.route.begin());
  const auto option_of = [&](std::size_t of, const Lane& on) -> const LaneOption& {
    return trip.options[of][static_cast<std::size_t>(on.index)];
  };
  const double end = there.centerline.length();
  const double start = std::clamp(on_lane - back, 0.0, end);
  double stays = link == kNoConnection ? kStays : 0.0;
  while (stays > kShortest && (option_of(index, there).cost == kUnreachable ||
                               !has_room_to_change(trip, index, there, on_lane + stays)))
    stays *= 0.5;
  const bool changes = stays > kShortest;
  if (link == kNoConnection && !changes) link = option_of(index, there).leave;
  const Lane* next = link == kNoConnection ? nullptr : &network.lane(network.connection(link).to);
  if (next != nullptr && (index + 1 >= trip.route.size() || next->edge != trip.route[index + 1]))
    return std::nullopt;
  std::string why;
  // as far as the trip's lanes lead on from there, else to the end of the lane
  for (const bool to_the_end : {true, false}) {
    Builder builder(network, trip.request);
    builder.enter_edge(index);
    builder.follow(lane, start, changes ? std::min(on_lane + stays, end) : end);
    if (next != nullptr && !builder.cross(link)) return std::nullopt;
    if (to_the_end) {
      const bool leads_on =
          changes ? drive_on(network, trip, index, there.index, std::min(on_lane + stays, end),
                             builder, why)
                  : next != nullptr && option_of(index + 1, *next).cost < kUnreachable &&
                        drive_on(network, trip, index + 1, next->index, 0.0, builder, why);
      if (!leads_on) continue;
    } else if (next != nullptr) {
      builder.enter_edge(index + 1);
      builder.follow(network.connection(link).to, 0.0, next->centerline.length());
    }
    Path made = builder.finish();
    place_stops(network, trip, made);
    made.trip = path.trip;
    along = on_lane - start;
    return made;
  }
  return std::nullopt;
}

std::optional<Path> take_route(const RoadNetwork& network, const Path& path, double& along,
                               std::vector<EdgeId> route, double back) {
  const Remade old{network, path, along, back, path.stretch_at(along).lane};
  const bool halts = std::any_of(path.stops.begin(), path.stops.end(),
                                 [&](const PathStop& stop) { return stop.along > along; });
  if (!old.possible() || halts || old.here.changing || route.empty() ||
      route.front() != old.lane.edge)
    return std::nullopt;
  auto trip = std::make_shared<Trip>();
  trip->route = std::move(route);
  trip->request = path.trip->request;
  trip->request.route = trip->route;
  trip->request.stops.clear();
  trip->options = plan_lanes(network, trip->request);
  const LaneOption& option = trip->options.front()[static_cast<std::size_t>(old.lane.index)];
  if (option.cost == kUnreachable || option.exit_index != old.lane.index) return std::nullopt;
  Builder builder(network, trip->request);
  return old.finish(builder, trip, 0, old.lane.index, old.begin, along);
}

Path with_speed_limits(const Path& path, const std::vector<double>& limits) {
  Path changed = path;
  for (PathStretch& stretch : changed.stretches)
    if (stretch.lane != kNoLane) stretch.speed_limit = limits[index_of(stretch.lane)];
  compute_speed_profile(path.trip->request, changed);
  return changed;
}

}  // namespace sumogamma
