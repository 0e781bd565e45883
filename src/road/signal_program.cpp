#include "road/signal_program.h"

#include <cmath>
#include <string>

namespace sumogamma {

std::optional<ProgramPlace> program_at(const Signal& signal, double time) {
  double cycle = 0;
  for (const SignalPhase& phase : signal.phases) cycle += phase.duration;
  if (cycle <= 0.0) return std::nullopt;
  ProgramPlace at{0, std::floor(time / cycle) * cycle};
  while (at.phase + 1 < signal.phases.size() &&
         at.since + signal.phases[at.phase].duration <= time + 1e-6)
    at.since += signal.phases[at.phase++].duration;
  return at;
}

Light light_by_program(const RoadNetwork& network, const Connection& connection, double time) {
  if (connection.signal == kNoSignal || connection.signal_link < 0) return Light::None;
  const Signal& signal = network.signals[index_of(connection.signal)];
  const std::optional<ProgramPlace> at = program_at(signal, time);
  if (!at) return Light::None;
  const std::string& state = signal.phases[at->phase].state;
  const auto link = static_cast<std::size_t>(connection.signal_link);
  return link < state.size() ? light_from_letter(state[link]) : Light::None;
}

}  // namespace sumogamma
