#include "io/trajectory_tables.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <iterator>
#include <mutex>
#include <thread>
#include <utility>

#include "base/csv_text.h"
#include "base/error.h"
#include "io/parquet.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

enum class Kind { Time, Number, Text };
struct Column {
  const char* name;
  Kind kind;
  double TrajectoryRow::*number;
};
constexpr std::array kColumns{
    Column{"time", Kind::Time, nullptr},
    Column{"id", Kind::Text, nullptr},
    Column{"type", Kind::Text, nullptr},
    Column{"x", Kind::Number, &TrajectoryRow::x},
    Column{"y", Kind::Number, &TrajectoryRow::y},
    Column{"angle", Kind::Number, &TrajectoryRow::angle},
    Column{"speed", Kind::Number, &TrajectoryRow::speed},
    Column{"place", Kind::Text, nullptr},
    Column{"pos", Kind::Number, &TrajectoryRow::along},
    Column{"slope", Kind::Number, &TrajectoryRow::slope},
};

std::string_view text_of(const TrajectoryRow& row, const Column& column) {
  return column.name == std::string_view("id")     ? std::string_view(row.id)
         : column.name == std::string_view("type") ? row.type
                                                   : row.place;
}

std::vector<const Column*> columns_named(const std::vector<std::string>& names) {
  std::vector<const Column*> columns;
  for (const Column& column : kColumns)
    if (std::find(names.begin(), names.end(), column.name) != names.end())
      columns.push_back(&column);
  return columns;
}

class CsvTable {
 public:
  CsvTable(fs::path file, std::vector<const Column*> columns)
      : file_(std::move(file)),
        columns_(std::move(columns)),
        stream_(gzopen(file_.c_str(), "wb4")) {
    if (!stream_)
      throw Error(file_.string(), std::string("can't be written (") + std::strerror(errno) + ")");
    for (const Column* column : columns_)
      text_ += (text_.empty() ? "" : ",") + std::string(column->name);
    text_ += '\n';
  }
  ~CsvTable() {
    if (stream_) gzclose(stream_);
  }
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  void add(double time, std::span<const TrajectoryRow> rows) {
    for (const TrajectoryRow& row : rows) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        if (k > 0) text_ += ',';
        const Column& column = *columns_[k];
        if (column.kind == Kind::Text)
          text_ += csv_field(text_of(row, column));
        else if (column.kind == Kind::Time)
          fmt::format_to(std::back_inserter(text_), "{:.3f}", time);
        else
          fmt::format_to(std::back_inserter(text_), "{:.2f}", row.*column.number);
      }
      text_ += '\n';
    }
    flush();
    constexpr int kSyncEvery = 64;
    if (++since_sync_ % kSyncEvery == 0 && gzflush(stream_, Z_SYNC_FLUSH) != Z_OK) fail();
  }
  void close() {
    if (!stream_) return;
    flush();
    const int code = gzclose(std::exchange(stream_, nullptr));
    if (code != Z_OK) throw Error(file_.string(), "can't be written to its end");
  }

 private:
  void flush() {
    if (!text_.empty() && gzwrite(stream_, text_.data(), static_cast<unsigned>(text_.size())) <= 0)
      fail();
    text_.clear();
  }
  [[noreturn]] void fail() {
    gzclose(std::exchange(stream_, nullptr));
    throw Error(file_.string(), "can't be written to its end, make room and run again");
  }

  fs::path file_;
  std::vector<const Column*> columns_;
  gzFile stream_;
  std::string text_;
  int since_sync_ = 0;
};

class ParquetTable {
 public:
  ParquetTable(const fs::path& file, std::vector<const Column*> columns)
      : columns_(std::move(columns)), group_(empty_group()), writer_(file, empty_group()) {}

  void add(double time, std::span<const TrajectoryRow> rows) {
    constexpr std::size_t kGroup = 50000;
    for (const TrajectoryRow& row : rows) {
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        const Column& column = *columns_[k];
        ParquetValues& values = group_[k].values;
        if (column.kind == Kind::Text)
          std::get<std::vector<std::string>>(values).emplace_back(text_of(row, column));
        else if (column.kind == Kind::Time)
          std::get<std::vector<double>>(values).push_back(time);
        else
          std::get<std::vector<float>>(values).push_back(static_cast<float>(row.*column.number));
      }
      if (++rows_ >= kGroup) write_group();
    }
  }
  void close() {
    write_group();
    writer_.close();
  }

 private:
  std::vector<ParquetColumn> empty_group() const {
    std::vector<ParquetColumn> group;
    for (const Column* column : columns_) {
      ParquetColumn made{column->name, std::vector<float>{}};
      if (column->kind == Kind::Text) made.values = std::vector<std::string>{};
      if (column->kind == Kind::Time) made.values = std::vector<double>{};
      group.push_back(std::move(made));
    }
    return group;
  }
  void write_group() {
    if (rows_ == 0) return;
    writer_.write_group(group_);
    group_ = empty_group();
    rows_ = 0;
  }

  std::vector<const Column*> columns_;
  std::vector<ParquetColumn> group_;
  ParquetWriter writer_;
  std::size_t rows_ = 0;
};

/// A table of vehicles and one of persons.
template <typename Table>
class TwoTables final : public TrajectorySink {
 public:
  TwoTables(const fs::path& folder, const std::string& extension,
            const std::vector<std::string>& columns)
      : vehicles_(folder / ("vehicles" + extension), columns_named(columns)),
        persons_(folder / ("persons" + extension), columns_named(columns)) {}
  void add(const TrajectoryStep& step) override {
    vehicles_.add(step.time, step.vehicles);
    persons_.add(step.time, step.persons);
  }
  void close() override {
    vehicles_.close();
    persons_.close();
  }

 private:
  Table vehicles_, persons_;
};

class ThreadedSink final : public TrajectorySink {
 public:
  ThreadedSink(std::vector<std::unique_ptr<TrajectorySink>> sinks, std::size_t most)
      : sinks_(std::move(sinks)), most_(most), thread_([this] { work(); }) {}
  ~ThreadedSink() override { stop(); }

  void add(const TrajectoryStep& step) override {
    std::unique_lock lock(mutex_);
    room_.wait(lock, [&] { return waiting_.size() < most_ || failure_; });
    if (failure_) std::rethrow_exception(failure_);
    waiting_.push_back({step.time,
                        {step.vehicles.begin(), step.vehicles.end()},
                        {step.persons.begin(), step.persons.end()}});
    lock.unlock();
    work_.notify_one();
  }
  void close() override {
    stop();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    for (const auto& sink : sinks_) sink->close();
  }

 private:
  struct Step {
    double time = 0;
    std::vector<TrajectoryRow> vehicles, persons;
  };
  void stop() {
    {
      const std::scoped_lock lock(mutex_);
      stopped_ = true;
    }
    work_.notify_one();
    if (thread_.joinable()) thread_.join();
  }
  void work() {
    for (;;) {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [&] { return stopped_ || !waiting_.empty(); });
      if (waiting_.empty() || failure_) return;
      const Step step = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      room_.notify_one();
      try {
        for (const auto& sink : sinks_) sink->add({step.time, step.vehicles, step.persons});
      } catch (...) {
        lock.lock();
        failure_ = std::current_exception();
        room_.notify_all();
        return;
      }
    }
  }

  std::vector<std::unique_ptr<TrajectorySink>> sinks_;
  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable work_, room_;
  std::deque<Step> waiting_;
  bool stopped_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  ///< the last: it reads all of the above
};

}  // namespace

std::vector<std::string> trajectory_columns() {
  std::vector<std::string> names;
  for (const Column& column : kColumns) names.emplace_back(column.name);
  return names;
}

std::unique_ptr<TrajectorySink> make_csv_tables(const fs::path& folder,
                                                std::vector<std::string> columns) {
  return std::make_unique<TwoTables<CsvTable>>(folder, ".csv.gz", columns);
}

std::unique_ptr<TrajectorySink> make_parquet_tables(const fs::path& folder,
                                                    std::vector<std::string> columns) {
  return std::make_unique<TwoTables<ParquetTable>>(folder, ".parquet", columns);
}

std::unique_ptr<TrajectorySink> make_threaded(std::vector<std::unique_ptr<TrajectorySink>> sinks,
                                              std::size_t most) {
  return std::make_unique<ThreadedSink>(std::move(sinks), most);
}

}  // namespace sumogamma
