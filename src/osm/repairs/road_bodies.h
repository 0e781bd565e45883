#pragma once

#include <vector>

#include "osm/lane_overlap.h"
#include "osm/network_file.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// A lane as a strip beside its body's line.
struct BodyLane {
  LaneId lane = kNoLane;
  double offset = 0, half_width = 0;  ///< [m] to the left of the line
  double from = 0, to = 0;            ///< [m] along the line
  LaneUse use = LaneUse::Driving;
};

/// What moves as one: an edge, with the edge of the opposite direction where both have the same
/// line.
struct RoadBody {
  EdgeId edge = kNoEdge, twin = kNoEdge;
  std::vector<Vec2> points, normals;  ///< of the line before moving; unit, to the left
  std::vector<double> heights, along;
  std::vector<double> shift;  ///< [m] to the left, by point
  std::vector<BodyLane> lanes;
  double from = 0, to = 0;  ///< [m] along, where lanes are: the rest lies within junctions
  double reach = 0;         ///< [m] from the line to the outer edge of the farthest lane
  bool drives = false;

  Vec2 moved(std::size_t i) const { return points[i] + shift[i] * normals[i]; }
};

/// Ends of two bodies between which traffic goes straight on.
struct BodyLink {
  std::size_t body = 0, other = 0;
  std::size_t point = 0, other_point = 0;
  double distance = 0;
  double sign = 1;  ///< -1 where their lines run against each other
};

/// The bodies of all normal edges, by edge. Lines have points at most 5 m apart.
std::vector<RoadBody> make_road_bodies(const NetworkFile& network);

/// Where vehicles go straight on from body to body.
std::vector<BodyLink> make_body_links(const RoadNetwork& road, const std::vector<RoadBody>& bodies);

/// Raises moves along a line, none of them negative, so that they fade out by `slope` [m] in each
/// metre to both sides of where they are. `along` and `moves` are by point [m].
void fade_out(const std::vector<double>& along, double slope, std::vector<double>& moves);

/// Lays an edge's lanes beside the line again after their widths changed, as netconvert would:
/// about the middle of what they took before, or away from the line where they began at it.
/// `old_widths` are the widths by position in body.lanes.
void lay_lanes_again(const RoadNetwork& road, EdgeId edge, const std::vector<double>& old_widths,
                     RoadBody& body);

}  // namespace sumogamma::osm
