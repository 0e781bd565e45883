#include "app/prediction_export.h"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "io/parquet.h"

namespace sumogamma {

namespace {

constexpr std::array<const char*, kExportColumns> kColumns = {
    "set",    "memory", "method", "agent", "type",     "frame",   "step",
    "sample", "weight", "x_m",    "y_m",   "true_x_m", "true_y_m"};

const std::string& type_name(const Track& track) {
  static const AgentTypeTable types = recorded_agent_types();
  return type_of(types, track.type).name;
}

class CsvTable final : public ExportTable {
 public:
  explicit CsvTable(const std::string& path) : path_(path), part_(path + ".part"), file_(part_) {
    for (const char* column : kColumns) file_ << (column == kColumns.front() ? "" : ",") << column;
    file_ << '\n';
    if (!file_) throw Error(path, "cannot be written");
  }
  ~CsvTable() override {
    if (!file_.is_open()) return;
    file_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  void add(const ExportLabels& labels, const ScoredForecast& told) override {
    const auto now = static_cast<std::size_t>(told.frame - told.truth.first);
    for (std::size_t k = 0; k < told.predicted.size(); ++k) {
      const Vec2 &at = told.predicted[k], &truth = told.truth.position[now + 1 + k];
      file_ << fmt::format("{},{},{},{},{},{},{},{},{:.9g},{:.6f},{:.6f},{:.6f},{:.6f}\n",
                           labels.set, labels.memory, labels.method, told.truth.id,
                           type_name(told.truth), told.frame, k + 1, told.sample, told.weight,
                           at.x(), at.y(), truth.x(), truth.y());
    }
  }
  void close() override {
    if (!file_.flush()) throw Error(path_, "cannot be written");
    file_.close();
    std::filesystem::rename(part_, path_);
  }

 private:
  std::string path_, part_;
  std::ofstream file_;
};

class ParquetTable final : public ExportTable {
 public:
  explicit ParquetTable(const std::string& path)
      : columns_(empty_columns()), file_(path, columns_) {}

  void add(const ExportLabels& labels, const ScoredForecast& told) override {
    const auto now = static_cast<std::size_t>(told.frame - told.truth.first);
    for (std::size_t k = 0; k < told.predicted.size(); ++k) {
      const Vec2 &at = told.predicted[k], &truth = told.truth.position[now + 1 + k];
      const std::array<const std::string*, kExportColumns> texts = {
          &labels.set, &labels.memory, &labels.method, nullptr, &type_name(told.truth)};
      const std::array<double, kExportColumns> numbers = {0,
                                                          0,
                                                          0,
                                                          static_cast<double>(told.truth.id),
                                                          0,
                                                          static_cast<double>(told.frame),
                                                          static_cast<double>(k + 1),
                                                          static_cast<double>(told.sample),
                                                          told.weight,
                                                          at.x(),
                                                          at.y(),
                                                          truth.x(),
                                                          truth.y()};
      for (std::size_t c = 0; c < kExportColumns; ++c)
        if (texts[c] != nullptr)
          std::get<std::vector<std::string>>(columns_[c].values).push_back(*texts[c]);
        else
          std::get<std::vector<double>>(columns_[c].values).push_back(numbers[c]);
      if (++rows_ == kGroup) write_group();
    }
  }
  void close() override {
    write_group();
    file_.close();
  }

 private:
  static constexpr std::size_t kGroup = 50000;  // rows

  static bool is_text(std::size_t column) { return column < 3 || column == 4; }
  static std::vector<ParquetColumn> empty_columns() {
    std::vector<ParquetColumn> columns;
    for (std::size_t c = 0; c < kExportColumns; ++c)
      columns.push_back({kColumns[c], is_text(c) ? ParquetValues(std::vector<std::string>())
                                                 : ParquetValues(std::vector<double>())});
    return columns;
  }
  void write_group() {
    file_.write_group(columns_);
    for (ParquetColumn& column : columns_)
      std::visit([](auto& values) { values.clear(); }, column.values);
    rows_ = 0;
  }

  std::vector<ParquetColumn> columns_;
  ParquetWriter file_;
  std::size_t rows_ = 0;
};

}  // namespace

std::unique_ptr<ExportTable> make_export_table(const std::string& path) {
  if (path.ends_with(".parquet")) return std::make_unique<ParquetTable>(path);
  return std::make_unique<CsvTable>(path);
}

}  // namespace sumogamma
