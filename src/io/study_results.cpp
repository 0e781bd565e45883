#include "io/study_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <tuple>

#include "base/csv_text.h"
#include "base/error.h"
#include "io/output_file.h"
#include "study/measures.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFailureNote = "failed.txt";

void flatten_numbers(const Json& json, const std::string& prefix,
                     std::map<std::string, double>& numbers) {
  for (const auto& [key, value] : json.items()) {
    const std::string full = prefix.empty() ? key : prefix + "." + key;
    if (value.is_object())
      flatten_numbers(value, full, numbers);
    else if (value.is_number())
      numbers[full] = value.get<double>();
  }
}

/// The shortest text that is read back as the same number.
std::string exact_text(double value) { return fmt::format("{}", value); }

std::string optional_text(double value) { return std::isfinite(value) ? exact_text(value) : ""; }

std::optional<double> figure_of(const StudyRunResult& result, const std::string& measure) {
  if (result.status != RunStatus::Done) return std::nullopt;
  const auto found = result.numbers.find(measure);
  if (found != result.numbers.end()) return found->second;
  if (is_zero_where_absent(measure)) return 0.0;
  return std::nullopt;
}

std::set<std::string> all_figures(std::span<const StudyRunResult> runs) {
  std::set<std::string> keys;
  for (const StudyRunResult& run : runs)
    for (const auto& [key, value] : run.numbers) keys.insert(key);
  return keys;
}

const char* word_of(RunStatus status) {
  return status == RunStatus::Done ? "done" : status == RunStatus::Failed ? "failed" : "missing";
}

std::string table_of_runs(const Study& study, std::span<const StudyRunResult> runs,
                          bool about_machine) {
  std::vector<std::string> keys;
  for (const std::string& key : all_figures(runs))
    if (is_about_machine(key) == about_machine && key != "seed") keys.push_back(key);
  std::string text = "scenario,variant,seed,status,state_hash";
  for (const std::string& key : keys) text += "," + csv_field(key);
  text += "\n";
  for (const StudyRunResult& result : runs) {
    text += csv_field(study.scenarios[result.run.scenario].name) + "," +
            csv_field(study.variants[result.run.variant].name) + "," +
            std::to_string(result.run.seed) + "," + word_of(result.status) + "," +
            result.state_hash;
    for (const std::string& key : keys) {
      const std::optional<double> figure = figure_of(result, key);
      text += figure ? "," + exact_text(*figure) : ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

StudyRunResult read_study_run(const fs::path& output, const Study& study, const StudyRun& run) {
  StudyRunResult result;
  result.run = run;
  const fs::path folder = output / folder_of(study, run);
  const fs::path file = folder / "results.json";
  if (fs::exists(file)) {
    const Json json = Json::parse(read_file(file), nullptr, false);
    if (json.is_object() && json.value("ended", "") == "done") {
      result.status = RunStatus::Done;
      result.state_hash = json.value("state_hash", "");
      flatten_numbers(json, "", result.numbers);
      return result;
    }
  }
  if (fs::exists(folder / kFailureNote)) {
    result.status = RunStatus::Failed;
    result.failure = read_file(folder / kFailureNote);
    while (!result.failure.empty() && result.failure.back() == '\n') result.failure.pop_back();
  }
  return result;
}

std::vector<StudyRunResult> read_study_runs(const fs::path& output, const Study& study,
                                            std::vector<StudyRun> runs) {
  std::sort(runs.begin(), runs.end(), [](const StudyRun& a, const StudyRun& b) {
    return std::tie(a.scenario, a.variant, a.seed) < std::tie(b.scenario, b.variant, b.seed);
  });
  std::vector<StudyRunResult> results;
  for (const StudyRun& run : runs) results.push_back(read_study_run(output, study, run));
  return results;
}

void note_failure(const fs::path& run_folder, const std::string& failure) {
  if (!failure.empty()) return write_file(run_folder / kFailureNote, failure + "\n");
  std::error_code ignored;
  fs::remove(run_folder / kFailureNote, ignored);
}

std::vector<std::vector<double>> values_by_scenario(const Study& study,
                                                    std::span<const StudyRunResult> runs,
                                                    std::size_t variant, const std::string& measure,
                                                    bool difference) {
  // by scenario and seed, so that pairs find each other in any order of runs
  std::vector<std::map<std::uint64_t, double>> own(study.scenarios.size()), base = own;
  for (const StudyRunResult& result : runs) {
    const std::optional<double> figure = figure_of(result, measure);
    if (!figure) continue;
    if (result.run.variant == variant) own[result.run.scenario][result.run.seed] = *figure;
    if (result.run.variant == study.baseline) base[result.run.scenario][result.run.seed] = *figure;
  }
  std::vector<std::vector<double>> values(study.scenarios.size());
  for (std::size_t scenario = 0; scenario < values.size(); ++scenario)
    for (const auto& [seed, figure] : own[scenario]) {
      const auto pair = base[scenario].find(seed);
      if (!difference)
        values[scenario].push_back(figure);
      else if (pair != base[scenario].end())
        values[scenario].push_back(figure - pair->second);
    }
  return values;
}

std::vector<SummaryRow> summarize(const Study& study, std::span<const StudyRunResult> runs) {
  std::vector<SummaryRow> rows;
  for (const std::string& measure : all_figures(runs)) {
    if (is_setting(measure) || is_about_machine(measure)) continue;
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      const auto values = values_by_scenario(study, runs, variant, measure, false);
      const auto differences = values_by_scenario(study, runs, variant, measure, true);
      const bool is_baseline = variant == study.baseline;
      const std::string& name = study.variants[variant].name;
      SummaryRow whole{kAllScenarios, name, measure, estimate_over_strata(values), {}};
      if (!is_baseline) whole.difference = estimate_over_strata(differences);
      if (whole.value.count == 0) continue;
      rows.push_back(whole);
      if (values.size() == 1) rows.back().scenario = study.scenarios.front().name;
      for (std::size_t scenario = 0; values.size() > 1 && scenario < values.size(); ++scenario) {
        SummaryRow row{
            study.scenarios[scenario].name, name, measure, estimate_mean(values[scenario]), {}};
        if (!is_baseline) row.difference = estimate_mean(differences[scenario]);
        if (row.value.count > 0) rows.push_back(std::move(row));
      }
    }
  }
  return rows;
}

double widest_interval(const Study& study, std::span<const StudyRunResult> runs,
                       const StudyUntil& until) {
  const bool compared = study.variants.size() > 1;
  double widest = 0, scale = 1;
  if (until.relative)
    scale = std::abs(
        estimate_over_strata(values_by_scenario(study, runs, study.baseline, until.measure, false))
            .mean);
  for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
    if (compared && variant == study.baseline) continue;
    const Estimate estimate =
        estimate_over_strata(values_by_scenario(study, runs, variant, until.measure, compared));
    if (!estimate.has_interval()) return std::numeric_limits<double>::infinity();
    widest = std::max(widest, estimate.high - estimate.low);
  }
  return widest == 0.0 ? 0.0 : widest / scale;
}

std::string runs_csv(const Study& study, std::span<const StudyRunResult> runs) {
  return table_of_runs(study, runs, false);
}

std::string timing_csv(const Study& study, std::span<const StudyRunResult> runs) {
  return table_of_runs(study, runs, true);
}

std::string summary_csv(std::span<const SummaryRow> rows) {
  std::string text =
      "scenario,variant,measure,runs,mean,deviation,low_95,high_95,pairs,difference,"
      "difference_low_95,difference_high_95\n";
  for (const SummaryRow& row : rows) {
    const Estimate &value = row.value, &difference = row.difference;
    text += csv_field(row.scenario) + "," + csv_field(row.variant) + "," + csv_field(row.measure) +
            fmt::format(",{},{},{},{},{},", value.count, exact_text(value.mean),
                        value.has_interval() ? exact_text(value.deviation) : "",
                        optional_text(value.low), optional_text(value.high));
    if (difference.count > 0)
      text += fmt::format("{},{},{},{}\n", difference.count, exact_text(difference.mean),
                          optional_text(difference.low), optional_text(difference.high));
    else
      text += "0,,,\n";
  }
  return text;
}

std::string summary_markdown(const Study& study, std::span<const SummaryRow> rows) {
  const std::string over =
      study.scenarios.size() > 1 ? kAllScenarios : study.scenarios.front().name;
  std::string text = "| measure | variant | mean | difference to " +
                     study.variants[study.baseline].name +
                     ", 95 % interval |\n|---|---|---:|---|\n";
  for (const std::string& key : study.measures)
    for (const SummaryRow& row : rows) {
      if (row.measure != key || row.scenario != over) continue;
      const Measure measure = measure_of(key);
      text += fmt::format("| {}{} | {} | {:.5g} | ", measure.label,
                          measure.unit.empty() ? "" : fmt::format(" [{}]", measure.unit),
                          row.variant, row.value.mean);
      if (row.difference.has_interval() && row.difference.count > 0)
        text += fmt::format("{:+.4g} ({:+.4g} to {:+.4g})", row.difference.mean, row.difference.low,
                            row.difference.high);
      else if (row.difference.count > 0)
        text += fmt::format("{:+.4g} (one pair)", row.difference.mean);
      text += " |\n";
    }
  return text;
}

}  // namespace sumogamma
