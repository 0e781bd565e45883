#include "study/red_lights.h"

namespace sumogamma {

RedLights::RedLights(const RoadNetwork& network)
    : network_(network), answer_(network.lanes.size(), -1) {}

void RedLights::update(const RoadState& road) {
  if (road.signal_states == shown_.signal_states) return;
  shown_.signal_states = road.signal_states;
  answer_.assign(answer_.size(), -1);
}

bool RedLights::ahead(LaneId lane) {
  if (lane == kNoLane) return false;
  signed char& answer = answer_[index_of(lane)];
  constexpr int kMostLanes = 24;  // in a row: networks hold lanes of centimetres
  if (answer < 0) answer = search(lane, kLookAhead, kMostLanes) ? 1 : 0;
  return answer == 1;
}

bool RedLights::search(LaneId id, double room, int depth) const {
  const Lane& lane = network_.lane(id);
  bool red = false, signalled = false, all_red = true;
  for (const ConnectionId link : lane.outgoing) {
    const Connection& connection = network_.connection(link);
    if (connection.signal == kNoSignal) continue;
    signalled = true;
    const bool shows_red = is_red(shown_.signal(connection));
    red = red || shows_red;
    all_red = all_red && shows_red;
  }
  if (signalled) return lane.kind == LaneKind::WalkingArea ? all_red : red;
  // people on foot see the crossing that they wait at; only vehicles queue over several lanes
  if (lane.kind == LaneKind::WalkingArea || lane.kind == LaneKind::Crossing || depth == 0)
    return false;
  for (const ConnectionId link : lane.outgoing) {
    const Connection& connection = network_.connection(link);
    const LaneId next = connection.via != kNoLane ? connection.via : connection.to;
    const Lane& next_lane = network_.lane(next);
    if (next_lane.kind == LaneKind::WalkingArea || next_lane.kind == LaneKind::Crossing) continue;
    const double rest = room - next_lane.centerline.length();
    // a red at the end of the next lane lies that lane's length away
    if (rest > 0 && search(next, rest, depth - 1)) return true;
  }
  return false;
}

}  // namespace sumogamma
