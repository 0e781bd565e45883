#include "osm/map_repairs.h"

#include "osm/repairs/box_cut.h"
#include "osm/repairs/carriageway_ends.h"
#include "osm/repairs/circular_junctions.h"
#include "osm/repairs/closed_roads.h"
#include "osm/repairs/coarse_rings.h"
#include "osm/repairs/contraflow.h"
#include "osm/repairs/crossing_footways.h"
#include "osm/repairs/doubled_roads.h"
#include "osm/repairs/main_road_lanes.h"
#include "osm/repairs/round_bends.h"
#include "osm/repairs/sidewalks.h"
#include "osm/repairs/squares.h"
#include "osm/repairs/stop_line_signals.h"
#include "osm/repairs/tag_values.h"
#include "osm/repairs/travelled_ways.h"
#include "osm/repairs/turn_lanes.h"
#include "osm/repairs/turn_restrictions.h"

namespace sumogamma::osm {
namespace {

constexpr double kSignalReach = 60.0;  // [m] from a stop line downstream to its junction

using Facts = MapFacts;
using Log = IssueLog;

constexpr MapRepair kRepairs[] = {
    {{"untravelled-ways", "private, planned, indoor and underground-walk ways, and railways"},
     [](OsmMap& map, const Facts&, Log& log) { drop_untravelled(map, log); }},
    {{"closed-roads", "roads closed to motors, or to some of them"},
     [](OsmMap& map, const Facts&, Log& log) { close_to_motors(map, log); }},
    {{"squares", "pedestrian areas, walked along their outline"},
     [](OsmMap& map, const Facts&, Log& log) { replace_squares(map, log); }},
    {{"tag-values", "lanes, speeds, layers and directions that can't be meant"},
     [](OsmMap& map, const Facts&, Log& log) { correct_tag_values(map, log); }},
    {{"sidewalks", "sidewalk tags that netconvert ignores; sidewalks in road tunnels"},
     [](OsmMap& map, const Facts&, Log& log) { rewrite_sidewalks(map, log); }},
    {{"circular-junctions", "junction=circular, which netconvert does not know"},
     [](OsmMap& map, const Facts&, Log& log) { mark_circular_as_roundabout(map, log); }},
    {{"main-road-lanes", "two-way main roads without lanes"},
     [](OsmMap& map, const Facts&, Log& log) { guess_main_road_lanes(map, log); }},
    {{"contraflow", "bicycles and buses against the traffic of one-way roads"},
     [](OsmMap& map, const Facts& facts, Log& log) {
       rewrite_contraflow(map, facts.left_hand, log);
     }},
    {{"doubled-roads", "ways drawn twice over the same nodes"},
     [](OsmMap& map, const Facts&, Log& log) { drop_doubled_roads(map, log); }},
    {{"turn-lanes", "the order of turn:lanes where traffic keeps left"},
     [](OsmMap& map, const Facts& facts, Log& log) {
       if (facts.left_hand) reverse_turn_lanes(map, log);
     }},
    {{"box-cut", "ways that run on beyond the place"},
     [](OsmMap& map, const Facts& facts, Log& log) {
       if (facts.clip) cut_at_box(map, facts.box.grown(kBeyondBox), log);
     }},
    {{"carriageway-ends", "carriageways that meet in one point at the edge"},
     [](OsmMap& map, const Facts& facts, Log& log) {
       if (facts.clip) split_carriageway_ends(map, facts.box, log);
     }},
    {{"stop-line-signals", "traffic lights mapped on stop lines"},
     [](OsmMap& map, const Facts&, Log& log) {
       move_signals_to_junctions(map, kSignalReach, log);
     }},
    {{"bends", "bends and hairpins drawn with corners"},
     [](OsmMap& map, const Facts&, Log& log) { round_bends(map, log); }},
    {{"coarse-rings", "roundabouts drawn with few points"},
     [](OsmMap& map, const Facts&, Log& log) { round_coarse_rings(map, log); }},
    {{"crossing-footways", "crossings half way along a road, which netconvert loses"},
     [](OsmMap& map, const Facts&, Log& log) { add_footways_at_crossings(map, log); }},
    {{"turn-restrictions", "turn restrictions with a member outside the map"},
     [](OsmMap& map, const Facts&, Log& log) { drop_broken_restrictions(map, log); }},
};

}  // namespace

std::span<const MapRepair> map_repairs() { return kRepairs; }

void repair_map(OsmMap& map, const MapFacts& facts, const RepairSet& off, IssueLog& log) {
  for (const MapRepair& repair : kRepairs)
    if (!off.contains(repair.name.name)) repair.mend(map, facts, log);
}

}  // namespace sumogamma::osm
