#pragma once

#include <map>
#include <set>
#include <string>

#include "osm/network_file.h"

namespace sumogamma::osm {

/// How edges are to change so that lanes of different edges no longer lie on each other, and long
/// bodies get round bends.
struct CarriagewayPlan {
  std::map<std::string, std::string> shapes;  ///< by edge: SUMO's shape attribute "x,y,z x,y,z ..."
  std::set<std::string> apart;                ///< of these: because lanes lay on each other
  std::set<std::string> bends;                ///< of these: at the outside of sharp bends
  std::map<std::string, double> lane_widths;  ///< by lane: narrower than it was [m]
  std::set<std::string> dropped;  ///< edges of paths that run lengthwise inside a carriageway
  double farthest = 0;            ///< [m] greatest move sideways of those apart

  bool empty() const { return shapes.empty() && lane_widths.empty() && dropped.empty(); }
};

/// Plans to move edges apart whose lanes lie on each other (see find_lane_overlaps()): OSM's lines
/// are metres off, netconvert's lane widths are guessed, and it puts the sidewalk of a one-way road
/// beside the lanes and then the middle of both on the line. A road's two directions move as one,
/// and then get room between them where it bends sharply (room_in_bends()).
///
/// Each pair shares the move equally, but paths make way for roads; a road moves 4 m at most, a
/// path 8 m; a move fades out at 1 m in 10 m along the road and on beyond the junctions through
/// which traffic goes straight, and what it pushes into moves in turn. Where room is still missing,
/// the lanes for driving are narrowed to 2.75 m. Paths (without lanes for driving) that lie on
/// lanes for driving for more than a third of their length and cannot be cleared are dropped,
/// unless that would cut people on foot off.
CarriagewayPlan plan_carriageways(const NetworkFile& network);

}  // namespace sumogamma::osm
