#include "road/path_pieces.h"

#include <algorithm>

namespace sumogamma {

double width_to_kerb(const RoadNetwork& network, const Lane& lane) {
  using namespace vehicle_class;
  const double beside = network.left_hand ? lane.beside_left : lane.beside_right;
  const auto is_carriageway = [](const Lane& outer) {
    return (outer.allowed & (kPassenger | kBus)) != 0 ||
           (outer.allowed & (kPedestrian | kOnRails)) == 0;
  };
  return 0.5 * lane.width + beside + width_beside(network, lane, false, is_carriageway);
}

void move_stop_lines(const RoadNetwork& network, Path& path) {
  constexpr double kMost = 6.0, kStep = 0.25;  // [m]
  for (PathLink& link : path.links) {
    const Polyline& lane = network.lane(network.connection(link.connection).from).centerline;
    const Vec2 end = lane.points().back(), forward = lane.direction_at(lane.length());
    const auto passed = [&](double along) {
      return to_body(path.line.point_at(along) - end, forward).x() > 0.05;
    };
    double moved = link.stop_line;
    const double least = std::max(link.stop_line - kMost, 0.0);
    while (moved > least && passed(moved)) moved -= kStep;
    moved = std::max(moved, least);
    link.halt = std::max(link.halt - (link.stop_line - moved), 0.0);
    link.stop_line = moved;
  }
}

void append_span(const Polyline& line, double from, double to, std::vector<Vec2>& points) {
  points.push_back(line.point_at(from));
  const auto& vertices = line.points();
  if (from <= to) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const double along = line.along_of_vertex(i);
      if (along > from && along < to) points.push_back(vertices[i]);
    }
  } else {
    for (std::size_t i = vertices.size(); i-- > 0;) {
      const double along = line.along_of_vertex(i);
      if (along < from && along > to) points.push_back(vertices[i]);
    }
  }
  points.push_back(line.point_at(to));
}

}  // namespace sumogamma
