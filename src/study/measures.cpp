#include "study/measures.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace sumogamma {

namespace {

constexpr std::array kMeasures{
    Measure{"agents.arrived", "Agents that arrived", "", Better::Higher},
    Measure{"agents.mean_travel_time_s", "Travel time, mean of who arrived", "s", Better::Lower},
    Measure{"flow.mean_speed", "Speed, mean", "m/s", Better::Higher},
    Measure{"flow.waiting_time_mean_s", "Waiting time, mean of a trip", "s", Better::Lower},
    Measure{"traffic.delay_mean_s", "Delay, mean of an agent", "s", Better::Lower},
    Measure{"flow.stuck_agents", "Agents that stood for a minute without a red light", "",
            Better::Lower},
    Measure{"flow.held_agents", "Agents that got no further than 4 m in 100 s", "", Better::Lower},
    Measure{"collisions.unique_pairs", "Pairs of agents that overlapped", "", Better::Lower},
    Measure{"collisions.deep_pairs", "Pairs that overlapped deeper than 0.1 m", "", Better::Lower},
    Measure{"safety.conflicts_fhwa", "Conflicts, under 1.5 s to collision (FHWA)", "",
            Better::Lower},
    Measure{"safety.conflicts_fhwa_per_100_km", "Conflicts per 100 km", "", Better::Lower},
    Measure{"safety.near_misses", "Near misses, under 1 s to collision", "", Better::Lower},
    Measure{"rules.red_light_crossings", "Red lights run", "", Better::Lower},
    Measure{"rules.wrong_way_s", "Time against the direction of all lanes", "s", Better::Lower},
    Measure{"rules.off_road_s", "Time off the road", "s", Better::Lower},
    Measure{"smoothness.accel_p95", "Acceleration of vehicles, 95th percentile", "m/s²",
            Better::Lower},
    Measure{"smoothness.jerk_p95", "Jerk of vehicles, 95th percentile", "m/s³", Better::Lower},
    Measure{"agents.inserted", "Agents that entered", ""},
    Measure{"flow.distance_km", "Way covered by all", "km"},
};

bool begins_with_any(std::string_view key, std::initializer_list<std::string_view> prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return key.rfind(prefix, 0) == 0; });
}

}  // namespace

std::span<const Measure> named_measures() { return kMeasures; }

Measure measure_of(std::string_view key) {
  const auto found = std::find_if(kMeasures.begin(), kMeasures.end(),
                                  [&](const Measure& one) { return one.key == key; });
  return found == kMeasures.end() ? Measure{key, key, ""} : *found;
}

bool is_setting(std::string_view key) {
  return key.find('.') == std::string_view::npos || begins_with_any(key, {"clock.", "behavior."});
}

bool is_zero_where_absent(std::string_view key) {
  return begins_with_any(
      key, {"collisions.by_types.", "safety.by_types.", "agents.removed.", "agents.left_to_sumo."});
}

bool is_about_machine(std::string_view key) {
  return key == "threads" || key == "backend" || begins_with_any(key, {"timing."});
}

}  // namespace sumogamma
