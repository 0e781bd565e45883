#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "prediction/live_predictor.h"
#include "scene/trip.h"
#include "study/collisions.h"
#include "study/coupling_metrics.h"
#include "study/flow_metrics.h"
#include "study/rule_metrics.h"
#include "study/safety/conflicts.h"
#include "study/smoothness_metrics.h"
#include "study/traffic_measures.h"
#include "sumo/scenario_inventory.h"

namespace sumogamma {

/// Agents that came and went.
struct AgentCounts {
  struct ByType {
    std::uint64_t inserted = 0, arrived = 0;
    double mean_travel_time = 0;  ///< of the arrived [s]
  };
  double mean_travel_time = 0;  ///< of all who arrived [s]
  std::uint64_t inserted = 0, arrived = 0;
  std::uint64_t controlled_now = 0, controlled_peak = 0;  ///< driven by GAMMA at the end, at most
  double controlled_mean = 0;                             ///< over the ticks
  std::uint64_t detours = 0;                              ///< taken by drivers whose way was shut
  std::map<std::string, ByType> by_type;
  std::map<std::string, std::uint64_t> removed;  ///< taken out before their destination, by reason
  std::map<std::string, std::uint64_t> left_to_sumo;  ///< asked for and not driven, by reason
  std::uint64_t stops_served = 0;                 ///< planned halts of vehicles that GAMMA drives
  std::uint64_t rides = 0;                        ///< times that somebody boarded a vehicle
  std::uint64_t taken_over = 0, handed_back = 0;  ///< in motion, from and to SUMO
  std::uint64_t kept_on_foot = 0;                 ///< people whom SUMO would have frozen
  std::uint64_t insertions_delayed = 0;           ///< of SUMO's vehicles, for ghosts in their place
};

/// Median, 95th percentile and largest of some figures.
struct Quantiles {
  double median = 0, p95 = 0, max = 0;
};

/// How SUMO went on with vehicles in the steps after they had been handed back.
struct HandBackResult {
  std::uint64_t count = 0;
  Quantiles position;      ///< off where speed and heading led [m]
  Quantiles heading;       ///< change in a step [rad]
  Quantiles speed;         ///< likewise [m/s]
  Quantiles acceleration;  ///< [m/s^2]
};

/// What a run cost.
struct RunTiming {
  double wall_s = 0, cpu_s = 0;  ///< cpu_s: this process and its SUMO [s]
  double real_time_factor = 0;   ///< simulated time / wall_s
  double observe = 0, context = 0, model = 0, track = 0, advance_sumo = 0,
         record = 0;  ///< shares of wall_s
  double model_cpu_us_per_agent_step = 0;
};

/// How predictions made during a run compare with what then happened (--predict).
struct PredictionResult {
  bool asked = false;
  LiveScore all;
  std::map<std::string, LiveScore> by_type;
};

/// What a run was asked for, and who said so: "command line", "scenario.toml", "configuration" (the
/// .sumocfg), "default", "loaded state" or "SUMO" (that the user started).
struct RunClock {
  double begin = 0, end = 0;  ///< of SUMO's clock [s]
  double step = 0.05;         ///< [s]
  std::uint64_t seed = 1;
  std::string begin_from, end_from, step_from, seed_from;
};

/// Everything in results.json: docs/results.md defines each key.
struct RunResults {
  std::string sumo_version, sumo_gamma_version, scenario;
  RunClock clock;
  std::vector<NotFollowed> not_followed;  ///< what the scenario asks for and the run doesn't do
  double duration = 0;                    ///< simulated [s]
  std::string backend, control = "all";
  unsigned threads = 1;
  std::string preset = "compliant";
  AgentTypeTable types;        ///< as they were driven
  std::string ended = "done";  ///< "done", "interrupted" or why SUMO failed
  AgentCounts agents;
  RunTiming timing;
  CollisionResult collisions;
  SafetyResult safety;
  FlowResult flow;
  TrafficResult traffic;
  RuleResult rules;
  SmoothnessResult smoothness;
  CouplingResult coupling;
  HandBackResult hand_back;
  PredictionResult prediction;
  std::uint64_t teleports = 0, emergency_stops = 0, sumo_warnings = 0;
  std::uint64_t state_hash = 0;
};

/// results.json as text: every key always present, numbers in SI units, the hash as 16 hexadecimal
/// digits.
std::string results_json(const RunResults& results);

/// Writes results_json as a whole or not at all. Throws Error naming the file.
void write_results(const std::filesystem::path& file, const RunResults& results);

/// The table for people that a run ends with.
void print_results_table(std::FILE* stream, const RunResults& results);

/// stuck.csv: one line a standstill of a minute or more; held.csv: one line a stay of 100 s or more
/// within 4 m. `name_of` gives SUMO's id of an agent.
template <typename NameOf>
std::string stuck_csv(const std::vector<StuckAgent>& stuck, const AgentTypeTable& types,
                      const RoadNetwork& network, NameOf&& name_of);

/// trips.csv: one line an agent that arrived.
template <typename NameOf>
std::string trips_csv(const std::vector<FinishedTrip>& trips, const AgentTypeTable& types,
                      NameOf&& name_of) {
  std::string text = "agent,type,departed_s,arrived_s,travel_time_s\n";
  for (const FinishedTrip& trip : trips)
    text += fmt::format("{},{},{:.2f},{:.2f},{:.2f}\n", name_of(trip.id),
                        type_of(types, trip.type).name, trip.departed, trip.arrived,
                        trip.arrived - trip.departed);
  return text;
}

/// conflicts.csv: one line an encounter. A measure that it never had is an empty field.
template <typename NameOf>
std::string conflicts_csv(const std::vector<Conflict>& conflicts, const AgentTypeTable& types,
                          NameOf&& name_of) {
  std::string text =
      "time_s,x,y,agent,type,other,other_type,kind,since_s,until_s,ttc_s,pet_s,drac,mdrac,gap_m,"
      "relative_speed,beyond_sumo,beyond_fhwa,near_miss,touched\n";
  const auto number = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.3f}", value) : std::string();
  };
  for (const Conflict& one : conflicts)
    text += fmt::format(
        "{:.2f},{:.2f},{:.2f},{},{},{},{},{},{:.2f},{:.2f},{},{},{},{},{},{:.3f},"
        "{:d},{:d},{:d},{:d}\n",
        one.time, one.place.x(), one.place.y(), name_of(one.a), type_of(types, one.type_a).name,
        name_of(one.b), type_of(types, one.type_b).name, sumogamma::name_of(one.kind), one.since,
        one.until, number(one.time_to_collision), number(one.post_encroachment),
        number(one.deceleration), number(one.modified_deceleration), number(one.gap),
        one.relative_speed, one.is_beyond(kSumoThresholds), one.is_beyond(kFhwaThresholds),
        one.is_near_miss(), one.touched);
  return text;
}

/// collisions.csv: one line a pair of agents that overlapped.
template <typename NameOf>
std::string collisions_csv(const std::vector<CollisionPair>& pairs, const AgentTypeTable& types,
                           NameOf&& name_of) {
  std::string text = "agent,type,other,other_type,x,y,since_s,duration_s,depth_m\n";
  for (const CollisionPair& pair : pairs)
    text += fmt::format("{},{},{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f}\n", name_of(pair.a),
                        type_of(types, pair.type_a).name, name_of(pair.b),
                        type_of(types, pair.type_b).name, pair.position.x(), pair.position.y(),
                        pair.since, pair.duration, pair.depth);
  return text;
}

/// offences.csv: one line an offence against a traffic rule.
template <typename NameOf>
std::string offences_csv(const std::vector<OffenceSpan>& offences, const AgentTypeTable& types,
                         NameOf&& name_of) {
  static constexpr const char* kNames[] = {"red_light", "wrong_way", "off_road", "sidewalk"};
  std::string text = "agent,type,offence,x,y,since_s,duration_s\n";
  for (const OffenceSpan& offence : offences)
    text += fmt::format("{},{},{},{:.2f},{:.2f},{:.2f},{:.2f}\n", name_of(offence.id),
                        type_of(types, offence.type).name,
                        kNames[static_cast<std::size_t>(offence.kind)], offence.position.x(),
                        offence.position.y(), offence.since, offence.duration);
  return text;
}

/// Word for a reason: "signal", "leader", ...; "none" for None.
const char* name_of_reason(LimitReason reason);

template <typename NameOf>
std::string stuck_csv(const std::vector<StuckAgent>& stuck, const AgentTypeTable& types,
                      const RoadNetwork& network, NameOf&& name_of) {
  std::string text =
      "agent,type,lane,x,y,since_s,standing_s,moved_on,reason,foe,head,head_reason\n";
  for (const StuckAgent& agent : stuck) {
    const auto named = [&](std::int64_t id) {
      return id < 0 ? "" : std::string(name_of(AgentId{static_cast<std::uint32_t>(id)}));
    };
    const std::string why = agent.ring        ? "ring"
                            : agent.head >= 0 ? name_of_reason(agent.head_reason)
                                              : "";
    text +=
        fmt::format("{},{},{},{:.2f},{:.2f},{:.2f},{:.2f},{},{},{},{},{}\n", name_of(agent.id),
                    type_of(types, agent.type).name,
                    agent.lane == kNoLane ? "" : network.lane(agent.lane).name, agent.position.x(),
                    agent.position.y(), agent.since, agent.standing, agent.moved_on ? "yes" : "no",
                    name_of_reason(agent.reason), named(agent.foe), named(agent.head), why);
  }
  return text;
}

}  // namespace sumogamma
