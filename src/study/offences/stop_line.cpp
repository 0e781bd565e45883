#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/units.h"
#include "study/offences/judges.h"
#include "study/offences/rule_roads.h"

namespace sumogamma {

namespace {

constexpr double kJudgement = 30.0;  // a mixed stop line is dropped unjudged after so long [s]

/// Can somebody on `own` be about to leave `lane` by one of its links, or have just done so? Lanes
/// lie over one another on junctions and before them: who is on another way only drives over its
/// end.
bool leads_over(const RoadNetwork& network, LaneId own, const Lane& lane) {
  if (own == kNoLane || network.lane(own).edge == lane.edge) return true;
  const EdgeId edge = network.lane(own).edge;
  const auto& ahead = network.lane(own).outgoing;
  return std::any_of(ahead.begin(), ahead.end(),
                     [&](ConnectionId id) {
                       return network.lane(network.connection(id).to).edge == lane.edge;
                     }) ||
         std::any_of(lane.outgoing.begin(), lane.outgoing.end(), [&](ConnectionId id) {
           const Connection& link = network.connection(id);
           return network.lane(link.to).edge == edge ||
                  (link.via != kNoLane && network.lane(link.via).edge == edge);
         });
}

/// How far past a lane's stop line a point in the frame of the lane's end is [m]. The line runs
/// through the ends of the lanes side by side, askew where one is longer than the other.
double past_line(const RoadNetwork& network, const Lane& lane, const Vec2& point) {
  const LaneId beside = lane_beside(network, lane, point.y());
  if (beside == kNoLane) return point.x();
  const double last = lane.centerline.length();
  const Vec2 its_end =
      to_body(network.lane(beside).centerline.points().back() - lane.centerline.points().back(),
              lane.centerline.direction_at(last));
  const bool apart = its_end.y() * point.y() > 0.0 && std::abs(its_end.y()) > std::abs(point.y());
  return apart ? point.x() - its_end.x() * point.y() / its_end.y() : point.x();
}

double front_reach(const Footprint& footprint) {
  double reach = 0;
  for (const Vec2& vertex : footprint.outline()) reach = std::max(reach, vertex.x());
  return reach;
}

/// How a vehicle's front moved in this tick.
struct FrontMove {
  Vec2 was, now;  ///< [m]
  Vec2 forward;   ///< of the vehicle now
};

/// A vehicle's front at a stop line that it may pass or have passed in this tick.
struct AtLine {
  Vec2 now = Vec2::Zero();  ///< in the frame of the lane's end [m]
  double past = 0;          ///< of the stop line [m]; negative before it
};

/// What a vehicle's front does at the end of a lane that has signals. Nothing where it is further
/// before the line than where one meets a red light, was past it before, or crosses the lane's end
/// sideways or on its way back: it takes none of the lane's links.
std::optional<AtLine> front_at_line(const RuleView& view, std::size_t row, LaneId id,
                                    const FrontMove& front) {
  const RoadNetwork& network = view.roads.network;
  const Lane& lane = network.lane(id);
  const Vec2& end = lane.centerline.points().back();
  const Vec2 forward = lane.centerline.direction_at(lane.centerline.length());
  AtLine at;
  at.now = to_body(front.now - end, forward);
  if (std::abs(at.now.y()) > 0.5 * lane.width) return {};
  if (at.now.x() < -view.roads.stop_reach[index_of(id)]) return {};
  if (front.forward.dot(forward) < 0.5) return {};
  at.past = past_line(network, lane, at.now);
  if (at.past <= -kMeetsWithin || past_line(network, lane, to_body(front.was - end, forward)) > 0)
    return {};
  if (!leads_over(network, view.scene.lane[row].lane, lane)) return {};
  return at;
}

void read_lights(const RuleView& view, LaneId lane, StopLineLights& lights) {
  const RoadNetwork& network = view.roads.network;
  lights.lane = lane;
  lights.links = 0;
  lights.red.clear();
  for (const ConnectionId id : network.lane(lane).outgoing) {
    const Connection& connection = network.connection(id);
    if (connection.signal == kNoSignal || !for_vehicles(network.lane(connection.to))) continue;
    ++lights.links;
    // who got green at the outer signal clears the junction
    if (connection.storage == 0.0 && was_and_is_red(view, id) &&
        !admits_turn_on_red(view.roads.code, network, connection, view.road.signal(connection)))
      lights.red.push_back(id);
  }
}

void run_red(const RuleView& view, std::size_t row, const StopLineMemory& memory, const Vec2& place,
             ConnectionId link, RuleWork& work) {
  const RoadNetwork& network = view.roads.network;
  const auto agent = static_cast<std::uint32_t>(row);
  const EdgeId edge = network.lane(network.connection(link).from).edge;
  if (memory.red_met != edge) work.found.push_back({agent, Finding::RedLightMet, place, link});
  work.found.push_back({agent, Finding::RedLightRun, place, link});
}

/// Who drives between two lanes goes by the light of either: those of the lane beside take the
/// place of work.lights where they let it go.
void choose_lights(const RuleView& view, std::size_t row, double offset, RuleWork& work) {
  const RoadNetwork& network = view.roads.network;
  const Lane& lane = network.lane(work.lights.lane);
  const double width = type_of(view.types, view.scene.type[row]).width;
  const double over = std::abs(offset) + 0.5 * width - 0.5 * lane.width;
  const LaneId beside = lane_beside(network, lane, offset);
  if (!work.lights.all_red() || over <= 0 || beside == kNoLane) return;
  read_lights(view, beside, work.lights_beside);
  if (!work.lights_beside.all_red()) std::swap(work.lights, work.lights_beside);
}

/// A front has passed a stop line with work.lights at `place`.
void pass_line(const RuleView& view, std::size_t row, const Vec2& place, StopLineMemory& memory,
               RuleWork& work) {
  const StopLineLights& lights = work.lights;
  work.found.push_back({.row = static_cast<std::uint32_t>(row), .what = Finding::SignalPassed});
  if (!lights.red.empty() && lights.all_red())
    run_red(view, row, memory, place, lights.red.front(), work);
  memory.red_met = kNoEdge;
  memory.was_red = lights.red;
  if (lights.red.empty() || lights.all_red()) return;
  memory.passed = lights.lane;
  memory.passed_at = view.scene.time;
  memory.passed_place = place;
}

}  // namespace

void judge_stop_line(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work) {
  const RoadNetwork& network = view.roads.network;
  if (network.signals.empty() || !memory.known) return;
  StopLineMemory& own = memory.stop_line;
  const LaneId lane_of_path = view.scene.lane[row].lane;
  const LaneId short_of = std::exchange(own.short_of, kNoLane);
  if (lane_of_path != kNoLane && !view.roads.by_signal[index_of(lane_of_path)]) return;
  const double reach = front_reach(view.scene.footprint[row]);
  FrontMove front;
  front.forward = direction_of(view.scene.heading[row]);
  front.was = memory.position + reach * direction_of(memory.heading);
  front.now = view.scene.position[row] + reach * front.forward;
  find_lanes(
      view, row, front.was,
      [&](LaneId id) {
        return view.roads.stop_reach[index_of(id)] >= 0.0 && front_at_line(view, row, id, front);
      },
      work.hits);
  if (short_of != kNoLane) work.hits.push_back({short_of});
  for (const LaneHit& hit : work.hits) {
    const auto at = front_at_line(view, row, hit.lane, front);
    if (!at) continue;
    read_lights(view, hit.lane, work.lights);
    if (at->past > 0) {
      choose_lights(view, row, at->now.y(), work);
      pass_line(view, row, front.now, own, work);
      return;
    }
    if (at->now.x() > 0) own.short_of = hit.lane;
    const bool could_go = work.lights.all_red() && view.scene.speed[row] < kMeetsBelow;
    work.at_stop_lines.push_back({hit.lane, static_cast<std::uint32_t>(row), at->past, at->now.y(),
                                  0.5 * type_of(view.types, view.scene.type[row]).width, could_go});
  }
}

void judge_turn(const RuleView& view, std::size_t row, RuleMemory& memory, RuleWork& work) {
  StopLineMemory& own = memory.stop_line;
  if (own.passed == kNoLane) return;
  if (view.scene.time - own.passed_at > kJudgement) {
    own.passed = kNoLane;
    return;
  }
  const RoadNetwork& network = view.roads.network;
  const auto leads_to = [&](ConnectionId id, EdgeId edge) {
    return network.lane(network.connection(id).to).edge == edge;
  };
  find_lanes(
      view, row, view.scene.position[row],
      [&](LaneId id) { return network.lane(id).kind == LaneKind::Normal; }, work.hits);
  for (const LaneHit& hit : work.hits) {
    const EdgeId edge = network.lane(hit.lane).edge;
    for (const ConnectionId id : network.lane(own.passed).outgoing) {
      if (!leads_to(id, edge)) continue;
      if (std::any_of(own.was_red.begin(), own.was_red.end(),
                      [&](ConnectionId red) { return leads_to(red, edge); }))
        run_red(view, row, own, own.passed_place, id, work);
      own.passed = kNoLane;
      return;
    }
  }
}

}  // namespace sumogamma
