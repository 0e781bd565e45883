#include "io/results.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/print.h"
#include "io/output_file.h"
#include "study/metrics_version.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

Json agents_json(const AgentCounts& agents) {
  Json by_type = Json::object();
  for (const auto& [type, counts] : agents.by_type)
    by_type[type] = {{"inserted", counts.inserted},
                     {"arrived", counts.arrived},
                     {"mean_travel_time_s", counts.mean_travel_time}};
  const auto by_reason = [](const std::map<std::string, std::uint64_t>& counts) {
    Json json = Json::object();
    for (const auto& [reason, count] : counts) json[reason] = count;
    return json;
  };
  return {{"inserted", agents.inserted},
          {"arrived", agents.arrived},
          {"mean_travel_time_s", agents.mean_travel_time},
          {"controlled_now", agents.controlled_now},
          {"controlled_peak", agents.controlled_peak},
          {"controlled_mean", agents.controlled_mean},
          {"detours", agents.detours},
          {"stops_served", agents.stops_served},
          {"rides", agents.rides},
          {"taken_over", agents.taken_over},
          {"handed_back", agents.handed_back},
          {"kept_on_foot", agents.kept_on_foot},
          {"insertions_delayed", agents.insertions_delayed},
          {"left_to_sumo", by_reason(agents.left_to_sumo)},
          {"removed", by_reason(agents.removed)},
          {"by_type", by_type}};
}

Json quantiles_json(const Quantiles& spread) {
  return {{"median", spread.median}, {"p95", spread.p95}, {"max", spread.max}};
}

Json hand_back_json(const HandBackResult& back) {
  return {{"count", back.count},
          {"position_m", quantiles_json(back.position)},
          {"heading_rad", quantiles_json(back.heading)},
          {"speed", quantiles_json(back.speed)},
          {"acceleration", quantiles_json(back.acceleration)}};
}

Json timing_json(const RunTiming& timing) {
  return {{"wall_s", timing.wall_s},
          {"real_time_factor", timing.real_time_factor},
          {"cpu_s", timing.cpu_s},
          {"share",
           {{"observe", timing.observe},
            {"context", timing.context},
            {"model", timing.model},
            {"track", timing.track},
            {"advance_sumo", timing.advance_sumo},
            {"record", timing.record}}},
          {"model_cpu_us_per_agent_step", timing.model_cpu_us_per_agent_step}};
}

Json collisions_json(const CollisionResult& collisions) {
  Json by_types = Json::object();
  for (const auto& [pair, count] : collisions.by_types) by_types[pair] = count;
  return {{"unique_pairs", collisions.unique_pairs},
          {"unique_pairs_per_agent_hour", collisions.unique_pairs_per_agent_hour},
          {"overlap_share_of_agent_steps", collisions.overlap_share_of_agent_steps},
          {"deep_pairs", collisions.deep_pairs},
          {"by_types", by_types},
          {"worst_penetration_m", collisions.worst_penetration_m},
          {"agent_hours", collisions.agent_hours}};
}

Json safety_json(const SafetyResult& safety) {
  const auto counts = [](const std::map<std::string, std::uint64_t>& by_name) {
    Json json = Json::object();
    for (const auto& [name, count] : by_name) json[name] = count;
    return json;
  };
  return {{"conflicts_sumo", safety.conflicts_sumo},
          {"conflicts_fhwa", safety.conflicts_fhwa},
          {"conflicts_fhwa_per_100_km", safety.conflicts_fhwa_per_100_km},
          {"near_misses", safety.near_misses},
          {"ttc_below_1_5", safety.ttc_below_1_5},
          {"pet_below_2", safety.pet_below_2},
          {"drac_above_3", safety.drac_above_3},
          {"mdrac_above_3", safety.mdrac_above_3},
          {"time_exposed_s", safety.time_exposed_s},
          {"least_gap_m", safety.least_gap_m},
          {"by_kind", counts(safety.by_kind)},
          {"by_types", counts(safety.by_types)}};
}

Json flow_json(const FlowResult& flow) {
  Json by_type = Json::object();
  for (const auto& [type, speed] : flow.mean_speed_by_type) by_type[type] = speed;
  return {{"mean_speed", flow.mean_speed},
          {"mean_speed_by_type", by_type},
          {"distance_km", flow.distance_km},
          {"stuck_agents", flow.stuck_agents},
          {"longest_standstill_s", flow.longest_standstill_s},
          {"held_agents", flow.held_agents},
          {"longest_held_s", flow.longest_held_s},
          {"waiting_time_mean_s", flow.waiting_time_mean_s}};
}

Json traffic_json(const TrafficResult& traffic) {
  const auto shares = [](const std::map<std::string, double>& by_type) {
    Json json = Json::object();
    for (const auto& [type, share] : by_type) json[type] = share;
    return json;
  };
  return {{"interval_s", traffic.interval},
          {"delay_mean_s", traffic.delay_mean},
          {"delay_s_per_km", traffic.delay_per_km},
          {"mode_share", shares(traffic.mode_share)},
          {"distance_share", shares(traffic.distance_share)}};
}

Json rule_counts_json(const RuleCounts& counts) {
  return {{"red_light_crossings", counts.red_light_crossings},
          {"signal_crossings", counts.signal_crossings},
          {"red_lights_met", counts.red_lights_met},
          {"mid_block_crossings", counts.mid_block_crossings},
          {"wrong_way_s", counts.wrong_way_s},
          {"overtaking_s", counts.overtaking_s},
          {"off_road_s", counts.off_road_s},
          {"sidewalk_by_vehicle_s", counts.sidewalk_by_vehicle_s}};
}

Json rules_json(const RuleResult& rules) {
  Json json = rule_counts_json(rules.all);
  Json by_types = Json::object();
  for (const auto& [type, counts] : rules.by_type) by_types[type] = rule_counts_json(counts);
  json["by_types"] = by_types;
  return json;
}

/// How each type that came behaved: the preset with what was said of types beyond it.
Json behavior_json(const RunResults& results) {
  Json by_type = Json::object();
  for (const AgentType& type : results.types) {
    if (!results.agents.by_type.contains(type.name)) continue;
    const Compliance& own = type.compliance;
    by_type[type.name] = {{"red_light_running", own.red_light_running},
                          {"yielding_rate", own.yielding_rate},
                          {"jaywalking_rate", own.jaywalking_rate},
                          {"rolling_stops", own.rolling_stops},
                          {"creeping", own.creeping},
                          {"critical_gap", type.critical_gap},
                          {"headway", type.headway},
                          {"headway_deviation", own.headway_deviation},
                          {"place_deviation", own.place_deviation},
                          {"speed_factor", own.speed_factor},
                          {"speed_factor_deviation", own.speed_factor_deviation},
                          {"responsibility_least", own.responsibility_least},
                          {"responsibility_most", own.responsibility_most},
                          {"attention_least", own.attention_least},
                          {"attention_most", own.attention_most}};
  }
  return {{"preset", results.preset}, {"by_type", by_type}};
}

Json smoothness_values_json(const SmoothnessValues& values) {
  return {{"accel_p95", values.accel_p95},
          {"jerk_p95", values.jerk_p95},
          {"yaw_rate_p95", values.yaw_rate_p95},
          {"lateral_slip_p95", values.lateral_slip_p95},
          {"reversals", values.reversals}};
}

Json smoothness_json(const SmoothnessResult& smoothness) {
  Json json = smoothness_values_json(smoothness.wheeled);
  Json by_type = Json::object();
  for (const auto& [type, values] : smoothness.by_type)
    by_type[type] = smoothness_values_json(values);
  json["by_type"] = by_type;
  return json;
}

Json score_json(const LiveScore& score) {
  return {{"predictions", score.predictions},
          {"left", score.left},
          {"ade_m", score.average},
          {"fde_m", score.final},
          {"constant_velocity_ade_m", score.constant_velocity_average},
          {"constant_velocity_fde_m", score.constant_velocity_final}};
}

Json prediction_json(const PredictionResult& prediction) {
  Json json = {{"asked", prediction.asked}};
  json.update(score_json(prediction.all));
  Json by_type = Json::object();
  for (const auto& [type, score] : prediction.by_type) by_type[type] = score_json(score);
  json["by_type"] = by_type;
  return json;
}

Json not_followed_json(const std::vector<NotFollowed>& items) {
  Json list = Json::array();
  for (const NotFollowed& item : items)
    list.push_back({{"what", item.what},
                    {"first", item.first},
                    {"file", item.file},
                    {"count", item.count},
                    {"why", item.why}});
  return list;
}

Json clock_json(const RunClock& clock) {
  return {{"begin", clock.begin},
          {"end", clock.end},
          {"step", clock.step},
          {"seed", clock.seed},
          {"from",
           {{"begin", clock.begin_from},
            {"end", clock.end_from},
            {"step", clock.step_from},
            {"seed", clock.seed_from}}}};
}

/// A heading or "name  value" line of the table.
class Table {
 public:
  explicit Table(std::FILE* stream) : stream_(stream) {}
  void heading(const char* text) { print(stream_, "{}\n", text); }
  void text(const char* name, const std::string& value) {
    print(stream_, "  {:<30} {}\n", name, value);
  }
  void count(const char* name, std::uint64_t value) {
    print(stream_, "  {:<30} {}\n", name, value);
  }
  void number(const char* name, double value, const char* unit, int decimals = 2) {
    print(stream_, "  {:<30} {:.{}f}{}{}\n", name, value, decimals, *unit ? " " : "", unit);
  }

 private:
  std::FILE* stream_;
};

}  // namespace

const char* name_of_reason(LimitReason reason) {
  switch (reason) {
    case LimitReason::None:
      return "none";
    case LimitReason::Signal:
      return "signal";
    case LimitReason::Yield:
      return "yield";
    case LimitReason::Crossing:
      return "crossing";
    case LimitReason::BlockedJunction:
      return "blocked junction";
    case LimitReason::Leader:
      return "leader";
    case LimitReason::Stop:
      return "stop";
    case LimitReason::Merge:
      return "lane change";
    case LimitReason::GivesWay:
      return "backed out";
    case LimitReason::TurningRoom:
      return "turning room";
    case LimitReason::LetsIn:
      return "lets in";
  }
  return "none";
}

std::string results_json(const RunResults& results) {
  const CouplingResult& coupling = results.coupling;
  const Json json = {{"sumo_version", results.sumo_version},
                     {"sumo_gamma_version", results.sumo_gamma_version},
                     {"metrics_version", kMetricsVersion},
                     {"scenario", results.scenario},
                     {"seed", results.clock.seed},
                     {"step", results.clock.step},
                     {"duration", results.duration},
                     {"clock", clock_json(results.clock)},
                     {"backend", results.backend},
                     {"threads", results.threads},
                     {"control", results.control},
                     {"not_followed", not_followed_json(results.not_followed)},
                     {"ended", results.ended},
                     {"behavior", behavior_json(results)},
                     {"agents", agents_json(results.agents)},
                     {"timing", timing_json(results.timing)},
                     {"collisions", collisions_json(results.collisions)},
                     {"safety", safety_json(results.safety)},
                     {"flow", flow_json(results.flow)},
                     {"traffic", traffic_json(results.traffic)},
                     {"rules", rules_json(results.rules)},
                     {"smoothness", smoothness_json(results.smoothness)},
                     {"prediction", prediction_json(results.prediction)},
                     {"coupling",
                      {{"position_error_max_m", coupling.position_error_max_m},
                       {"position_error_p99_m", coupling.position_error_p99_m},
                       {"lane_mismatches", coupling.lane_mismatches},
                       {"teleports", results.teleports},
                       {"emergency_stops", results.emergency_stops},
                       {"sumo_warnings", results.sumo_warnings},
                       {"poses_compared", coupling.compared},
                       {"hand_back", hand_back_json(results.hand_back)}}},
                     {"state_hash", hash_text(results.state_hash)}};
  return json.dump(2) + "\n";
}

void write_results(const std::filesystem::path& file, const RunResults& results) {
  write_file(file, results_json(results));
}

namespace {
void print_flow(Table& table, const RunResults& results) {
  table.heading("flow");
  table.number("mean speed", results.flow.mean_speed, "m/s");
  table.number("distance", results.flow.distance_km, "km");
  table.count("stuck agents", results.flow.stuck_agents);
  table.number("longest standstill", results.flow.longest_standstill_s, "s", 1);
  table.count("held within 4 m for 100 s", results.flow.held_agents);
  table.number("mean waiting time", results.flow.waiting_time_mean_s, "s", 1);
  table.number("mean delay", results.traffic.delay_mean, "s", 1);
}

void print_prediction(Table& table, const PredictionResult& prediction) {
  auto errors = [](double average, double final) {
    return fmt::format("{:.2f} / {:.2f} m", average, final);
  };
  table.heading("prediction (4.8 s ahead: mean / final error)");
  table.count("predictions scored", static_cast<std::uint64_t>(prediction.all.predictions));
  table.text("sumo-gamma", errors(prediction.all.average, prediction.all.final));
  for (const auto& [type, score] : prediction.by_type)
    if (score.predictions > 0)
      table.text(("  " + type).c_str(),
                 errors(score.average, score.final) + ", constant velocity " +
                     errors(score.constant_velocity_average, score.constant_velocity_final));
  table.text("constant velocity", errors(prediction.all.constant_velocity_average,
                                         prediction.all.constant_velocity_final));
}
}  // namespace

void print_results_table(std::FILE* stream, const RunResults& results) {
  Table table(stream);
  const AgentCounts& agents = results.agents;
  std::string scenario = results.scenario + ", seed " + std::to_string(results.clock.seed);
  table.heading("run");
  table.text("scenario", scenario);
  table.number("simulated", results.duration, "s");
  table.text("behavior", results.preset);
  table.text("ended", results.ended);
  table.number("real-time factor", results.timing.real_time_factor, "", 1);
  table.number("model CPU per agent step", results.timing.model_cpu_us_per_agent_step, "us", 1);
  table.heading("agents");
  table.text("inserted / arrived",
             std::to_string(agents.inserted) + " / " + std::to_string(agents.arrived));
  for (const auto& [type, counts] : agents.by_type)
    table.text(("  " + type).c_str(),
               std::to_string(counts.inserted) + " / " + std::to_string(counts.arrived));
  table.number("mean travel time", agents.mean_travel_time, "s", 1);
  table.number("driven by GAMMA, mean", agents.controlled_mean, "", 1);
  table.count("driven by GAMMA, most", agents.controlled_peak);
  std::uint64_t removed = 0;
  for (const auto& [reason, count] : agents.removed) removed += count;
  table.count("removed before destination", removed);
  table.count("detours", results.agents.detours);
  table.heading("collisions");
  table.count("pairs", results.collisions.unique_pairs);
  table.count("pairs deeper than 0.1 m", results.collisions.deep_pairs);
  for (const auto& [pair, count] : results.collisions.by_types)
    table.count(("  " + pair).c_str(), count);
  table.number("pairs per agent hour", results.collisions.unique_pairs_per_agent_hour, "", 3);
  table.number("worst penetration", results.collisions.worst_penetration_m, "m");
  table.heading("safety");
  table.count("conflicts, TTC < 1.5 s", results.safety.conflicts_fhwa);
  table.count("near misses, TTC < 1 s", results.safety.near_misses);
  print_flow(table, results);
  table.heading("rules");
  table.text("red lights run", std::to_string(results.rules.all.red_light_crossings) + " of " +
                                   std::to_string(results.rules.all.signal_crossings) +
                                   " signalled crossings");
  table.number("wrong way", results.rules.all.wrong_way_s, "s");
  table.number("overtaking over the middle", results.rules.all.overtaking_s, "s");
  table.number("off the road", results.rules.all.off_road_s, "s");
  table.number("vehicles on sidewalks", results.rules.all.sidewalk_by_vehicle_s, "s");
  table.heading("smoothness (vehicles, 95th percentile)");
  table.number("acceleration", results.smoothness.wheeled.accel_p95, "m/s2");
  table.number("jerk", results.smoothness.wheeled.jerk_p95, "m/s3");
  table.number("yaw rate", results.smoothness.wheeled.yaw_rate_p95, "rad/s", 3);
  table.number("sideways slip", results.smoothness.wheeled.lateral_slip_p95, "m/s", 3);
  table.count("reversals", results.smoothness.wheeled.reversals);
  table.heading("coupling");
  table.number("position error, 99th percentile", results.coupling.position_error_p99_m, "m", 4);
  table.count("teleports", results.teleports);
  table.count("emergency stops", results.emergency_stops);
  if (results.prediction.asked) print_prediction(table, results.prediction);
  table.text("state hash", hash_text(results.state_hash));
}

}  // namespace sumogamma
