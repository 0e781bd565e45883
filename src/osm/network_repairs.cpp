#include "osm/network_repairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <set>

#include "osm/lane_overlap.h"
#include "osm/network_facts.h"
#include "osm/repairs/backward_turns.h"
#include "osm/repairs/carriageways_apart.h"
#include "osm/repairs/right_of_way_tags.h"
#include "osm/repairs/signal_offsets.h"
#include "osm/repairs/swallowed_roads.h"
#include "osm/repairs/unruled_junctions.h"
#include "osm/repairs/walking_ground.h"
#include "osm/signs.h"
#include "road/sumo_net_reader.h"

namespace sumogamma::osm {
namespace {

constexpr double kSignReach = 30.0;  // [m] from a sign to the junction it guards
constexpr double kWorthAnotherRound =
    0.005;  // share of the lanes for wheels that still overlap: another run takes its time
constexpr int kMostRuns = 16;  // of netconvert

void find_unruled_junctions(const NetworkView& view, NetworkChanges& changes, IssueLog&) {
  changes.apart = unruled_junctions(view.network.road, view.joins);
}

void find_swallowed_roads(const NetworkView& view, NetworkChanges& changes, IssueLog&) {
  changes.joins = swallowed_roads(view.network.road);
}

void find_signals_on_ways(const NetworkView& view, NetworkChanges& changes, IssueLog&) {
  changes.joins = signals_on_ways(view.network.road);
}

void find_roundabouts(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  changes.patch.roundabouts = unmarked_roundabouts(view.network.net(), view.map);
  for (const auto& ring : changes.patch.roundabouts)
    log.add(Severity::Note, "roundabout_marked", "roundabouts by tag that netconvert had not seen",
            ring[0]);
}

void find_stop_signs(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  for (const auto& [junction, type] :
       stop_types(view.network.road, find_signs(view.map, "stop", kSignReach))) {
    changes.patch.junction_types[junction] = type;
    log.add(Severity::Note, "stop_signs",
            "junctions with stop signs, which netconvert does not read", junction + " " + type);
  }
}

void find_mini_roundabouts(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  for (const std::string& junction : mini_roundabouts(view.network.road, view.map)) {
    changes.patch.junction_types[junction] = "left_before_right";
    log.add(Severity::Note, "mini_roundabout_marked",
            "mini-roundabouts, where who comes round the middle goes first", junction);
  }
}

void find_give_way_signs(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  changes.patch.prohibitions =
      give_way_rules(view.network, find_signs(view.map, "give_way", kSignReach));
  std::set<std::string> yielding;
  for (const Prohibition& rule : changes.patch.prohibitions) yielding.insert(rule.waits_from);
  for (const std::string& edge : yielding)
    log.add(Severity::Note, "give_way_signs",
            "roads with give-way signs, which netconvert does not read", edge);
}

void note_carriageways(const CarriagewayPlan& plan, IssueLog& log) {
  for (const std::string& edge : plan.apart)
    log.add(Severity::Note, "moved_apart",
            "edges moved sideways because their lanes lay on those of other edges", edge);
  for (const std::string& edge : plan.bends)
    log.add(Severity::Note, "bends_widened",
            "edges at the outside of sharp bends, moved outwards there for long bodies", edge);
  for (const auto& [lane, width] : plan.lane_widths)
    log.add(Severity::Note, "lanes_narrowed",
            "lanes narrowed where there was no room to move edges apart", lane);
  for (const std::string& edge : plan.dropped)
    log.add(Severity::Note, "path_on_carriageway",
            "paths left out that ran lengthwise inside a carriageway", edge);
}

void find_carriageways(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  // edges that lay on each other were partly swallowed by their junctions: only once they are apart
  // all of them is there
  const RoadNetwork& road = view.network.road;
  if (view.round > 0) {
    const OverlapLength left = overlap_length(road, find_lane_overlaps(road));
    if (left.wheels + left.walking <= kWorthAnotherRound * left.all_wheels) return;
  }
  changes.patch.carriageways = plan_carriageways(view.network);
  note_carriageways(changes.patch.carriageways, log);
}

void find_backward_turns(const NetworkView& view, NetworkChanges& changes, IssueLog& log) {
  const RoadNetwork& road = view.network.road;
  for (const ConnectionId turn : dispensable_turns(road, backward_turns(road)))
    changes.patch.refused.push_back(named_turn(road, turn));
  for (const Turn& turn : changes.patch.refused)
    log.add(Severity::Note, "turns_refused",
            "turns that would lead backwards over their junction, taken out: there is another way",
            turn.from + " to " + turn.to);
}

constexpr NetworkRepair kRepairs[] = {
    {{"unruled-junctions", "junctions that netconvert joins of more roads than SUMO rules"},
     Stage::Joined,
     1,
     find_unruled_junctions},
    {{"swallowed-roads", "junctions that swallow the road between them"},
     Stage::Junctions,
     1,
     find_swallowed_roads},
    {{"roundabouts", "roundabouts by tag that netconvert does not see"},
     Stage::Roads,
     1,
     find_roundabouts},
    {{"stop-signs", "stop signs, which netconvert does not read"},
     Stage::Roads,
     1,
     find_stop_signs},
    {{"mini-roundabouts", "mini-roundabouts, which netconvert does not read"},
     Stage::Roads,
     1,
     find_mini_roundabouts},
    {{"give-way-signs", "give-way signs, which netconvert does not read"},
     Stage::Roads,
     1,
     find_give_way_signs},
    {{"carriageways", "lanes of different roads on each other; no room in sharp bends"},
     Stage::Roads,
     2,
     find_carriageways},
    {{"backward-turns", "turns that lead backwards over their junction"},
     Stage::Turns,
     4,
     find_backward_turns},
    {{"signals-on-ways", "queues at a signal in the way of those who turn before it"},
     Stage::Signals,
     1,
     find_signals_on_ways},
};

/// Sets signals that follow each other closely so that who gets over one gets over the next.
bool coordinate_signals(NetworkFile& network, IssueLog& log) {
  const auto offsets = signal_offsets(network.road, read_signal_programs(network.net()));
  set_signal_offsets(network.net(), offsets);
  for (const auto& [signal, offset] : offsets)
    log.add(Severity::Note, "signals_coordinated",
            "signals less than 60 m from another that were set to its times",
            signal + " offset " + std::to_string(offset) + " s");
  return !offsets.empty();
}

/// Takes the ground that turning vehicles need off the walking areas.
bool round_kerbs(NetworkFile& network, IssueLog& log) {
  const auto outlines = walking_areas_off_the_road(network.road);
  set_walking_areas(network.net(), network.road, outlines);
  for (const auto& [area, outline] : outlines)
    log.add(Severity::Note, "kerbs_rounded",
            "walking areas cut back to where vehicles turn beside them", area);
  return !outlines.empty();
}

constexpr FileRepair kFileRepairs[] = {
    {{"signal-offsets", "signals close to each other whose greens don't fit"}, coordinate_signals},
    {{"kerbs", "walking areas with corners sharper than anybody turns"}, round_kerbs},
};

// ---------------------------------------------------------------------------- netconvert, again

using Rounds = std::array<int, std::size(kRepairs)>;

/// What the first stage that wants something wants.
NetworkChanges next_changes(NetworkView view, const RepairSet& off, Rounds& rounds, IssueLog& log) {
  NetworkChanges changes;
  for (std::size_t i = 0; i < std::size(kRepairs); ++i) {
    const NetworkRepair& repair = kRepairs[i];
    if (i > 0 && repair.stage != kRepairs[i - 1].stage && !changes.empty()) break;
    if (rounds[i] >= repair.rounds || off.contains(repair.name.name)) continue;
    view.round = rounds[i]++;
    repair.find(view, changes, log);
    changes.asked_by = repair.stage;
  }
  return changes;
}

/// Lets the stages before the one that asked for a new conversion of the map ask again.
void begin_anew(Stage asked_by, Rounds& rounds) {
  for (std::size_t i = 0; i < std::size(kRepairs); ++i)
    if (kRepairs[i].stage < asked_by) rounds[i] = 0;
}

/// Changes what is joined. Whatever is joined changes what netconvert would join around it by
/// itself: all else stays as it is.
void change_joins(const NetworkChanges& changes, std::vector<NodeGroup>& joins, IssueLog& log) {
  for (const NodeGroup& nodes : changes.apart) {
    log.add(Severity::Note, "junctions_left_apart",
            "junctions that netconvert would join of more roads than SUMO rules",
            "node/" + *nodes.begin());
    std::erase(joins, nodes);
  }
  for (const NodeGroup& nodes : changes.joins) {
    log.add(Severity::Note, "junctions_joined",
            "junctions made one because there was no room for the road between them",
            "node/" + *nodes.begin());
    add_group(nodes, joins);
  }
}

/// Has netconvert convert the map. `before` is the network that it made of it before, if any.
std::optional<NetworkFile> convert(const NetconvertRequest& netconvert,
                                   const pugi::xml_node& before, Conversion& conversion) {
  conversion.command = run_netconvert(netconvert, before);
  if (conversion.command.empty()) return std::nullopt;
  NetworkFile network = load_network(netconvert.folder / netconvert.network);
  const OverlapLength overlaps = overlap_length(network.road, find_lane_overlaps(network.road));
  conversion.before["overlapping_lanes_before_m"] = std::round(overlaps.wheels);
  conversion.before["overlapping_walkways_before_m"] = std::round(overlaps.walking);
  return network;
}

long count_crossings(const RoadNetwork& road) {
  return std::count_if(road.edges.begin(), road.edges.end(),
                       [](const Edge& edge) { return edge.kind == LaneKind::Crossing; });
}

std::optional<NetworkFile> patched(const NetconvertRequest& netconvert, const NetworkFile& network,
                                   const NetworkPatch& patch, IssueLog& log) {
  if (patch_network(netconvert, network.net(), patch).empty()) return std::nullopt;
  NetworkFile after = load_network(netconvert.folder / netconvert.network);
  if (const long lost = count_crossings(network.road) - count_crossings(after.road); lost > 0)
    log.add(Severity::Note, "crossings_lost",
            "crossings for which there is no room, or no use, any more after edges moved", "",
            lost);
  return after;
}

/// Runs netconvert until no repair wants anything changed.
std::optional<NetworkFile> convert_until_whole(const OsmMap& map, NetconvertRequest netconvert,
                                               const RepairSet& off, Conversion& conversion,
                                               IssueLog& log) {
  std::optional<NetworkFile> network = convert(netconvert, {}, conversion);
  if (!network) return network;
  std::vector<NodeGroup> joins = read_joins(netconvert.folder / netconvert.joined);
  IssueLog as_converted = log;
  Rounds rounds{};
  for (int runs = 1; network && runs < kMostRuns; ++runs) {
    const NetworkChanges changes = next_changes({map, *network, joins}, off, rounds, log);
    if (changes.empty()) break;
    if (!changes.of_map()) {
      network = patched(netconvert, *network, changes.patch, log);
      continue;
    }
    log = as_converted;  // notes tell of what is built, not of a first attempt
    change_joins(changes, joins, log);
    netconvert.joins = joins;
    network = convert(netconvert, network->net(), conversion);
    as_converted = log;
    begin_anew(changes.asked_by, rounds);
  }
  return network;
}

void warn_of_backward_turns(const RoadNetwork& road, IssueLog& log) {
  for (const ConnectionId turn : backward_turns(road))
    log.add(Severity::Warning, "turn_leads_back",
            "turns that lead backwards over their junction, the only way there",
            named_turn(road, turn).from + " to " + named_turn(road, turn).to);
}

}  // namespace

std::span<const NetworkRepair> network_repairs() { return kRepairs; }
std::span<const FileRepair> file_repairs() { return kFileRepairs; }

std::optional<NetworkFile> make_network(const OsmMap& map, NetconvertRequest netconvert,
                                        const RepairSet& off, Conversion& conversion,
                                        IssueLog& log) {
  const std::filesystem::path file = netconvert.folder / netconvert.network;
  std::optional<NetworkFile> network =
      convert_until_whole(map, std::move(netconvert), off, conversion, log);
  if (!network) return std::nullopt;
  warn_of_backward_turns(network->road, log);
  bool changed = false;
  for (const FileRepair& repair : kFileRepairs)
    if (!off.contains(repair.name.name)) changed = repair.mend(*network, log) || changed;
  if (changed) save_xml(network->document, file);
  network->road = read_sumo_net(network->document, file);
  return network;
}

}  // namespace sumogamma::osm
