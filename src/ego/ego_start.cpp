#include "ego/ego_start.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/number_text.h"
#include "base/random.h"
#include "road/route_search.h"
#include "scene/extent.h"

namespace sumogamma {

namespace {

constexpr double kSpare = 25.0;  // of a drawn route beyond the goal: nobody arrives before it [m]

bool is_for_drivers(const Lane& lane, VehicleClassMask vehicle_class) {
  return lane.kind == LaneKind::Normal && (lane.allowed & vehicle_class) != 0 &&
         !is_without_motors(lane);
}

bool is_inside(const std::vector<double>& window, const Vec2& place) {
  return window.empty() || (place.x() >= window[0] && place.x() <= window[2] &&
                            place.y() >= window[1] && place.y() <= window[3]);
}

/// Does the way of a row lead over a box nearer than it could brake, or past it within its
/// reaction, in which it may be about to change lanes? `gap`: to it in a line [m]. Who has no way,
/// on foot, stops within a step.
bool comes_to(const Scene& scene, const RoadState& road, std::size_t row, const OrientedBox& box,
              double gap) {
  constexpr double kBraking = 2.5, kReaction = 1.0;  // [m/s^2], [s]
  constexpr double kOver = 0.5, kBeside = 3.0;       // between the bodies [m]
  const Path* path = road.path(scene.path[row]);
  const double speed = scene.velocity[row].norm();
  const double reaction = speed * kReaction;
  const double reach = reaction + 0.5 * speed * speed / kBraking;
  if (path == nullptr || gap > reach) return false;
  const double along = path->line.project(scene.position[row]).along;
  const double end = along + reach + scene.footprint[row].radius + box.half.x();
  const PolylinePosition nearest = path->line.project(box.center, along, end);
  if (nearest.along < along || nearest.along > end) return false;  // of a segment that is long
  const Vec2 across = left_of(path->line.direction_at(nearest.along));
  const double between = nearest.distance -
                         half_extent(scene, row, left_of(direction_of(scene.heading[row]))) -
                         box.half.x() * std::abs(box.forward.dot(across)) -
                         box.half.y() * std::abs(left_of(box.forward).dot(across));
  return between < (gap > reaction ? kOver : kBeside);
}

}  // namespace

StartDraw::StartDraw(const RoadNetwork& network, const AgentType& type, const EgoSettings& settings)
    : network_(network),
      class_(vehicle_class_from_name(type.sumo_class)),
      length_(type.length),
      way_(settings.goal_way) {
  constexpr double kBeforeEnd = 3.0;  // [m]
  if (!settings.goal_edge.empty()) {
    const auto found = network.edge_by_name.find(settings.goal_edge);
    if (found == network.edge_by_name.end())
      throw Error("[ego] goal_edge", "the network has no edge '" + settings.goal_edge + "'");
    goal_ = found->second;
    if (!allows(network, network.edge(goal_), class_))
      throw Error("[ego] goal_edge", "the edge '" + settings.goal_edge + "' admits no " +
                                         type.sumo_class + ", the class of a " + type.name);
    travel_times_ = free_travel_times(network);
  }
  for (std::size_t k = 0; k < network.lanes.size(); ++k) {
    const Lane& lane = network.lanes[k];
    if (!is_for_drivers(lane, class_)) continue;
    for (double front = length_ + 1.0; front < lane.length - kBeforeEnd; front += 1.0)
      if (is_inside(settings.window, lane.centerline.point_at(front - 0.5 * length_)))
        places_.emplace_back(static_cast<LaneId>(k), front);
  }
  if (places_.empty())
    throw Error("[ego] window", "has no lane on which a " + type.name + " could start");
  if (goal_ != kNoEdge && !is_goal_reachable())
    throw Error("[ego] goal_edge", "no way leads to '" + settings.goal_edge + "' from " +
                                       (settings.window.empty() ? "anywhere" : "the window") +
                                       " for a " + type.name + ": no edge before it that admits " +
                                       type.sumo_class + " leads on to it; name another");
}

bool StartDraw::is_goal_reachable() const {
  LaneId last = kNoLane;
  for (const auto& [lane, front] : places_) {  // those of a lane follow each other
    if (lane == last) continue;
    last = lane;
    if (!fastest_route(network_, lane, goal_, class_, travel_times_).empty()) return true;
  }
  return false;
}

std::vector<EdgeId> StartDraw::random_route(LaneId from, double front, std::uint64_t key) const {
  const Lane& lane = network_.lane(from);
  std::vector<EdgeId> route{lane.edge};
  double left = way_ + kSpare - (lane.length - front);
  for (std::uint64_t turn = 0; left > 0.0; ++turn) {
    std::vector<EdgeId> next;
    for (const LaneId one : network_.edge(route.back()).lanes)
      for (const ConnectionId id : network_.lane(one).outgoing) {
        const Connection& connection = network_.connection(id);
        const EdgeId edge = network_.lane(connection.to).edge;
        const bool seen = std::find(next.begin(), next.end(), edge) != next.end() ||
                          std::find(route.begin(), route.end(), edge) != route.end();
        if (!seen && connection.direction != TurnDirection::Turnaround &&
            is_for_drivers(network_.lane(connection.to), class_) &&
            (network_.lane(one).allowed & class_) != 0)
          next.push_back(edge);
      }
    if (next.empty()) return {};
    std::sort(next.begin(), next.end());
    const EdgeId chosen = next[random_bits(key, turn, 1, Draw::EgoStart) % next.size()];
    route.push_back(chosen);
    left -= network_.lane(network_.edge(chosen).lanes.front()).length;
  }
  return route;
}

std::optional<EgoStart> StartDraw::draw(std::uint64_t seed, std::uint64_t attempt) const {
  const std::uint64_t key = random_bits(seed, attempt, 0, Draw::EgoStart);
  const auto& [lane_id, front] = places_[key % places_.size()];
  EgoStart start;
  start.lane = lane_id;
  start.front = front;
  const Lane& lane = network_.lane(lane_id);
  const double center = front - 0.5 * length_;
  start.position = lane.centerline.point_at(center);
  start.heading = heading_of(lane.centerline.direction_at(center));
  start.route = goal_ == kNoEdge ? random_route(lane_id, front, key)
                                 : fastest_route(network_, lane_id, goal_, class_, travel_times_);
  if (start.route.empty()) return std::nullopt;
  return start;
}

bool is_free(const Scene& scene, const RoadState& road, const EgoStart& start,
             const AgentType& type, double clearance) {
  const OrientedBox ego{
      start.position, direction_of(start.heading), {0.5 * type.length, 0.5 * type.width}};
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const double gap = (start.position - scene.position[row]).norm() - 0.5 * type.length -
                       scene.footprint[row].radius;
    if (gap < clearance || comes_to(scene, road, row, ego, gap)) return false;
  }
  return true;
}

EgoGoal goal_on(const RoadNetwork& network, const Path& path, double along, double length,
                const EgoSettings& settings, bool drawn) {
  constexpr double kBeforeEnd = 1.0;  // who arrives is taken off the road [m]
  const double end = std::min(path.arrival, path.line.length()) - 0.5 * length - kBeforeEnd;
  double place = end;
  if (!settings.goal_edge.empty()) {
    const auto found = std::find_if(
        path.stretches.rbegin(), path.stretches.rend(), [&](const PathStretch& stretch) {
          return network.edge(network.lane(stretch.lane).edge).name == settings.goal_edge;
        });
    if (found == path.stretches.rend())
      throw Error("[ego] goal_edge",
                  "the ego's route doesn't come to '" + settings.goal_edge + "'");
    if (settings.goal_at >= 0.0)
      place = std::min(end, found->from + settings.goal_at - found->lane_from);
    else
      place = std::min(end, found->to);
  } else if (drawn) {
    place = std::min(end, along + settings.goal_way);
  }
  if (place - along < kGoalRadius)
    throw Error("[ego] goal", "lies " + number_text(place - along) +
                                  " m ahead of the ego's start, behind it or nearer than " +
                                  number_text(kGoalRadius) + " m");
  return {path.line.point_at(place), path.line.direction_at(place), place - along};
}

}  // namespace sumogamma
