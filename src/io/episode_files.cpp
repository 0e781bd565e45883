#include "io/episode_files.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/error.h"
#include "base/hash.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {

using Json = nlohmann::ordered_json;

/// Nothing where it isn't finite.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json action_kind(const EgoAction& action) {
  return !action.trajectory.empty() ? "trajectory" : action.steering ? "steering" : "acceleration";
}

/// Empty where nothing was searched.
void add_search(const std::optional<SearchStatistics>& search, Json& row) {
  const auto add = [&](const char* name, auto value) {
    row[name] = search ? Json(search.value().*value) : Json();
  };
  add("nodes", &SearchStatistics::nodes);
  add("expansions", &SearchStatistics::expansions);
  add("scene_steps", &SearchStatistics::steps);
  add("deepest", &SearchStatistics::deepest);
  add("lower", &SearchStatistics::lower);
  add("upper", &SearchStatistics::upper);
  add("closed", &SearchStatistics::closed);
  add("by_default", &SearchStatistics::by_default);
  add("cut", &SearchStatistics::stopped);
}

Json plan_row(std::uint64_t seed, const PlanRow& plan) {
  Json row = {{"seed", seed},
              {"plan", plan.plan},
              {"time", plan.time},
              {"x", plan.position.x()},
              {"y", plan.position.y()},
              {"heading", plan.heading},
              {"speed", plan.speed},
              {"progress", plan.progress},
              {"action", action_kind(plan.action)},
              {"acceleration", plan.action.acceleration},
              {"steering", plan.action.steering ? Json(*plan.action.steering) : Json()},
              {"emergency_ticks", plan.emergency_ticks}};
  add_search(plan.action.search, row);
  return row;
}

template <class Which>
auto count_plans(const EpisodeResult& result, Which which) {
  return std::count_if(result.plans.begin(), result.plans.end(), which);
}

void add_contact(const EpisodeResult& result, Json& row) {
  const auto& contact = result.contact;
  row["contact"] = contact ? 1 : 0;
  row["contact_moving"] = contact && contact->moving ? 1 : 0;
  row["contact_at_fault"] = contact && is_at_fault(*contact) ? 1 : 0;
  row["contact_with"] = result.contact_type;
}

void add_metrics(const EgoMetrics& metrics, Json& row) {
  row["driven_m"] = metrics.driven;
  row["progress_m"] = metrics.progress;
  row["mean_speed"] = metrics.mean_speed;
  row["least_gap_m"] = number(metrics.least_gap);
  row["near_miss"] = metrics.least_gap < 1.0 ? 1 : 0;
  row["speed_change_per_m"] = metrics.speed_change;
  row["mean_acceleration"] = metrics.acceleration;
  row["mean_jerk"] = metrics.jerk;
  row["braking_share"] = metrics.braking_share;
  row["braking_of_others_s"] = metrics.braking_of_others;
  row["delay_of_others_s"] = metrics.delay_of_others;
}

void add_score(const ClosedLoopScore& score, Json& row) {
  row["score"] = score.total();
  row["score_without_comfort"] = score.without_comfort();
  row["no_fault"] = score.no_fault;
  row["drivable_area"] = score.drivable_area;
  row["driving_direction"] = score.driving_direction;
  row["making_progress"] = score.making_progress;
  row["time_to_collision"] = score.time_to_collision;
  row["progress_ratio"] = score.progress;
  row["speed_limit"] = score.speed_limit;
  row["comfort"] = score.comfort;
}

Json timing_row(const EpisodeResult& result) {
  std::vector<double> times = result.planning_times;
  std::sort(times.begin(), times.end());
  const auto at = [&](double share) {
    return times.empty() ? Json()
                         : Json(1e3 * times[static_cast<std::size_t>(
                                          share * static_cast<double>(times.size() - 1))]);
  };
  return {{"seed", result.seed},    {"wall_s", result.wall},   {"plans", times.size()},
          {"plan_ms_p50", at(0.5)}, {"plan_ms_p95", at(0.95)}, {"plan_ms_most", at(1.0)}};
}

/// A cell as it stands in a table: names of types and outcomes have no commas.
std::string cell(const Json& value) {
  if (value.is_null()) return "";
  std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  std::replace_if(
      text.begin(), text.end(), [](char letter) { return letter == ',' || letter == '\n'; }, ' ');
  return text;
}

std::string table_of(const std::vector<const Json*>& rows) {
  std::string text;
  if (rows.empty()) return text;
  for (const auto& [key, value] : rows.front()->items()) text += (text.empty() ? "" : ",") + key;
  text += "\n";
  for (const Json* row : rows) {
    bool first = true;
    for (const auto& [key, value] : row->items()) {
      if (!first) text += ",";
      first = false;
      text += cell(value);
    }
    text += "\n";
  }
  return text;
}

Json share_of(std::size_t count, std::size_t n) {
  const ShareInterval interval = wilson_interval(count, n);
  return {{"count", count},
          {"of", n},
          {"share", n > 0 ? Json(static_cast<double>(count) / static_cast<double>(n)) : Json()},
          {"low", interval.low},
          {"high", interval.high}};
}

Json summary_of(const std::vector<Json>& episodes) {
  std::size_t counted = 0;
  std::map<std::string, std::size_t> outcomes;
  std::map<std::string, double> sums;
  static constexpr const char* kShares[] = {"contact", "contact_moving", "contact_at_fault",
                                            "near_miss"};
  static constexpr const char* kMeans[] = {
      "restricted_time_s",     "progress_m",    "mean_speed",          "speed_change_per_m",
      "mean_acceleration",     "braking_share", "braking_of_others_s", "delay_of_others_s",
      "score_without_comfort", "score"};
  for (const Json& episode : episodes) {
    const Json& row = episode["episode"];
    ++outcomes[row["outcome"].get<std::string>()];
    if (row["gridlock"] != 0 || row["outcome"] == outcome::kClientFailed) continue;
    ++counted;
    for (const char* key : kShares) sums[key] += row[key].get<double>();
    for (const char* key : kMeans) sums[key] += row[key].get<double>();
  }
  Json summary{{"episodes", episodes.size()}, {"counted", counted}, {"outcomes", outcomes}};
  for (const char* key : kShares)
    summary["shares"][key] = share_of(static_cast<std::size_t>(std::lround(sums[key])), counted);
  for (const char* key : kMeans)
    summary["means"][key] = counted > 0 ? Json(sums[key] / static_cast<double>(counted)) : Json();
  return summary;
}

}  // namespace

Json to_json(const EpisodeResult& result) {
  Json row{{"seed", result.seed},
           {"outcome", result.outcome},
           {"time_s", result.metrics.time},
           {"restricted_time_s", result.restricted_time},
           {"start_x", result.start.x()},
           {"start_y", result.start.y()},
           {"start_heading", result.start_heading},
           {"way_m", result.way},
           {"others", result.others},
           {"world_hash", hash_text(result.world_hash)},
           {"state_hash", hash_text(result.state_hash)}};
  add_contact(result, row);
  add_metrics(result.metrics, row);
  add_score(result.score, row);
  row["plans"] = result.plans.size();
  row["late"] = result.late;
  row["emergency_brakes"] =
      count_plans(result, [](const PlanRow& plan) { return plan.emergency_ticks > 0; });
  row["detours"] = result.detours;
  row["detours_missed"] = result.detours_missed;
  row["cut"] = count_plans(result, [](const PlanRow& plan) {
    return plan.action.search && plan.action.search->stopped;
  });
  row["gridlock"] = result.gridlock ? 1 : 0;
  row["failure"] = result.failure;
  Json plans = Json::array();
  for (const PlanRow& plan : result.plans) plans.push_back(plan_row(result.seed, plan));
  return {{"episode", std::move(row)}, {"plans", std::move(plans)}, {"timing", timing_row(result)}};
}

std::filesystem::path episode_file(const std::filesystem::path& drive, std::uint64_t seed) {
  return drive / "episodes" / (std::to_string(seed) + ".json");
}

void write_episode(const std::filesystem::path& drive, const EpisodeResult& result) {
  write_file(episode_file(drive, result.seed), to_json(result).dump() + "\n");
}

Json read_episode(const std::filesystem::path& drive, std::uint64_t seed) {
  const std::filesystem::path file = episode_file(drive, seed);
  if (!std::filesystem::exists(file)) return {};
  Json episode = Json::parse(read_file(file), nullptr, false);
  if (!episode.is_object() || !episode.contains("episode") || !episode.contains("plans") ||
      !episode.contains("timing"))
    throw Error(file.string(), "is no episode of a drive, delete it to have it driven again");
  return episode;
}

void write_drive(const std::filesystem::path& drive, const Json& settings,
                 const std::vector<Json>& episodes) {
  std::vector<const Json*> rows, plans, timing;
  for (const Json& episode : episodes) {
    rows.push_back(&episode["episode"]);
    timing.push_back(&episode["timing"]);
    for (const Json& plan : episode["plans"]) plans.push_back(&plan);
  }
  write_file(drive / "episodes.csv", table_of(rows));
  write_file(drive / "plans.csv", table_of(plans));
  write_file(drive / "timing.csv", table_of(timing));
  Json whole{{"settings", settings}, {"summary", summary_of(episodes)}};
  write_file(drive / "drive.json", whole.dump(2) + "\n");
}

}  // namespace sumogamma
