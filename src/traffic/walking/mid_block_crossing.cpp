#include "traffic/walking/mid_block_crossing.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "traffic/junction/occupation.h"
#include "traffic/longitudinal/car_following.h"
#include "traffic/patience.h"
#include "traffic/perception.h"

namespace sumogamma {

namespace {

/// The piece over a road that somebody on foot has before it.
struct Piece {
  Vec2 begin, end;
  double front = 0;   ///< of the walker past the begin [m]
  double length = 0;  ///< of the walker [m]
  double half_width = 0;
  double pace = 1;    ///< [m/s]
  double waited = 0;  ///< [s]
};

/// Where a vehicle's path meets a piece: along the path from the vehicle's middle, and along the
/// piece [m].
struct Meeting {
  double way = 0, place = 0;
};

std::optional<Meeting> find_meeting(const Polyline& line, double along, double back, double reach,
                                    const Piece& piece) {
  const std::vector<Vec2>& points = line.points();
  const Vec2 over = piece.end - piece.begin;
  for (std::size_t i = line.segment_at(along - back); i + 1 < points.size(); ++i) {
    if (line.along_of_vertex(i) > along + reach) break;
    const Vec2 driven = points[i + 1] - points[i];
    const auto share = crossing_shares(points[i], driven, piece.begin, over);
    if (!share || share->minCoeff() < 0.0 || share->maxCoeff() > 1.0) continue;
    return Meeting{line.along_of_vertex(i) + share->x() * driven.norm() - along,
                   share->y() * over.norm()};
  }
  return std::nullopt;
}

/// Does a vehicle that meets the piece have somebody on foot wait?
bool holds(const TrafficView& view, std::size_t row, const Meeting& meeting, const Piece& piece) {
  const Scene& scene = view.scene;
  const AgentType& type = type_of(view.model.types, scene.type[row]);
  const double half_length = scene.footprint[row].radius;
  const double side = piece.half_width + view.parameters.ample_side;
  const double gap = meeting.way - half_length - side;
  const double speed = scene.speed[row];
  if (meeting.way + half_length + side < 0.0) return false;
  const bool patient = patience_after(view.parameters, piece.waited) < Patience::Desperate;
  if (speed < view.parameters.standing_speed) return gap < 0.0 && patient;
  if (speed < view.parameters.crawling_speed && gap > view.parameters.near_line) return false;
  const double swath = 0.5 * type.width + view.parameters.ample_side;
  const double into = (meeting.place - swath - piece.front) / piece.pace;
  const double past = view.parameters.reaction_time +
                      (meeting.place + swath + piece.length - piece.front) / piece.pace;
  const Occupation taken = occupation(
      view, {kNoConnection, static_cast<std::uint32_t>(row), half_length, 2.0 * half_length, speed},
      meeting.way - side, meeting.way + side);
  const double margin = view.parameters.walker_time_gap +
                        (view.parameters.reaction_time - view.parameters.walker_time_gap) *
                            impatience_after(view.parameters, piece.waited);
  if (taken.end + margin < into || taken.begin > past + margin) return false;
  return patient || taken.begin < view.parameters.soon ||
         deceleration_to_stop(speed, gap) > view.parameters.courtesy_braking;
}

/// Id of the nearest vehicle that has somebody on foot wait, -1 where none does.
std::int64_t find_who_comes(const TrafficView& view, std::size_t row, const Piece& piece) {
  const Scene& scene = view.scene;
  const double width = (piece.end - piece.begin).norm();
  const double time = view.parameters.reaction_time + (width + piece.length) / piece.pace +
                      view.parameters.walker_time_gap;
  const double reach =
      std::min(2.0 * view.parameters.flow_speed * time + width, view.parameters.sight);
  std::int64_t foe = -1;
  double nearest = reach * reach;
  visit_near(view, row, reach, [&](std::size_t other) {
    const double distance = (scene.position[other] - scene.position[row]).squaredNorm();
    if (distance > nearest) return;
    const Path* path = view.road.path(scene.path[other]);
    if (path == nullptr || path->walking) return;
    const double half_length = scene.footprint[other].radius;
    const double least = std::sqrt(distance) - width - half_length;
    const double fastest = std::min(path->profile_at(scene.path_along[other]),
                                    type_of(view.model.types, scene.type[other]).max_speed);
    if (least > time * fastest) return;
    const auto meeting =
        find_meeting(path->line, scene.path_along[other], half_length + 1.0, reach, piece);
    if (!meeting || !holds(view, other, *meeting, piece)) return;
    const std::int64_t id = scene.id[other].value;
    if (distance == nearest && foe >= 0 && foe < id) return;
    foe = id;
    nearest = distance;
  });
  return foe;
}

}  // namespace

LinkDecision decide_at_kerb(const TrafficView& view, const Traveller& walker, double pace) {
  const Model& model = view.model;
  const RoadState& road = view.road;
  const Scene& scene = view.scene;
  const TrafficState& traffic = view.traffic;
  const Path& path = *road.path(scene.path[walker.row]);
  for (const RoadCrossing& over : path.over_road) {
    if (walker.front > over.begin + view.parameters.line_tolerance) continue;
    if (walker.front < over.begin - view.parameters.near) break;
    // who was let go keeps to it: its patience is gone with its first step
    const RoadContext& before = scene.context[walker.row];
    const bool let_go = before.active && before.reason != LimitReason::Crossing;
    if (let_go && walker.front > over.begin - view.parameters.footstep) break;
    const Piece piece{path.line.point_at(over.begin),
                      path.line.point_at(over.end),
                      walker.front - over.begin,
                      walker.length,
                      0.5 * type_of(model.types, scene.type[walker.row]).width,
                      std::max(pace, 0.3),
                      traffic.waiting_time[walker.row]};
    const std::int64_t foe = find_who_comes(view, walker.row, piece);
    if (foe < 0) break;
    return {true, over.begin - view.parameters.line_tolerance, LimitReason::Crossing, foe};
  }
  return {};
}

}  // namespace sumogamma
