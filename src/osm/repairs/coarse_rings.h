#pragma once

#include <cstdint>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// A piece of a roundabout from one of its nodes to the next, with places to draw it through.
struct RingArc {
  std::int64_t from = 0, to = 0;
  std::vector<GeoPoint> between;
};

/// The arcs of roundabouts that a map draws with so few points that straight lines between them
/// leave the ring by a metre or more: a ring of four points is a square, whose corners no bus gets
/// round. The distance from the ring's middle goes over from that of one node to that of the next
/// evenly with the angle, so that nodes on a circle give that circle; nodes stay where they are.
/// A ring may consist of several ways. What goes to and fro as seen from its middle is left out.
std::vector<RingArc> coarse_ring_arcs(const OsmMap& map);

/// Draws these arcs into the roundabouts.
void round_coarse_rings(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
