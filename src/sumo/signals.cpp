#include "sumo/signals.h"

#include <algorithm>

namespace sumogamma {

std::vector<SignalId> signals_in_order(const RoadNetwork& network, const SumoBackend& backend) {
  std::vector<SignalId> order;
  for (const std::string& id : backend.signal_ids()) {
    const auto signal = network.signal_by_name.find(id);
    order.push_back(signal == network.signal_by_name.end() ? kNoSignal : signal->second);
  }
  return order;
}

void show_signals(const std::vector<SignalId>& order, const SumoStep& step, double now,
                  SumoBackend& backend, RoadState& road) {
  for (const std::uint32_t i : step.asked_signals) {
    if (order[i] == kNoSignal) continue;
    const std::size_t signal = index_of(order[i]);
    if (road.signal_states[signal] == step.signal_states[i]) continue;
    road.signal_states[signal] = step.signal_states[i];
    road.signal_since[signal] = now;
    if (std::any_of(step.signal_states[i].begin(), step.signal_states[i].end(),
                    [](char letter) { return is_amber(light_from_letter(letter)); }))
      road.amber_until[signal] = backend.next_switch(i);
  }
}

}  // namespace sumogamma
