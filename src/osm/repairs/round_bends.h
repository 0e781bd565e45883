#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Rounds the bends of roads for cars between junctions. A map draws a bend with a point here and
/// there, as a rectangle where a ramp winds up a hill; no road has such corners, and no bus gets
/// round them in its lane. Hairpins of two-way roads are opened to bulbs (hairpins.h). Where a
/// road's middle then turns with a radius of less than 15 m (about the least for streets with buses
/// in guidelines) its points move towards the inside of the bend, by 4 m at the most, and points
/// are added where the line needs them. What lies on other ways in the same nodes moves along.
/// Junctions with 15 m of road at each, ends of roads, roundabouts (coarse_rings.h) and bends that
/// would move by less than half a metre stay as they are.
/// Cycleways and paths likewise with 5 m, from 0.15 m on, but for 15 m from a road, 5 m from other
/// ends, and the points that they share with ways of another kind.
void round_bends(OsmMap& map, IssueLog& log);

}  // namespace sumogamma::osm
