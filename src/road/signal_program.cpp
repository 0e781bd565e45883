#include "road/signal_program.h"

#include <cmath>

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

}  // namespace sumogamma
