#include <algorithm>
#include <cmath>

#include "study/offences/judges.h"
#include "study/offences/rule_roads.h"

namespace sumogamma {

namespace {

constexpr double kEntered = 0.5;  // so deep into a crossing one is on it [m]
constexpr double kNearEnd = 1.0;  // of a crossing [m]
constexpr double kAside = 10.0;   // one may be pressed off it for so long [s]
constexpr double kWaits = 1.0;    // has met a red light [s]
constexpr double kStands = 0.2;   // [m/s]

/// Where somebody on foot is among crossings.
struct OnCrossing {
  LaneId on = kNoLane;
  LaneId at_end_of = kNoLane;
  bool amid = false;  ///< of `on`, not near an end of it
};

bool shows_red(const RuleView& view, const Lane& crossing) {
  return std::any_of(crossing.incoming.begin(), crossing.incoming.end(),
                     [&](ConnectionId link) { return was_and_is_red(view, link); });
}

/// Is somebody on the sidewalk or walking area that it uses? `hits` are the lanes of its place.
bool is_on_its_walkway(const RuleView& view, std::size_t row, const std::vector<LaneHit>& hits) {
  const LanePosition& own = view.scene.lane[row];
  if (own.lane == kNoLane) return false;
  const Lane& lane = view.roads.network.lane(own.lane);
  if (lane.kind == LaneKind::Normal) return std::abs(own.offset) <= 0.5 * lane.width + kEntered;
  return lane.kind == LaneKind::WalkingArea &&
         std::any_of(hits.begin(), hits.end(),
                     [&](const LaneHit& hit) { return hit.lane == own.lane; });
}

OnCrossing find_crossing(const RuleView& view, std::size_t row, bool stands,
                         const std::vector<LaneHit>& hits, CrossingMemory& memory) {
  const RoadNetwork& network = view.roads.network;
  const bool on_walkway = is_on_its_walkway(view, row, hits);
  OnCrossing found;
  for (const LaneHit& hit : hits) {
    const Lane& lane = network.lane(hit.lane);
    if (lane.kind != LaneKind::Crossing) continue;
    // once on it, one is on it to its very ends
    const bool enters = hit.lane != memory.on;
    const double margin = enters ? kEntered : 0.0;
    if ((enters && on_walkway) || hit.along < margin ||
        hit.along > lane.centerline.length() - margin) {
      // who waits there steps on when it starts
      if (memory.at_end_of != hit.lane || stands) memory.stepped_on_red = shows_red(view, lane);
      found.at_end_of = hit.lane;
      continue;
    }
    found.on = hit.lane;
    found.amid = hit.along > kNearEnd && hit.along < lane.centerline.length() - kNearEnd;
    if (found.on == memory.on) break;
  }
  // who goes beside it, round somebody who stands over it, has set out when its way got there
  const LaneId own = view.scene.lane[row].lane;
  if (found.on == kNoLane && own != kNoLane && network.lane(own).kind == LaneKind::Crossing) {
    if (memory.at_end_of != own) memory.stepped_on_red = shows_red(view, network.lane(own));
    found.at_end_of = own;
  }
  return found;
}

/// Judges who has just got onto a crossing.
void judge_entry(const RuleView& view, std::size_t row, LaneId entered, const RuleMemory& memory,
                 RuleWork& work) {
  const CrossingMemory& before = memory.crossing;
  const Lane& lane = view.roads.network.lane(entered);
  const auto link = std::find_if(lane.incoming.begin(), lane.incoming.end(), [&](ConnectionId id) {
    return view.roads.network.connection(id).signal != kNoSignal;
  });
  if (link == lane.incoming.end() || !memory.known) return;
  const auto add = [&, agent = static_cast<std::uint32_t>(row)](Finding what) {
    work.found.push_back({agent, what, view.scene.position[row], *link});
  };
  add(Finding::SignalPassed);
  const auto& waited_for = before.red_crossings;
  const bool stepped_on_red = before.at_end_of != entered || before.stepped_on_red;
  if (stepped_on_red && was_and_is_red(view, *link)) {
    add(Finding::RedLightMet);
    add(Finding::RedLightRun);
  } else if (before.waited >= kWaits &&
             std::find(waited_for.begin(), waited_for.end(), entered) != waited_for.end()) {
    add(Finding::RedLightMet);
  }
}

/// Notes which crossings beside somebody who stands show red.
void note_waiting(const RuleView& view, const std::vector<LaneHit>& hits, CrossingMemory& memory) {
  const RoadNetwork& network = view.roads.network;
  bool red = false;
  const auto look = [&](LaneId id) {
    const Lane& crossing = network.lane(id);
    if (crossing.kind != LaneKind::Crossing || !shows_red(view, crossing)) return;
    red = true;
    auto& known = memory.red_crossings;
    if (std::find(known.begin(), known.end(), id) == known.end()) known.push_back(id);
  };
  for (const LaneHit& hit : hits) {
    const Lane& area = network.lane(hit.lane);
    if (area.kind != LaneKind::WalkingArea) continue;
    // a crossing is entered at either end
    for (const ConnectionId link : area.outgoing) look(network.connection(link).to);
    for (const ConnectionId link : area.incoming) look(network.connection(link).from);
  }
  if (red) memory.waited += view.step;
}

}  // namespace

void judge_crossing(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work) {
  const RoadNetwork& network = view.roads.network;
  if (network.signals.empty()) return;
  find_lanes(
      view, row, view.scene.position[row],
      [&](LaneId id) {
        const LaneKind kind = network.lane(id).kind;
        return kind == LaneKind::Crossing || kind == LaneKind::WalkingArea;
      },
      work.hits);
  CrossingMemory& crossing = memory.crossing;
  const bool stands = view.scene.velocity[row].norm() < kStands;
  const OnCrossing here = find_crossing(view, row, stands, work.hits, crossing);
  if (here.on != kNoLane && here.on != crossing.on) {
    judge_entry(view, row, here.on, memory, work);
    crossing.waited = 0;
    crossing.red_crossings.clear();
  }
  crossing.at_end_of = here.at_end_of;
  const double now = view.scene.time;
  if (here.on != kNoLane) {
    crossing.amid = here.amid;
    crossing.last_on = now;
  }
  // who has gone aside amid the road, be it round somebody who stands over the crossing, for as
  // long as its way leads over it
  const bool crosses = view.scene.lane[row].lane == crossing.on;
  const bool beside =
      here.on == kNoLane && crossing.amid && (crosses || now - crossing.last_on <= kAside);
  if (!beside) crossing.on = here.on;
  if (here.on == kNoLane && stands) note_waiting(view, work.hits, crossing);
}

}  // namespace sumogamma
