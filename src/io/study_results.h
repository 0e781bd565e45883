#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "study/statistics.h"
#include "study/study_plan.h"

namespace sumogamma {

enum class RunStatus : unsigned char { Missing, Failed, Done };

/// What one run of a study left.
struct StudyRunResult {
  StudyRun run;
  RunStatus status = RunStatus::Missing;
  std::string failure;                    ///< in a line, where it failed
  std::string state_hash;                 ///< where it is done, as the rest
  std::map<std::string, double> numbers;  ///< by key of results.json
};

/// One line of a study's summary: a measure of a variant on a scenario.
struct SummaryRow {
  std::string scenario;  ///< "all": the mean of the scenarios, each with the same weight
  std::string variant, measure;
  Estimate value;
  Estimate difference;  ///< to the baseline, over pairs of the same scenario and seed; count 0 for
                        ///< the baseline itself
};

inline constexpr const char* kAllScenarios = "all";

/// A run is done where its results.json says that it ended by itself, and failed where the note of
/// a failure lies in its folder. Throws Error naming a file that can't be read.
StudyRunResult read_study_run(const std::filesystem::path& output, const Study& study,
                              const StudyRun& run);

/// All of them, in order of scenario, variant and seed.
std::vector<StudyRunResult> read_study_runs(const std::filesystem::path& output, const Study& study,
                                            std::vector<StudyRun> runs);

/// Leaves the note that a run failed, or takes it away where `failure` is empty.
void note_failure(const std::filesystem::path& run_folder, const std::string& failure);

/// Means and paired differences of every figure, by scenario and over all of them.
std::vector<SummaryRow> summarize(const Study& study, std::span<const StudyRunResult> runs);

/// Values of one measure by scenario, in order of seeds; differences to the baseline where
/// `difference`.
std::vector<std::vector<double>> values_by_scenario(const Study& study,
                                                    std::span<const StudyRunResult> runs,
                                                    std::size_t variant, const std::string& measure,
                                                    bool difference);

/// The widest interval of the measure among the variants, over all scenarios: of the differences to
/// the baseline where there are several variants, else of the mean. Infinite as long as there is
/// none. `relative`: as a share of the baseline's mean.
double widest_interval(const Study& study, std::span<const StudyRunResult> runs,
                       const StudyUntil& until);

/// A line a run: scenario, variant, seed, status, state_hash, then every figure but those about the
/// machine (timing_csv has these). Same bytes for the same results.
std::string runs_csv(const Study& study, std::span<const StudyRunResult> runs);
std::string timing_csv(const Study& study, std::span<const StudyRunResult> runs);
std::string summary_csv(std::span<const SummaryRow> rows);
/// The study's measures over all scenarios as a table for people, Markdown.
std::string summary_markdown(const Study& study, std::span<const SummaryRow> rows);

/// study.sqlite: the tables scenarios, variants, settings, runs, figures and summary. Replaced as a
/// whole, the same bytes for the same results. Throws Error naming the file.
void write_study_database(const std::filesystem::path& file, const Study& study,
                          std::span<const StudyRunResult> runs, std::span<const SummaryRow> rows);

}  // namespace sumogamma
