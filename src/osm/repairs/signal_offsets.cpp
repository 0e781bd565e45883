#include "osm/repairs/signal_offsets.h"

#include <algorithm>
#include <cmath>

namespace sumogamma::osm {

namespace {

constexpr double kClose = 60.0;   // [m]
constexpr double kSpeed = 8.0;    // of who has just set out, at the most [m/s]
constexpr double kStart = 1.0;    // it takes to set out [s]
constexpr double kTurning = 0.3;  // weight of a turn
constexpr double kFew = 0.3;      // and of who leaves a road for a path, or a path for a road
constexpr double kVehicle = 7.0;  // a shorter road has no more room than none [m]

/// Who comes over one signal and to the next.
struct Passage {
  std::string from, to;
  std::vector<int> greens;  ///< seconds of the first one's cycle
  std::vector<int> waits;   ///< by second of the second one's cycle, until it is green [s]
  int way = 0;              ///< [s]
  double weight = 0;
};

/// Never where the program doesn't know the link.
bool is_green(const SignalProgram& program, std::size_t second, int link) {
  const std::string& state = program.states[second];
  const auto place = static_cast<std::size_t>(link);
  return place < state.size() && (state[place] == 'G' || state[place] == 'g');
}

std::vector<int> green_seconds(const SignalProgram& program, int link) {
  std::vector<int> greens;
  for (std::size_t second = 0; second < program.states.size(); ++second)
    if (is_green(program, second, link)) greens.push_back(static_cast<int>(second));
  return greens;
}

/// Of a link that has green at some time.
std::vector<int> waits_for_green(const SignalProgram& program, int link) {
  const std::size_t cycle = program.states.size();
  std::vector<int> waits(cycle);
  int wait = 0;
  for (std::size_t second = 2 * cycle; second-- > 0;) {
    wait = is_green(program, second % cycle, link) ? 0 : wait + 1;
    waits[second % cycle] = wait;
  }
  return waits;
}

/// Straight on more come than by a turn, and out of a road few take a path, or out of a path a
/// road.
double weight_of(const RoadNetwork& road, const Connection& link) {
  const auto is_path = [&](LaneId lane) {
    return (road.lane(lane).allowed & ~vehicle_class::kOnFootOrBicycle) == 0;
  };
  return (link.direction == TurnDirection::Straight ? 1.0 : kTurning) *
         (is_path(link.from) == is_path(link.to) ? 1.0 : kFew);
}

std::vector<Passage> close_passages(const RoadNetwork& road,
                                    const std::vector<SignalProgram>& programs) {
  std::map<std::string, const SignalProgram*> by_name;
  for (const SignalProgram& program : programs) by_name[program.name] = &program;
  auto program_of = [&](const Connection& link) -> const SignalProgram* {
    if (link.signal == kNoSignal || link.signal_link < 0 ||
        link.direction == TurnDirection::Turnaround)
      return nullptr;
    const auto found = by_name.find(road.signals[index_of(link.signal)].name);
    return found == by_name.end() ? nullptr : found->second;
  };
  std::vector<Passage> passages;
  for (const Lane& lane : road.lanes) {
    if (lane.kind != LaneKind::Normal || lane.length > kClose) continue;
    for (const ConnectionId in : lane.incoming) {
      const Connection& first = road.connection(in);
      const SignalProgram* before = program_of(first);
      if (before == nullptr) continue;
      const std::vector<int> greens = green_seconds(*before, first.signal_link);
      if (greens.empty()) continue;
      for (const ConnectionId out : lane.outgoing) {
        const Connection& second = road.connection(out);
        const SignalProgram* behind = program_of(second);
        if (behind == nullptr || behind == before || behind->states.size() != before->states.size())
          continue;
        if (green_seconds(*behind, second.signal_link).empty()) continue;
        const double junction = first.via == kNoLane ? 0.0 : road.lane(first.via).length;
        const double speed = std::clamp(lane.speed_limit, 1.0, kSpeed);
        passages.push_back(
            {before->name, behind->name, greens, waits_for_green(*behind, second.signal_link),
             static_cast<int>(std::lround(kStart + (lane.length + junction) / speed)),
             weight_of(road, first) * weight_of(road, second) / std::max(lane.length, kVehicle)});
      }
    }
  }
  return passages;
}

/// Mean wait at the second signal [s], weighted.
double cost(const Passage& passage, const std::map<std::string, int>& offsets) {
  const int cycle = static_cast<int>(passage.waits.size());
  const int shift = passage.way + offsets.at(passage.from) - offsets.at(passage.to) + cycle;
  long sum = 0;
  for (const int second : passage.greens)
    sum += passage.waits[static_cast<std::size_t>((second + shift) % cycle)];
  return passage.weight * static_cast<double>(sum) / static_cast<double>(passage.greens.size());
}

}  // namespace

std::vector<SignalProgram> read_signal_programs(const pugi::xml_node& net) {
  std::vector<SignalProgram> programs;
  for (const pugi::xml_node logic : net.children("tlLogic")) {
    SignalProgram program{logic.attribute("id").value(), {}};
    bool whole = true;
    for (const pugi::xml_node phase : logic.children("phase")) {
      const double duration = phase.attribute("duration").as_double();
      whole = whole && duration > 0.0 && duration < 1e4 && duration == std::round(duration);
      if (!whole) break;
      program.states.insert(program.states.end(), static_cast<std::size_t>(duration),
                            phase.attribute("state").value());
    }
    if (whole && !program.states.empty()) programs.push_back(std::move(program));
  }
  return programs;
}

std::map<std::string, int> signal_offsets(const RoadNetwork& road,
                                          const std::vector<SignalProgram>& programs) {
  constexpr int kRounds = 10;
  constexpr double kBetter = 1e-6;
  const std::vector<Passage> passages = close_passages(road, programs);
  std::map<std::string, int> offsets;
  std::map<std::string, std::vector<const Passage*>> at;
  for (const Passage& passage : passages) {
    for (const std::string& name : {passage.from, passage.to}) {
      offsets[name] = 0;
      at[name].push_back(&passage);
    }
  }
  bool better = true;
  for (int round = 0; better && round < kRounds; ++round) {
    better = false;
    for (auto& [name, offset] : offsets) {
      const std::vector<const Passage*>& here = at[name];
      auto cost_here = [&] {
        double sum = 0.0;
        for (const Passage* passage : here) sum += cost(*passage, offsets);
        return sum;
      };
      const int cycle = static_cast<int>(here.front()->waits.size());
      double least = cost_here();
      int best = offset;
      for (offset = 0; offset < cycle; ++offset) {
        const double sum = cost_here();
        if (sum > least - kBetter) continue;
        least = sum;
        best = offset;
        better = true;
      }
      offset = best;
    }
  }
  return offsets;
}

void set_signal_offsets(pugi::xml_node net, const std::map<std::string, int>& offsets) {
  for (pugi::xml_node logic : net.children("tlLogic")) {
    const auto offset = offsets.find(logic.attribute("id").value());
    if (offset == offsets.end()) continue;
    if (!logic.attribute("offset")) logic.append_attribute("offset");
    logic.attribute("offset") = offset->second;
  }
}

}  // namespace sumogamma::osm
