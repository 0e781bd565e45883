#pragma once

#include <memory>
#include <string>

#include "prediction/evaluation.h"

namespace sumogamma {

/// What a row of an export says besides the forecast itself.
struct ExportLabels {
  std::string set, memory, method;
};

/// A table that forecasts are written to: a row for each agent, window, step and sample, with the
/// true position.
class ExportTable {
 public:
  virtual ~ExportTable() = default;
  /// Throws Error naming a file that can't be written.
  virtual void add(const ExportLabels& labels, const ScoredForecast& told) = 0;
  /// Ends the table and gives it its name; without it nothing is left. Throws likewise.
  virtual void close() = 0;
};

/// Columns of an export, in order: set, memory, method, agent, type, frame, step, sample, weight,
/// x_m, y_m, true_x_m, true_y_m.
inline constexpr std::size_t kExportColumns = 13;

/// A table in FILE.parquet (numbers as doubles, texts as UTF-8), or as CSV under any other name;
/// beside the file until it is whole. Throws Error naming a file that can't be written.
std::unique_ptr<ExportTable> make_export_table(const std::string& path);

}  // namespace sumogamma
