#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace sumogamma {

/// One run's results.json, flattened: "flow.mean_speed" -> 5.1. Order as in the file.
struct RunColumn {
  std::string name;  ///< folder, made unique and short
  struct Value {
    std::string key, text;
    double number = 0;
    bool is_number = false;
  };
  std::vector<Value> values;
};

/// Reads results.json of each folder (or the file itself where one is named). Throws Error naming
/// the file where it is missing or isn't a run's results.
std::vector<RunColumn> read_runs(std::span<const std::filesystem::path> folders);

/// Were the figures of all runs measured by the same definitions (metrics_version)?
bool same_metrics(std::span<const RunColumn> runs);

/// Side by side, a line a key, every key that any run has; a run without it shows nothing.
std::string report_markdown(std::span<const RunColumn> runs);
std::string report_csv(std::span<const RunColumn> runs);

/// One self-contained HTML page: tables with bars, and the difference of each run to the first.
std::string report_html(std::span<const RunColumn> runs);

}  // namespace sumogamma
