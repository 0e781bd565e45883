#include <sqlite3.h>

#include <cmath>
#include <memory>

#include "base/error.h"
#include "io/study_results.h"
#include "study/measures.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = R"(
PRAGMA journal_mode = OFF;
PRAGMA synchronous = OFF;
BEGIN;
CREATE TABLE study (name TEXT NOT NULL, question TEXT NOT NULL, baseline TEXT NOT NULL);
CREATE TABLE scenarios (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE);
CREATE TABLE variants (id INTEGER PRIMARY KEY, name TEXT NOT NULL UNIQUE, driver TEXT NOT NULL);
CREATE TABLE settings (variant INTEGER NOT NULL REFERENCES variants, key TEXT NOT NULL,
                       value TEXT NOT NULL);
CREATE TABLE runs (id INTEGER PRIMARY KEY, scenario INTEGER NOT NULL REFERENCES scenarios,
                   variant INTEGER NOT NULL REFERENCES variants, seed INTEGER NOT NULL,
                   status TEXT NOT NULL, state_hash TEXT NOT NULL, failure TEXT NOT NULL);
CREATE TABLE figures (run INTEGER NOT NULL REFERENCES runs, key TEXT NOT NULL, value REAL NOT NULL,
                      PRIMARY KEY (run, key)) WITHOUT ROWID;
CREATE TABLE summary (scenario TEXT NOT NULL, variant TEXT NOT NULL, measure TEXT NOT NULL,
                      runs INTEGER NOT NULL, mean REAL NOT NULL, deviation REAL, low_95 REAL,
                      high_95 REAL, pairs INTEGER NOT NULL, difference REAL,
                      difference_low_95 REAL, difference_high_95 REAL);
)";

class Database {
 public:
  Database(fs::path shown, const fs::path& file) : shown_(std::move(shown)) {
    const int code = sqlite3_open(file.c_str(), &handle_);
    if (code != SQLITE_OK) fail();
  }
  ~Database() { sqlite3_close(handle_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void execute(const char* statements) {
    if (sqlite3_exec(handle_, statements, nullptr, nullptr, nullptr) != SQLITE_OK) fail();
  }
  /// Whatever couldn't be written shows here at the latest.
  void close() {
    if (sqlite3_close(handle_) != SQLITE_OK) fail();
    handle_ = nullptr;
  }
  [[noreturn]] void fail() const {
    throw Error(shown_.string(), std::string("can't be written (") +
                                     (handle_ ? sqlite3_errmsg(handle_) : "no memory") + ")");
  }
  sqlite3* handle() const { return handle_; }

 private:
  fs::path shown_;
  sqlite3* handle_ = nullptr;
};

/// One INSERT, executed again and again.
class Insert {
 public:
  Insert(const Database& database, const char* statement) : database_(database) {
    if (sqlite3_prepare_v2(database.handle(), statement, -1, &statement_, nullptr) != SQLITE_OK)
      database.fail();
  }
  ~Insert() { sqlite3_finalize(statement_); }
  Insert(const Insert&) = delete;
  Insert& operator=(const Insert&) = delete;

  template <typename... Values>
  void add(const Values&... values) {
    int place = 0;
    (bind(++place, values), ...);
    if (sqlite3_step(statement_) != SQLITE_DONE) database_.fail();
    sqlite3_reset(statement_);
  }

 private:
  void bind(int place, const std::string& text) {
    sqlite3_bind_text64(statement_, place, text.data(), text.size(), nullptr, SQLITE_UTF8);
  }
  void bind(int place, double value) {
    if (std::isfinite(value))
      sqlite3_bind_double(statement_, place, value);
    else
      sqlite3_bind_null(statement_, place);
  }
  void bind(int place, std::size_t value) {
    sqlite3_bind_int64(statement_, place, static_cast<sqlite3_int64>(value));
  }

  const Database& database_;
  sqlite3_stmt* statement_ = nullptr;
};

void add_plan(const Database& database, const Study& study) {
  Insert(database, "INSERT INTO study VALUES (?, ?, ?)")
      .add(study.name, study.question, study.variants[study.baseline].name);
  Insert scenarios(database, "INSERT INTO scenarios VALUES (?, ?)");
  for (std::size_t i = 0; i < study.scenarios.size(); ++i)
    scenarios.add(i + 1, study.scenarios[i].name);
  Insert variants(database, "INSERT INTO variants VALUES (?, ?, ?)");
  Insert settings(database, "INSERT INTO settings VALUES (?, ?, ?)");
  for (std::size_t i = 0; i < study.variants.size(); ++i) {
    const StudyVariant& variant = study.variants[i];
    variants.add(i + 1, variant.name, std::string(variant.plain ? "plain" : "gamma"));
    for (const StudySetting& setting : variant.set) settings.add(i + 1, setting.key, setting.value);
  }
}

void add_runs(const Database& database, std::span<const StudyRunResult> results) {
  Insert runs(database, "INSERT INTO runs VALUES (?, ?, ?, ?, ?, ?, ?)");
  Insert figures(database, "INSERT INTO figures VALUES (?, ?, ?)");
  std::size_t id = 0;
  for (const StudyRunResult& result : results) {
    ++id;
    const std::string status = result.status == RunStatus::Done     ? "done"
                               : result.status == RunStatus::Failed ? "failed"
                                                                    : "missing";
    runs.add(id, result.run.scenario + 1, result.run.variant + 1,
             static_cast<std::size_t>(result.run.seed), status, result.state_hash, result.failure);
    for (const auto& [key, value] : result.numbers)
      if (!is_about_machine(key)) figures.add(id, key, value);
  }
}

void add_summary(const Database& database, std::span<const SummaryRow> rows) {
  Insert summary(database, "INSERT INTO summary VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
  for (const SummaryRow& row : rows) {
    const double unknown = std::nan("");
    const bool paired = row.difference.count > 0;
    summary.add(row.scenario, row.variant, row.measure, row.value.count, row.value.mean,
                row.value.has_interval() ? row.value.deviation : unknown, row.value.low,
                row.value.high, row.difference.count, paired ? row.difference.mean : unknown,
                paired ? row.difference.low : unknown, paired ? row.difference.high : unknown);
  }
}

}  // namespace

void write_study_database(const fs::path& file, const Study& study,
                          std::span<const StudyRunResult> runs, std::span<const SummaryRow> rows) {
  fs::path temporary = file;
  temporary += ".part";
  std::error_code ignored;
  fs::remove(temporary, ignored);
  try {
    Database database(file, temporary);
    database.execute(kSchema);
    add_plan(database, study);
    add_runs(database, runs);
    add_summary(database, rows);
    database.execute("COMMIT");
    database.close();
  } catch (const Error&) {
    fs::remove(temporary, ignored);
    throw;
  }
  std::error_code error;
  fs::rename(temporary, file, error);
  if (!error) return;
  fs::remove(temporary, ignored);
  throw Error(file.string(), "can't be replaced (" + error.message() + ")");
}

}  // namespace sumogamma
