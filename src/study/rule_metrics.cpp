#include "study/rule_metrics.h"

#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "scene/extent.h"
#include "scene/storey.h"
#include "traffic/lateral/passing.h"

namespace sumogamma {

namespace {

using vehicle_class::kMotor;
constexpr VehicleClassMask kRoadVehicle = kMotor | vehicle_class::kBicycle;

bool for_vehicles(const Lane& lane) {
  return lane.kind != LaneKind::WalkingArea && lane.kind != LaneKind::Crossing &&
         (lane.allowed & kRoadVehicle);
}

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

/// Lanes on which somebody can be about to leave a lane with signals or have just done so
/// (leads_over), by id.
std::vector<bool> lanes_by_signals(const RoadNetwork& network) {
  std::vector<bool> edges(network.edges.size(), false), lanes(network.lanes.size(), false);
  const auto mark = [&](LaneId lane) { edges[index_of(network.lane(lane).edge)] = true; };
  const auto is_signalled = [&](ConnectionId id) {
    return network.connection(id).signal != kNoSignal;
  };
  for (const Lane& lane : network.lanes) {
    if (std::none_of(lane.outgoing.begin(), lane.outgoing.end(), is_signalled)) continue;
    for (const LaneId beside : network.edge(lane.edge).lanes) {
      mark(beside);
      for (const ConnectionId link : network.lane(beside).incoming)
        lanes[index_of(network.connection(link).from)] = true;
    }
    for (const ConnectionId link : lane.outgoing) {
      mark(network.connection(link).to);
      if (network.connection(link).via != kNoLane) mark(network.connection(link).via);
    }
  }
  for (std::size_t i = 0; i < lanes.size(); ++i)
    if (edges[index_of(network.lanes[i].edge)]) lanes[i] = true;
  return lanes;
}

double front_reach(const Footprint& footprint) {
  double reach = 0;
  for (const Vec2& vertex : footprint.outline()) reach = std::max(reach, vertex.x());
  return reach;
}

}  // namespace

RuleMonitor::RuleMonitor(double step, const RoadNetwork& network, const LaneLocator& locator)
    : step_(step),
      network_(network),
      locator_(locator),
      has_storeys_(has_storeys(network)),
      by_signal_(lanes_by_signals(network)) {}

void RuleMonitor::add(const Scene& scene, const AgentTypeTable& types, const RoadState& road) {
  by_type_.resize(types.size());
  new_events_.clear();
  at_lines_.clear();
  track_.match(scene.id);
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const AgentType& type = type_of(types, scene.type[row]);
    const Row agent{scene, row, type,
                    by_type_[static_cast<std::size_t>(kind_of(types, scene.type[row]))]};
    State& state = track_[row];
    const Vec2 front =
        scene.position[row] + front_reach(scene.footprint[row]) * direction_of(scene.heading[row]);
    // after a jump (a teleport of SUMO) nothing was passed
    if (state.known &&
        (scene.position[row] - state.center).norm() > 2.0 * type.max_speed * step_ + 1.0)
      state = State{};
    if (type.kinematics == Kinematics::Holonomic) {
      judge_crossing(agent, state, road);
      judge_mid_block(agent, state, road);
    } else if (scene.control[row] != Control::Parked && !type.guided) {
      judge_ground(agent, state);
      if (state.known) judge_stop_line(agent, state, front, road);
      if (state.passed != kNoLane) judge_turn(agent, state);
    }
    state.known = true;
    state.front = front;
    state.center = scene.position[row];
  }
  count_red_lights_met();
  before_.signal_states = road.signal_states;
}

void RuleMonitor::find_lanes(const Row& agent, const Vec2& point,
                             std::vector<LaneHit>& hits) const {
  locator_.find_containing(point, hits);
  const LanePosition& own = agent.scene.lane[agent.row];
  if (!has_storeys_ || own.lane == kNoLane) return;
  auto ground_at = [&](LaneId lane, double along) {
    return Ground{lane, along, elevation_at(network_.lane(lane), along)};
  };
  const Ground ground = ground_at(own.lane, own.along);
  std::erase_if(hits, [&](const LaneHit& hit) {
    return on_other_storey(network_, ground, ground_at(hit.lane, hit.along));
  });
}

void RuleMonitor::extend(Offence kind, const Row& agent, State& state) {
  std::int32_t& index = state.span[static_cast<std::size_t>(kind)];
  const double now = agent.scene.time;
  if (index >= 0) {
    OffenceSpan& span = offences_[static_cast<std::size_t>(index)];
    if (now - span.since - span.duration < kPause) {
      span.duration = now - span.since;
      return;
    }
  }
  index = static_cast<std::int32_t>(offences_.size());
  offences_.push_back({kind, agent.scene.id[agent.row], agent.scene.type[agent.row],
                       agent.scene.position[agent.row], now - step_, step_});
}

bool RuleMonitor::overtakes(const Row& agent, const LaneHit& hit) const {
  const LaneId own = network_.lane(hit.lane).opposite;
  if (own == kNoLane) return false;
  const Lane& lane = network_.lane(own);
  const Scene& scene = agent.scene;
  for (std::size_t row = 0; row < scene.size(); ++row) {
    const Vec2& position = scene.position[row];
    const Vec2 way = position - scene.position[agent.row];
    // who is ahead is overtaken while the agent closes up, too
    const Vec2& velocity = scene.velocity[agent.row];
    const double closes = kSoon * (scene.speed[agent.row] - scene.speed[row]);
    const double reach = way.dot(velocity) > 0.0 ? std::max(kBeside, closes) : kBeside;
    if (row == agent.row || way.norm() > reach) continue;
    const Vec2 forward = direction_of(scene.heading[row]);
    if (!is_narrow(2.0 * half_extent(scene, row, left_of(forward))) ||
        forward.dot(hit.direction) > -0.5 || scene.speed[row] > scene.speed[agent.row] + kFaster)
      continue;
    if (lane.centerline.project(position).distance < 0.5 * lane.width) return true;
  }
  return false;
}

RuleMonitor::Place RuleMonitor::place_at(const Row& agent, const Vec2& point) {
  find_lanes(agent, point, hits_);
  Place place;
  place.none = hits_.empty();
  place.junction = locator_.on_junction(point);
  const Vec2& velocity = agent.scene.velocity[agent.row];
  const double limit = -0.5 * velocity.norm();  // cos 120 degrees
  bool on_road = false, on_walkway = false, explained = place.junction;
  for (const LaneHit& hit : hits_) {
    const Lane& lane = network_.lane(hit.lane);
    if (for_vehicles(lane)) {
      on_road = on_road || (lane.allowed & kMotor);
      if (velocity.dot(hit.direction) >= limit)
        explained = true;
      else if (lane.kind == LaneKind::Normal)
        place.against = hit;
    }
    const bool beside_road = lane.kind == LaneKind::Normal || lane.kind == LaneKind::WalkingArea;
    if ((lane.allowed & vehicle_class::kPedestrian) && !(lane.allowed & kMotor) && beside_road)
      on_walkway = true;
  }
  if (explained) place.against.reset();
  place.walkway = on_walkway && !on_road;
  return place;
}

bool RuleMonitor::in_gap(const Row& agent, const Vec2& point) {
  auto is_road = [&](const Vec2& place) {
    if (locator_.on_junction(place)) return true;
    find_lanes(agent, place, front_hits_);
    return std::any_of(front_hits_.begin(), front_hits_.end(),
                       [&](const LaneHit& hit) { return for_vehicles(network_.lane(hit.lane)); });
  };
  // along, across and both diagonals of the agent
  constexpr int kAxes = 4;
  for (int k = 0; k < kAxes; ++k) {
    const Vec2 reach = kGap * direction_of(agent.scene.heading[agent.row] + k * kPi / kAxes);
    if (is_road(point + reach) && is_road(point - reach)) return true;
  }
  return false;
}

bool RuleMonitor::keeps_its_lane(const Row& agent) const {
  constexpr double kMoved = 20.0;  // since its place on the lane was found [m]
  const LanePosition& own = agent.scene.lane[agent.row];
  if (own.lane == kNoLane) return false;
  const Lane& lane = network_.lane(own.lane);
  if (!for_vehicles(lane) || !(lane.allowed & kMotor)) return false;
  const PolylinePosition place = lane.centerline.project(agent.scene.position[agent.row],
                                                         own.along - kMoved, own.along + kMoved);
  return place.along > 0.0 && place.along < lane.centerline.length() &&
         place.distance <= 0.5 * lane.width &&
         agent.scene.velocity[agent.row].dot(lane.centerline.direction_at(place.along)) >= 0.0;
}

void RuleMonitor::judge_ground(const Row& agent, State& state) {
  if (keeps_its_lane(agent)) return;
  const Vec2& center = agent.scene.position[agent.row];
  const Place here = place_at(agent, center);
  if (here.none) {
    if (!here.junction && !in_gap(agent, center)) {
      agent.counts.off_road_s += step_;
      extend(Offence::OffRoad, agent, state);
    }
    return;
  }
  const Vec2 forward = direction_of(agent.scene.heading[agent.row]);
  const Vec2& velocity = agent.scene.velocity[agent.row];
  const bool drives = velocity.norm() > kMoving && velocity.dot(forward) > 0.0;
  const bool against = here.against && drives;
  const bool walkway =
      here.walkway && (vehicle_class_from_name(agent.type.sumo_class) & kMotor) != 0;
  if (!against && !walkway) return;
  // nobody is where it ought not to be by less than kOver
  const Place left = place_at(agent, center + kOver * left_of(forward)),
              right = place_at(agent, center - kOver * left_of(forward));
  if (against && left.against && right.against) {
    if (overtakes(agent, *here.against)) {
      agent.counts.overtaking_s += step_;
    } else {
      agent.counts.wrong_way_s += step_;
      extend(Offence::WrongWay, agent, state);
    }
  }
  if (walkway && left.walkway && right.walkway) {
    agent.counts.sidewalk_by_vehicle_s += step_;
    extend(Offence::Sidewalk, agent, state);
  }
}

bool RuleMonitor::was_and_is_red(const Connection& connection, const RoadState& road) const {
  return is_red(before_.signal(connection)) && is_red(road.signal(connection));
}

bool RuleMonitor::shows_red(const Lane& crossing, const RoadState& road) const {
  return std::any_of(crossing.incoming.begin(), crossing.incoming.end(), [&](ConnectionId link) {
    return was_and_is_red(network_.connection(link), road);
  });
}

void RuleMonitor::record_red(const Row& agent, State& state, const Vec2& place,
                             ConnectionId connection) {
  const EdgeId edge = network_.lane(network_.connection(connection).from).edge;
  if (state.red_met != edge) ++agent.counts.red_lights_met;
  ++agent.counts.red_light_crossings;
  offences_.push_back({Offence::RedLight, agent.scene.id[agent.row], agent.scene.type[agent.row],
                       place, agent.scene.time, 0});
  new_events_.push_back({agent.scene.time, agent.scene.id[agent.row], place, connection});
}

void RuleMonitor::judge_stop_line(const Row& agent, State& state, const Vec2& front,
                                  const RoadState& road) {
  if (network_.signals.empty()) return;
  const LaneId own = agent.scene.lane[agent.row].lane;
  if (own != kNoLane && !by_signal_[index_of(own)]) {
    state.short_of = kNoLane;
    return;
  }
  find_lanes(agent, state.front, front_hits_);
  if (state.short_of != kNoLane) front_hits_.push_back({state.short_of});
  state.short_of = kNoLane;
  for (const LaneHit& hit : front_hits_) {
    const Lane& lane = network_.lane(hit.lane);
    if (lane.kind != LaneKind::Normal || !for_vehicles(lane)) continue;
    if (!leads_over(network_, own, lane)) continue;
    const Vec2& end = lane.centerline.points().back();
    const Vec2 forward = lane.centerline.direction_at(lane.centerline.length());
    const Vec2 now = to_body(front - end, forward), was = to_body(state.front - end, forward);
    if (std::abs(now.y()) > 0.5 * lane.width) continue;
    const double past = past_line(network_, lane, now);
    if (past <= -kMeets || past_line(network_, lane, was) > 0) continue;
    // someone who crosses the lane's end sideways or on its way back doesn't take the lane's links
    if (direction_of(agent.scene.heading[agent.row]).dot(forward) < 0.5) continue;
    const std::size_t links = find_red_links(lane, road, red_links_);
    if (links == 0) continue;
    if (past <= 0) {
      if (now.x() > 0) state.short_of = hit.lane;
      const bool meets = red_links_.size() == links && agent.scene.speed[agent.row] < kSlow;
      at_lines_.push_back({hit.lane, agent.row, past, now.y(), 0.5 * agent.type.width,
                           meets ? &agent.counts : nullptr});
      continue;
    }
    // who drives between two lanes goes by the light of either
    LaneId passed = hit.lane;
    std::size_t its_links = links;
    if (red_links_.size() == links) {
      const double over = std::abs(now.y()) + 0.5 * agent.type.width - 0.5 * lane.width;
      const LaneId beside = lane_beside(network_, lane, now.y());
      if (over > 0 && beside != kNoLane) {
        const std::size_t others = find_red_links(network_.lane(beside), road, beside_red_);
        if (beside_red_.size() < others) {
          passed = beside;
          its_links = others;
          red_links_ = beside_red_;
        }
      }
    }
    state.was_red = red_links_;
    ++agent.counts.signal_crossings;
    if (!state.was_red.empty() && state.was_red.size() == its_links)
      record_red(agent, state, front, state.was_red.front());
    state.red_met = kNoEdge;
    if (state.was_red.empty() || state.was_red.size() == its_links) return;
    state.passed = passed;
    state.passed_at = agent.scene.time;
    state.passed_place = front;
    return;
  }
}

std::size_t RuleMonitor::find_red_links(const Lane& lane, const RoadState& road,
                                        std::vector<ConnectionId>& red) const {
  std::size_t links = 0;
  red.clear();
  for (const ConnectionId id : lane.outgoing) {
    const Connection& connection = network_.connection(id);
    if (connection.signal == kNoSignal || !for_vehicles(network_.lane(connection.to))) continue;
    ++links;
    // who got green at the outer signal clears the junction
    if (connection.storage == 0.0 && was_and_is_red(connection, road)) red.push_back(id);
  }
  return links;
}

/// Those who stand before a red light and have nobody in front of them.
void RuleMonitor::count_red_lights_met() {
  for (const AtLine& own : at_lines_) {
    if (!own.meets) continue;
    State& state = track_[own.row];
    const EdgeId edge = network_.lane(own.lane).edge;
    if (state.red_met == edge) continue;
    const bool held = std::any_of(at_lines_.begin(), at_lines_.end(), [&](const AtLine& other) {
      return other.lane == own.lane && other.row != own.row && other.along > own.along &&
             std::abs(other.offset - own.offset) < other.half_width + own.half_width;
    });
    if (held) continue;
    ++own.meets->red_lights_met;
    state.red_met = edge;
  }
}

void RuleMonitor::judge_turn(const Row& agent, State& state) {
  if (agent.scene.time - state.passed_at > kJudgement) {
    state.passed = kNoLane;
    return;
  }
  find_lanes(agent, agent.scene.position[agent.row], hits_);
  for (const LaneHit& hit : hits_) {
    const Lane& lane = network_.lane(hit.lane);
    if (lane.kind != LaneKind::Normal) continue;
    for (const ConnectionId id : network_.lane(state.passed).outgoing) {
      if (network_.lane(network_.connection(id).to).edge != lane.edge) continue;
      const bool red =
          std::find_if(state.was_red.begin(), state.was_red.end(), [&](ConnectionId other) {
            return network_.lane(network_.connection(other).to).edge == lane.edge;
          }) != state.was_red.end();
      if (red) record_red(agent, state, state.passed_place, id);
      state.passed = kNoLane;
      return;
    }
  }
}

bool RuleMonitor::is_on_its_walkway(const Row& agent) const {
  const LanePosition& own = agent.scene.lane[agent.row];
  if (own.lane == kNoLane) return false;
  const Lane& lane = network_.lane(own.lane);
  if (lane.kind == LaneKind::Normal) return std::abs(own.offset) <= 0.5 * lane.width + kEntered;
  return lane.kind == LaneKind::WalkingArea &&
         std::any_of(hits_.begin(), hits_.end(),
                     [&](const LaneHit& hit) { return hit.lane == own.lane; });
}

void RuleMonitor::judge_crossing(const Row& agent, State& state, const RoadState& road) {
  if (network_.signals.empty()) return;
  const Vec2& center = agent.scene.position[agent.row];
  find_lanes(agent, center, hits_);
  const bool stands = agent.scene.velocity[agent.row].norm() < kStands;
  const bool on_walkway = is_on_its_walkway(agent);
  constexpr double kNearEnd = 1.0;  // [m]
  LaneId on = kNoLane, at_end_of = kNoLane;
  bool amid = false;
  for (const LaneHit& hit : hits_) {
    const Lane& lane = network_.lane(hit.lane);
    if (lane.kind != LaneKind::Crossing) continue;
    // once on it, one is on it to its very ends
    const bool enters = hit.lane != state.on_crossing;
    const double margin = enters ? kEntered : 0.0;
    if ((enters && on_walkway) || hit.along < margin ||
        hit.along > lane.centerline.length() - margin) {
      // who waits there steps on when it starts
      if (state.at_end_of != hit.lane || stands) state.stepped_on_red = shows_red(lane, road);
      at_end_of = hit.lane;
      continue;
    }
    on = hit.lane;
    amid = hit.along > kNearEnd && hit.along < lane.centerline.length() - kNearEnd;
    if (on == state.on_crossing) break;
  }
  // who goes beside it, round somebody who stands over it, has set out when its way got there
  const LaneId own = agent.scene.lane[agent.row].lane;
  if (on == kNoLane && own != kNoLane && network_.lane(own).kind == LaneKind::Crossing) {
    if (state.at_end_of != own) state.stepped_on_red = shows_red(network_.lane(own), road);
    at_end_of = own;
  }
  if (on != kNoLane && on != state.on_crossing) {
    const Lane& lane = network_.lane(on);
    const auto link =
        std::find_if(lane.incoming.begin(), lane.incoming.end(),
                     [&](ConnectionId id) { return network_.connection(id).signal != kNoSignal; });
    if (link != lane.incoming.end() && state.known) {
      ++agent.counts.signal_crossings;
      const auto& waited_for = state.red_crossings;
      const bool stepped_on_red = state.at_end_of != on || state.stepped_on_red;
      if (stepped_on_red && was_and_is_red(network_.connection(*link), road))
        record_red(agent, state, center, *link);
      else if (state.waited >= kWaits &&
               std::find(waited_for.begin(), waited_for.end(), on) != waited_for.end())
        ++agent.counts.red_lights_met;
    }
    state.waited = 0;
    state.red_crossings.clear();
  }
  state.at_end_of = at_end_of;
  const double now = agent.scene.time;
  if (on != kNoLane) {
    state.amid = amid;
    state.last_on = now;
  }
  // who has gone aside amid the road, be it round somebody who stands over the crossing, for as
  // long as its way leads over it
  const bool crosses = agent.scene.lane[agent.row].lane == state.on_crossing;
  const bool beside = on == kNoLane && state.amid && (crosses || now - state.last_on <= kAside);
  if (!beside) state.on_crossing = on;
  if (on == kNoLane && stands) note_waiting(state, road);
}

void RuleMonitor::judge_mid_block(const Row& agent, State& state, const RoadState& road) {
  const Path* path = road.path(agent.scene.path[agent.row]);
  if (path == nullptr) return;
  const double along = agent.scene.path_along[agent.row];
  if (state.known)
    for (const RoadCrossing& piece : path->over_road)
      if (state.along < piece.end && along >= piece.end && state.along > piece.begin)
        ++agent.counts.mid_block_crossings;
  state.along = along;
}

void RuleMonitor::note_waiting(State& state, const RoadState& road) {
  // judge_crossing has just found the lanes of the centre
  bool red = false;
  for (const LaneHit& hit : hits_) {
    const Lane& area = network_.lane(hit.lane);
    if (area.kind != LaneKind::WalkingArea) continue;
    auto look = [&](LaneId id) {
      const Lane& crossing = network_.lane(id);
      if (crossing.kind != LaneKind::Crossing) return;
      if (!shows_red(crossing, road)) return;
      red = true;
      auto& known = state.red_crossings;
      if (std::find(known.begin(), known.end(), id) == known.end()) known.push_back(id);
    };
    // a crossing is entered at either end
    for (const ConnectionId link : area.outgoing) look(network_.connection(link).to);
    for (const ConnectionId link : area.incoming) look(network_.connection(link).from);
  }
  if (red) state.waited += step_;
}

RuleResult RuleMonitor::result(const AgentTypeTable& types) const {
  RuleResult result;
  for (std::size_t type = 0; type < by_type_.size(); ++type) {
    if (types[type].variant_of >= 0) continue;
    const RuleCounts& counts = by_type_[type];
    result.by_type[types[type].name] = counts;
    result.all.red_light_crossings += counts.red_light_crossings;
    result.all.signal_crossings += counts.signal_crossings;
    result.all.red_lights_met += counts.red_lights_met;
    result.all.mid_block_crossings += counts.mid_block_crossings;
    result.all.wrong_way_s += counts.wrong_way_s;
    result.all.overtaking_s += counts.overtaking_s;
    result.all.off_road_s += counts.off_road_s;
    result.all.sidewalk_by_vehicle_s += counts.sidewalk_by_vehicle_s;
  }
  return result;
}

}  // namespace sumogamma
