#include "study/red_lights.h"

#include <algorithm>

namespace sumogamma {

namespace {

/// Lanes that are full up to their begin, in order.
std::vector<LaneId> filled_lanes(const RoadNetwork& network, const Scene& scene) {
  constexpr double kStands = 1.0;  // queues creep [m/s]
  std::vector<LaneId> filled;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const LanePosition& place = scene.lane[row];
    if (place.lane == kNoLane || place.along > RedLights::kTail) continue;
    const LaneKind kind = network.lane(place.lane).kind;
    const bool road = kind == LaneKind::Normal || kind == LaneKind::Internal;
    if (road && scene.velocity[row].norm() < kStands) filled.push_back(place.lane);
  }
  std::sort(filled.begin(), filled.end());
  filled.erase(std::unique(filled.begin(), filled.end()), filled.end());
  return filled;
}

}  // namespace

RedLights::RedLights(const RoadNetwork& network)
    : network_(network), in_queue_(network.lanes.size(), 0), answer_(network.lanes.size(), -1) {}

void RedLights::update(const RoadState& road, const Scene& scene) {
  std::vector<LaneId> filled = filled_lanes(network_, scene);
  if (road.signal_states == shown_.signal_states && filled == filled_) return;
  shown_.signal_states = road.signal_states;
  filled_ = std::move(filled);
  answer_.assign(answer_.size(), -1);
  in_queue_.assign(in_queue_.size(), 0);
  // upstream, lane by lane, whatever their order
  for (bool grows = true; grows;) {
    grows = false;
    for (const LaneId lane : filled_) {
      if (in_queue_[index_of(lane)] != 0 || !search(lane)) continue;
      in_queue_[index_of(lane)] = 1;
      grows = true;
    }
  }
}

bool RedLights::ahead(LaneId lane) {
  if (lane == kNoLane) return false;
  signed char& answer = answer_[index_of(lane)];
  if (answer < 0) answer = search(lane) ? 1 : 0;
  return answer == 1;
}

bool RedLights::search(LaneId lane) const {
  constexpr int kMostLanes = 24;  // in a row: networks hold lanes of centimetres
  return search(lane, kLookAhead, kMostLanes);
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
    if (in_queue_[index_of(next)] != 0 && kLookAhead - room < kJunction) return true;
    const double rest = room - next_lane.centerline.length();
    // a red at the end of the next lane lies that lane's length away
    if (rest > 0 && search(next, rest, depth - 1)) return true;
  }
  return false;
}

}  // namespace sumogamma
