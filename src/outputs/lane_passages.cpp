#include "outputs/lane_passages.h"

#include <algorithm>
#include <deque>
#include <map>

namespace sumogamma {

namespace {

constexpr double kWaitingSpeed = 0.1;  // SUMO's halting speed [m/s]
constexpr double kLongestGap = 1.0;    // without a place, over which a drive is taken as one [s]

double free_speed_of(const OutputVehicle& vehicle, const VehiclePlace& place) {
  return std::min(vehicle.max_speed, place.speed_limit * vehicle.speed_factor);
}

/// The lanes to which one leads on.
template <typename Visit>
void visit_next(const RoadNetwork& network, LaneId lane, Visit&& visit) {
  for (const ConnectionId id : network.lane(lane).outgoing) {
    const Connection& connection = network.connection(id);
    visit(connection.via != kNoLane ? connection.via : connection.to);
  }
}

}  // namespace

void LanePassages::begin_step(double begin) {
  begin_ = begin;
  passages_.clear();
}

void LanePassages::end_step() {
  std::stable_sort(passages_.begin(), passages_.end(),
                   [](const LanePassage& a, const LanePassage& b) { return a.lane < b.lane; });
}

std::span<const LanePassage> LanePassages::passages_on(LaneId lane) const {
  struct ByLane {
    bool operator()(const LanePassage& a, LaneId b) const { return a.lane < b; }
    bool operator()(LaneId a, const LanePassage& b) const { return a < b.lane; }
  };
  const auto [begin, end] = std::equal_range(passages_.begin(), passages_.end(), lane, ByLane{});
  return {begin, end};
}

LanePassage LanePassages::passage(const OutputVehicle& vehicle, const VehiclePlace& place) const {
  LanePassage one;
  one.vehicle = place.vehicle;
  one.lane = place.lane;
  one.from = one.to = place.front;
  one.begin = begin_;
  one.speed = place.speed;
  one.free_speed = free_speed_of(vehicle, place);
  one.stopped = place.stopped;
  return one;
}

void LanePassages::move(const OutputVehicle& vehicle, const VehiclePlace& place) {
  if (place.vehicle >= states_.size()) states_.resize(place.vehicle + 1);
  State& state = states_[place.vehicle];
  if (place.lane == kNoLane) {
    // parked: time of its stop, and no lane's
    end(vehicle, place.vehicle, false);
    if (state.departed && place.stopped) state.odometer.stop_time += step_;
    return;
  }
  const bool was_there = state.on_road && begin_ - state.at < kLongestGap;
  if (!was_there) {
    end(vehicle, place.vehicle, false);
    begin_trip(vehicle, place, state);
  } else {
    drive(vehicle, place, state);
  }
  state.place = place;
  state.at = begin_ + step_;
}

void LanePassages::begin_trip(const OutputVehicle& vehicle, const VehiclePlace& place,
                              State& state) {
  const double way = std::min(place.speed * step_, place.front);
  LanePassage entry = passage(vehicle, place);
  entry.from = entry.to = place.front - way;
  entry.entry = state.departed ? LaneEntry::Placed : LaneEntry::Departed;
  passages_.push_back(entry);
  if (!state.departed) {
    state.first = place;
    state.first.front = entry.from;
    state.departed = true;
  }
  state.covered.assign(1, {place.lane, 0.0});
  state.front = entry.from;
  state.at = begin_;
  state.place = place;
  state.on_road = true;
  advance(vehicle, place, way, state, state.covered.size());
}

std::vector<LaneId> LanePassages::way_to(LaneId from, EdgeId edge, LaneId preferred) const {
  constexpr std::size_t kMostLanes = 64;
  std::deque<LaneId> open{from};
  std::map<LaneId, LaneId> before{{from, kNoLane}};
  LaneId found = kNoLane;
  while (!open.empty() && before.size() < kMostLanes && found != preferred) {
    const LaneId lane = open.front();
    open.pop_front();
    visit_next(network_, lane, [&](LaneId next) {
      if (!before.emplace(next, lane).second) return;
      if (network_.lane(next).edge == edge && (found == kNoLane || next == preferred))
        found = next;
      else
        open.push_back(next);
    });
  }
  std::vector<LaneId> way;
  for (LaneId lane = found; lane != kNoLane && lane != from; lane = before.at(lane))
    way.push_back(lane);
  std::reverse(way.begin(), way.end());
  return way;
}

void LanePassages::drive(const OutputVehicle& vehicle, const VehiclePlace& place, State& state) {
  const LaneId here = state.place.lane;
  const EdgeId edge = network_.lane(place.lane).edge;
  if (network_.lane(here).edge == edge &&
      place.front > state.place.front - 0.5 * network_.lane(here).length) {
    // who backs up is taken to stand until it is past where it was
    const double on_lane = state.front - state.covered.back().start;
    advance(vehicle, place, std::max(0.0, place.front - on_lane), state, state.covered.size());
  } else {
    std::vector<LaneId> way = way_to(here, edge, place.lane);
    for (const LaneId beside : network_.edge(network_.lane(here).edge).lanes) {
      if (!way.empty() || beside == here) continue;
      way = way_to(beside, edge, place.lane);
      if (!way.empty()) change_lane(passage(vehicle, state.place), beside, state);
    }
    if (way.empty()) {
      // a jump
      end(vehicle, place.vehicle, false);
      begin_trip(vehicle, place, state);
      return;
    }
    double begin = state.covered.back().start + network_.lane(state.covered.back().lane).length;
    const std::size_t entered = state.covered.size();
    for (const LaneId lane : way) {
      state.covered.push_back({lane, begin});
      begin += network_.lane(lane).length;
    }
    const double front = state.covered.back().start + place.front;
    advance(vehicle, place, std::max(0.0, front - state.front), state, entered);
  }
  if (state.covered.back().lane != place.lane)
    change_lane(passage(vehicle, place), place.lane, state);
}

void LanePassages::advance(const OutputVehicle& vehicle, const VehiclePlace& place, double way,
                           State& state, std::size_t entered) {
  LanePassage one = passage(vehicle, place);
  one.begin = state.at;
  one.duration = begin_ + step_ - state.at;
  for (std::size_t i = 0; i < state.covered.size(); ++i) {
    const Covered& lane = state.covered[i];
    one.lane = lane.lane;
    one.from = state.front - lane.start;
    one.to = one.from + way;
    one.entry = i >= entered ? LaneEntry::Junction : LaneEntry::None;
    const bool was_front = i + 1 >= entered && i + 1 < state.covered.size();
    one.exit = was_front ? LaneExit::Junction : LaneExit::None;
    passages_.push_back(one);
  }
  state.front += way;
  std::erase_if(state.covered, [&](const Covered& lane) {
    return &lane != &state.covered.back() &&
           state.front - vehicle.length > lane.start + network_.lane(lane.lane).length;
  });
  add_up(vehicle, place, way, state);
}

void LanePassages::add_up(const OutputVehicle& vehicle, const VehiclePlace& place, double way,
                          State& state) const {
  TripOdometer& odometer = state.odometer;
  const double time = begin_ + step_ - state.at;
  odometer.distance += way;
  if (place.stopped) {
    odometer.stop_time += time;
    return;
  }
  const double free = free_speed_of(vehicle, place);
  if (free > 0.0) odometer.time_loss += time * (free - place.speed) / free;
  const bool waits = place.speed <= kWaitingSpeed;
  if (waits) odometer.waiting_time += time;
  if (waits && !odometer.waits) ++odometer.waiting_count;
  odometer.waits = waits;
}

void LanePassages::change_lane(const LanePassage& like, LaneId to, State& state) {
  LanePassage one = like;
  one.duration = 0.0;
  one.lane = state.covered.back().lane;
  one.from = one.to = state.front - state.covered.back().start;
  one.exit = LaneExit::LaneChange;
  passages_.push_back(one);
  state.covered.back().lane = to;
  one.lane = to;
  one.exit = LaneExit::None;
  one.entry = LaneEntry::LaneChange;
  passages_.push_back(one);
}

void LanePassages::end(const OutputVehicle& vehicle, std::uint32_t index, bool arrived) {
  if (index >= states_.size() || !states_[index].on_road) return;
  State& state = states_[index];
  if (arrived && begin_ - state.at < kLongestGap)
    advance(vehicle, state.place, state.place.speed * step_, state, state.covered.size());
  LanePassage last = passage(vehicle, state.place);
  last.lane = state.covered.back().lane;
  last.from = last.to = state.front - state.covered.back().start;
  last.exit = arrived ? LaneExit::Arrived : LaneExit::Taken;
  passages_.push_back(last);
  state.place.lane = last.lane;
  state.place.front = last.to;
  state.covered.clear();
  state.on_road = false;
  state.odometer.waits = false;
}

}  // namespace sumogamma
