#include "realism/road_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/units.h"
#include "realism/scene_export.h"
#include "road/signal_program.h"
#include "scene/behavior_draw.h"
#include "simulation/advance.h"

namespace sumogamma {

namespace {

constexpr double kFactorSpread = 0.1;   // of SUMO's default speedFactor
constexpr double kLeastWay = 1.0;       // of a path on its first lane [m]
constexpr double kMostAside = 1.0;      // liked place beside a path [m]
constexpr double kRoadsOnward = 400.0;  // roads behind the route's end that somebody may need [m]
constexpr double kBeforeEnd = 5.0;      // of its path somebody leaves the map [m]

VehicleClassMask classes_of(const RecordedScene& scene, const RecordedAgent& agent) {
  return vehicle_class_from_name(type_of(scene.types, agent.type).sumo_class);
}

/// Goes on behind the route's end, as straight as may be, so that it doesn't end in a window.
void lengthen(const RoadNetwork& network, VehicleClassMask classes, MatchedRoute& route) {
  for (double way = 0; way < kRoadsOnward;) {
    EdgeId next = kNoEdge;
    for (const LaneId id : network.edge(route.edges.back()).lanes)
      for (const ConnectionId link : network.lane(id).outgoing) {
        const Connection& connection = network.connection(link);
        const EdgeId to = network.lane(connection.to).edge;
        if ((network.lane(connection.to).allowed & classes) == 0) continue;
        if (next == kNoEdge || connection.direction == TurnDirection::Straight) next = to;
      }
    if (next == kNoEdge) return;
    route.edges.push_back(next);
    way += network.lane(network.edge(next).lanes.front()).length;
  }
}

/// What the programs of all signals show, and since when.
void show_signals(const RoadNetwork& network, double time, RoadState& road) {
  for (std::size_t k = 0; k < network.signals.size(); ++k) {
    const std::optional<ProgramPlace> at = program_at(network.signals[k], time);
    if (!at) continue;
    const SignalPhase& phase = network.signals[k].phases[at->phase];
    road.signal_states[k] = phase.state;
    road.signal_since[k] = at->since;
    road.amber_until[k] = at->since + phase.duration;
  }
}

/// Everybody, by kScoreStep.
void move_on(const Advance& world) {
  for (int k = 0; k < kModelStepsAPose; ++k) {
    show_signals(world.model.road, world.scene.time, world.road);
    advance_rows(world, {kModelStep, true, true});
  }
}

}  // namespace

RecordedRoad put_on_road(const std::filesystem::path& network, Workers& workers,
                         RecordedScene& scene) {
  RecordedRoad on{network, read_road(network, {}, workers), {}, 0, 0, 0};
  std::vector<RecordedAgent> kept;
  std::size_t points = 0, near = 0;
  for (RecordedAgent& agent : scene.agents) {
    const AgentType& type = type_of(scene.types, agent.type);
    if (type.kinematics == Kinematics::Holonomic) {
      ++on.people;
      continue;
    }
    const VehicleClassMask classes = vehicle_class_from_name(type.sumo_class);
    MatchedRoute route = match_route(on.road.network, agent, classes);
    const bool off =
        static_cast<double>(route.near) < kLeastOnRoutes * static_cast<double>(route.points);
    if (type.sumo_class == "bicycle" && off) {
      ++on.beside_lanes;
      continue;
    }
    points += route.points;
    near += route.near;
    on.no_route += route.edges.empty();
    if (route.edges.empty()) continue;
    lengthen(on.road.network, classes, route);
    on.routes.push_back(std::move(route));
    kept.push_back(std::move(agent));
  }
  if (static_cast<double>(near) < kLeastOnRoutes * static_cast<double>(points) || kept.empty())
    throw Error(network.string(),
                fmt::format("{} of {} points of the recording's motor vehicles lie within {} m of "
                            "a route on it, expected {:.0f} %",
                            near, points, kOnRoute, 100.0 * kLeastOnRoutes));
  scene.agents = std::move(kept);
  return on;
}

double limit_factor(double speed, double limit, std::uint64_t seed, std::uint32_t id) {
  const double draw = random_normal(seed, id, 0, Draw::DesiredSpeed);
  return std::max(std::clamp(1.0 + kFactorSpread * draw, 0.2, 2.0), speed / std::max(limit, 1.0));
}

RoutePlace place_on_route(const RoadNetwork& network, const MatchedRoute& route,
                          const MotionState& state, VehicleClassMask classes) {
  RoutePlace best;
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](std::size_t edge, LaneId lane, LaneId on) {
    const Polyline& line = network.lane(on).centerline;
    const PolylinePosition at = line.project(state.position);
    const double turned =
        std::abs(wrap_angle(heading_of(line.direction_at(at.along)) - state.heading));
    const double cost = at.distance + (turned > radians(kSameWay) ? 10.0 : turned);
    if (cost >= least) return;
    least = cost;
    const double length = network.lane(lane).centerline.length();
    best = {edge, lane, on == lane ? at.along : length, on};
  };
  for (std::size_t edge = 0; edge < route.edges.size(); ++edge)
    for (const LaneId id : network.edge(route.edges[edge]).lanes) {
      if ((network.lane(id).allowed & classes) == 0) continue;
      offer(edge, id, id);
      for (const ConnectionId link : network.lane(id).outgoing) {
        const Connection& connection = network.connection(link);
        const bool onward = edge + 1 < route.edges.size() &&
                            network.lane(connection.to).edge == route.edges[edge + 1];
        for (LaneId via = onward ? connection.via : kNoLane; via != kNoLane;) {
          offer(edge, id, via);
          const std::vector<ConnectionId>& ahead = network.lane(via).outgoing;
          via = ahead.empty() ? kNoLane : network.connection(ahead.front()).via;
        }
      }
    }
  return best;
}

RoadLoop::RoadLoop(const RecordedScene& scene, const RecordedRoad& road,
                   const ModelOptions& options, const AgentTypeTable& behavior, Workers& workers)
    : scene_(scene), road_(road), workers_(workers) {
  model_.types = behaving_as(scene.types, behavior);
  model_.kinematics = build_kinematic_tables(model_.types, workers);
  model_.road = road.road.network;
  model_.conflicts = road.road.conflicts;
  model_.swept_ways = road.road.swept_ways;
  model_.options = options;
  model_.options.step = kModelStep;
  model_.options.keep_left = model_.road.left_hand;
  model_.road.obstacles.insert(model_.road.obstacles.end(), scene.obstacles.begin(),
                               scene.obstacles.end());
  model_.obstacles = ObstacleIndex(model_.road.obstacles);
}

std::shared_ptr<const Path> RoadLoop::path_of(const RecordedAgent& who, const MotionState& state,
                                              double factor) const {
  const AgentType& type = type_of(model_.types, who.type);
  const auto row = static_cast<std::size_t>(&who - scene_.agents.data());
  const MatchedRoute& route = road_.routes[row];
  const RoutePlace place = place_on_route(model_.road, route, state, classes_of(scene_, who));
  PathRequest request;
  request.route = std::span(route.edges).subspan(place.edge);
  request.vehicle_class = classes_of(scene_, who);
  request.start_lane = place.lane;
  const double length = model_.road.lane(place.lane).centerline.length();
  request.start_along = std::clamp(place.along - kLeastWay, 0.0, std::max(0.0, length - kLeastWay));
  request.max_lateral_acceleration = type.max_lateral_acceleration;
  request.comfortable_deceleration = type.comfortable_deceleration;
  request.max_speed = type.max_speed;
  request.speed_factor = factor;
  if (type.kinematics == Kinematics::SingleTrack)
    request.cornering = {1.1 * type.wheelbase / std::tan(type.max_steering), who.length, who.width,
                         model_.road.left_hand};
  std::string why;
  auto path = build_driving_path(model_.road, request, why);
  if (!path)
    throw Error(road_.file.string(), fmt::format("has no way for agent {} from {}: {}", who.id,
                                                 model_.road.lane(place.lane).name, why));
  return std::make_shared<const Path>(std::move(*path));
}

RoadState RoadLoop::unlit_road() const {
  RoadState road;
  road.signal_states.resize(model_.road.signals.size());
  road.signal_since.resize(model_.road.signals.size());
  road.amber_until.resize(model_.road.signals.size());
  return road;
}

void RoadLoop::complete(const RecordedAgent& who, const MotionState& state, std::uint64_t seed,
                        RoadState& road, AgentState& row) const {
  const AgentType& type = type_of(model_.types, who.type);
  const auto at = static_cast<std::size_t>(&who - scene_.agents.data());
  const double limit = model_.road.lane(road_.routes[at].from).speed_limit;
  const double factor = limit_factor(row.speed, limit, seed, who.id);
  auto path = path_of(who, state, factor);
  row.preferred_speed = type.sumo_class == "bicycle"
                            ? std::max(row.speed, type.preferred_speed * factor)
                            : type.max_speed;
  row.behavior = draw_behavior(type, seed, who.id);
  row.behavior.intention.kind = IntentionKind::Path;
  row.manners = draw_manners(type.compliance, seed, who.id);
  // whoever is beside the middle likes to be there
  row.manners.path_offset =
      std::clamp(path->line.project(row.position).offset, -kMostAside, kMostAside);
  row.path = static_cast<PathId>(road.paths.size());
  road.paths.push_back(std::move(path));
}

Rollout RoadLoop::drive(const ScoreWindow& window, std::uint64_t seed, EntryCounts& entries) const {
  Rollout rollout{Poses(window.agents.size()), std::vector<bool>(window.agents.size(), false)};
  EntryCounts counts;
  RoadState road = unlit_road();
  WindowCast cast(scene_, window,
                  [&](const RecordedAgent& who, const MotionState& state, AgentState& row) {
                    complete(who, state, seed, road, row);
                  });
  Traffic traffic;
  AdvanceWork work;
  cast.scene().time = kScoreStep * (window.start - scene_.first);
  const Advance world{model_, workers_, road, cast.scene(), traffic, work};
  for (std::size_t step = 0; step < Poses::kSteps; ++step) {
    const int now = window.start + static_cast<int>(step);
    cast.let_leave(now);
    cast.let_enter(now, counts);
    cast.note(step, rollout);
    if (step + 1 < Poses::kSteps) move_on(world);
  }
  counts.shut_out = window.entering.size() - counts.entered;
  entries.add(counts);
  return rollout;
}

FreeRun RoadLoop::drive_freely(std::uint64_t seed) const {
  RoadState road = unlit_road();
  std::vector<double> ends;  // by id [m along its path]
  WindowCast cast(scene_, [&](const RecordedAgent& who, const MotionState& state, AgentState& row) {
    complete(who, state, seed, road, row);
    const Path& path = *road.paths.back();
    const double length = path.line.length() - kBeforeEnd;
    const bool leaves = who.last() < scene_.last;
    ends.push_back(leaves ? std::min(length, path.line.project(who.position.back()).along)
                          : length);
  });
  Traffic traffic;
  AdvanceWork work;
  const Advance world{model_, workers_, road, cast.scene(), traffic, work};
  return sumogamma::drive_freely(scene_, cast,
                                 {[&] { move_on(world); },
                                  [&](std::size_t row) {
                                    return cast.scene().path_along[row] >=
                                           ends[cast.scene().id[row].value];
                                  }});
}

}  // namespace sumogamma
