#include "demand/lane_load.h"

#include <algorithm>
#include <cmath>

namespace sumogamma {
namespace {

constexpr double kSaturationFlow = 1900.0 / 3600.0;  // of a lane [vehicles/s]
constexpr double kCriticalGap = 5.5;                 // taken in the flow that goes first [s]
constexpr double kFollowUp = 3.0;         // between two vehicles that use the same gap [s]
constexpr double kLeast = 60.0 / 3600.0;  // one a minute gets in somehow [vehicles/s]

/// Vehicles/s that get through the gaps of a flow.
double gap_capacity(double flow) {
  if (flow < 1e-6) return 1.0 / kFollowUp;
  return flow * std::exp(-flow * kCriticalGap) / (1.0 - std::exp(-flow * kFollowUp));
}

/// Vehicles/s that go before those of a way.
double flow_ahead_of(const RoadNetwork& road, const Connection& way,
                     const std::vector<double>& flow) {
  if (way.junction == kNoJunction || way.junction_link < 0) return 0;
  const Junction& junction = road.junction(way.junction);
  const auto row = static_cast<std::size_t>(way.junction_link);
  if (row >= junction.requests.size()) return 0;
  const std::vector<bool>& yields_to = junction.requests[row].yields_to;
  double total = 0;
  for (std::size_t link = 0; link < std::min(yields_to.size(), junction.links.size()); ++link)
    if (yields_to[link] && junction.links[link] != kNoConnection)
      total += flow[index_of(junction.links[link])];
  return total;
}

/// Share of a signal's cycle for which a link shows a letter.
double share_of(const Signal& signal, int link, char letter) {
  double shown = 0, cycle = 0;
  for (const SignalPhase& phase : signal.phases) {
    cycle += phase.duration;
    const auto at = static_cast<std::size_t>(link);
    if (at < phase.state.size() && phase.state[at] == letter) shown += phase.duration;
  }
  return cycle > 0 ? shown / cycle : 0;
}

/// Vehicles/s that a way carries.
double capacity(const RoadNetwork& road, const Connection& way, const std::vector<double>& flow) {
  const double ahead = flow_ahead_of(road, way, flow);
  const auto in_gaps = [&](double of) { return ahead > 0 ? gap_capacity(of) : kSaturationFlow; };
  if (way.signal == kNoSignal) return std::clamp(in_gaps(ahead), kLeast, kSaturationFlow);
  const Signal& signal = road.signals[index_of(way.signal)];
  const double first = share_of(signal, way.signal_link, 'G');
  const double after_others = share_of(signal, way.signal_link, 'g');
  // who goes first comes in the same green
  const double in_green = after_others > 0 ? after_others * in_gaps(ahead / after_others) : 0.0;
  return std::max(kLeast, first * kSaturationFlow + in_green);
}

}  // namespace

std::vector<double> lane_loads(const RoadNetwork& road, const std::vector<double>& flow) {
  std::vector<double> load(road.lanes.size());
  for (std::size_t i = 0; i < road.connections.size(); ++i) {
    const Connection& way = road.connections[i];
    if (flow[i] > 0) load[index_of(way.from)] += flow[i] / capacity(road, way, flow);
  }
  return load;
}

}  // namespace sumogamma
