#pragma once

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// The steps between what people mapped and what netconvert 1.15 understands. Each changes the map
/// in place and says in the log what it guessed, moved or dropped. prepare_map() runs them in the
/// order in which they stand here.
struct PrepareOptions {
  GeoBox box;        ///< the place asked for
  bool clip = true;  ///< cut ways at the box; false where the extract does not say what it covers
  double clip_margin = 60.0;   ///< [m] beyond the box, so that junctions at its edge stay whole
  double signal_reach = 60.0;  ///< [m] from a stop line downstream to its junction
  bool left_hand = false;      ///< traffic keeps left
};

/// Leaves only ways that somebody may travel: no private, planned, indoor or underground-walk ways,
/// no railways; a road closed to motors becomes a path; a pedestrian area becomes a star of
/// footways between its entrances.
void select_ways(OsmMap& map, IssueLog& log);

/// Rewrites tags that netconvert 1.15 ignores or misreads: sidewalk:left and kin,
/// sidewalk=separate, junction=circular, missing lanes of two-way main roads, highway=road.
void normalise_tags(OsmMap& map, IssueLog& log);

/// Turns the order of turn:lanes round, for maps where traffic keeps left: OSM counts lanes from
/// the left, netconvert 1.15 reads these ones from the kerb in any case (SUMO issue 13549), and
/// those who turn left would cross the way of those who turn right.
void reverse_turn_lanes(OsmMap& map, IssueLog& log);

/// Cuts ways at the box: pieces outside vanish, new nodes stand on its edge (never within 1 m of
/// another node: netconvert would merge them). The first piece keeps the way's id.
void clip_ways(OsmMap& map, const GeoBox& box, IssueLog& log);

/// Where the two carriageways of a road meet in one point at or outside the box, splits that point:
/// netconvert would join them into a hairpin that eats its own lanes.
void split_carriageway_ends(OsmMap& map, const GeoBox& box, IssueLog& log);

/// Moves traffic lights that were mapped on stop lines to the junction that they guard; signalled
/// mid-block crossings stay.
void snap_signals(OsmMap& map, double reach, IssueLog& log);

/// netconvert 1.15 loses a crossing half way along a road unless a footway shares its node: gives
/// such nodes a short footway to either side, so that a crossing is built between the sidewalks.
/// Nodes within 15 m of a junction are left to the crossings that it gets anyway.
void add_footways_at_crossings(OsmMap& map, IssueLog& log);

/// Traffic that comes to a junction along a way, in its direction (1) or against it (-1).
struct WayApproach {
  std::int64_t way = 0;
  int direction = 1;
  bool operator==(const WayApproach&) const = default;
};

/// By the junction's node: approaches that have a sign.
using SignsByJunction = std::map<std::int64_t, std::vector<WayApproach>>;

/// The signs, nodes with highway=`kind` ("stop", "give_way"), on approaches at most `reach` before
/// their junctions [m]. netconvert 1.15 reads neither; see NetworkPatch.
SignsByJunction find_signs(const OsmMap& map, const char* kind, double reach);

/// Drops turn restrictions that lost a member or no longer join at their via node.
void filter_restrictions(OsmMap& map, IssueLog& log);

/// All of the above, with roads drawn twice dropped after the tags (doubled_roads.h) and bends
/// rounded after the signals (round_bends.h).
void prepare_map(OsmMap& map, const PrepareOptions& options, IssueLog& log);

/// True for a way that cars may use by its highway tag.
bool is_car_way(const MapWay& way);
/// True for a way that only people on foot or on bicycles use by its highway tag.
bool is_path_way(const MapWay& way);
/// True for a way whose traffic goes one way only, by its tags or by what kind of road it is.
bool is_one_way(const MapWay& way);
/// True for a one-way road against the order of its nodes.
bool is_reversed(const MapWay& way);
/// Place of a road among the classes, 0 for motorways; behind all of them for other ways.
int road_class(const MapWay& way);

}  // namespace sumogamma::osm
