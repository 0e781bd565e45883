#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "app/command.h"
#include "base/error.h"
#include "io/drive_report.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "io/report.h"
#include "io/study_page.h"
#include "io/study_plan_file.h"
#include "io/study_results.h"

namespace sumogamma {

namespace {

/// Episodes of drives over the seeds that all of them have.
int report_drives(std::span<const std::filesystem::path> folders, const std::string& page,
                  bool csv) {
  if (csv) throw Error("--csv", "is for runs: the tables of a drive are in its folder");
  const DriveReport report = compare_drives(folders);
  if (!page.empty()) write_file(page, drive_report_html(report));
  std::fputs(drive_report_markdown(report).c_str(), stdout);
  return kExitDone;
}

/// The results of a batch, as it left them.
void report_study(const std::filesystem::path& folder, const std::string& page, bool csv) {
  const Study study = read_study_plan(folder);
  const std::vector<StudyRunResult> runs =
      read_study_runs(folder, study, runs_of(study, study.seeds));
  const std::vector<SummaryRow> rows = summarize(study, runs);
  if (!page.empty()) write_file(page, study_html(folder, study, runs, rows));
  std::fputs((csv ? summary_csv(rows) : summary_markdown(study, rows)).c_str(), stdout);
}

}  // namespace

CommandRunner add_report_command(CLI::App& parent) {
  CLI::App* command = parent.add_subcommand(
      "report", "compare runs, or drives, side by side: a table on stdout, and a page");
  struct Options {
    std::vector<std::string> folders;
    std::string output;
    bool csv = false;
  };
  auto options = std::make_shared<Options>();
  command
      ->add_option(
          "DIR", options->folders,
          "output folders of `run`, or of `drive`, the first is what others are compared with; or "
          "one of `batch`")
      ->required();
  command->add_option("-o,--output", options->output, "write an HTML page too");
  command->add_flag("--csv", options->csv, "CSV on stdout instead of Markdown");
  return [options](const CommonOptions&) {
    const std::vector<std::filesystem::path> folders(options->folders.begin(),
                                                     options->folders.end());
    if (!options->output.empty()) require_page_name(options->output);
    if (is_drive(folders.front())) return report_drives(folders, options->output, options->csv);
    if (folders.size() == 1 && std::filesystem::exists(folders.front() / kPlanFile)) {
      report_study(folders.front(), options->output, options->csv);
      return kExitDone;
    }
    const std::vector<RunColumn> runs = read_runs(folders);
    if (!same_metrics(runs))
      spdlog::warn(
          "the runs were measured by different definitions (metrics_version): their figures can't "
          "be compared");
    if (!options->output.empty()) write_file(options->output, report_html(runs));
    std::fputs((options->csv ? report_csv(runs) : report_markdown(runs)).c_str(), stdout);
    return kExitDone;
  };
}

}  // namespace sumogamma
