#include "io/parquet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/subprocess.h"
#include "io/output_file.h"
#include "io/trajectory_tables.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;

class Parquet : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_parquet_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

std::vector<ParquetColumn> columns_of(std::vector<double> times, std::vector<std::string> names) {
  return {{"time", std::move(times)}, {"id", std::move(names)}};
}

TEST_F(Parquet, IsThereOnceItIsWhole) {
  const fs::path file = folder_ / "t.parquet";
  ParquetWriter writer(file, columns_of({}, {}));
  writer.write_group(columns_of({1.5, 2.5}, {"a", "b"}));
  EXPECT_FALSE(fs::exists(file));
  writer.close();
  writer.close();
  EXPECT_FALSE(fs::exists(folder_ / "t.parquet.part"));
  const std::string content = read_file(file);
  ASSERT_GT(content.size(), 12u);
  EXPECT_EQ(content.substr(0, 4), "PAR1");
  EXPECT_EQ(content.substr(content.size() - 4), "PAR1");
  std::uint32_t footer = 0;
  std::memcpy(&footer, content.data() + content.size() - 8, sizeof footer);
  EXPECT_LT(footer, content.size() - 12);
}

TEST_F(Parquet, LeavesNothingWhereItWasGivenUp) {
  { ParquetWriter writer(folder_ / "t.parquet", columns_of({}, {})); }
  EXPECT_TRUE(fs::is_empty(folder_));
  EXPECT_THROW(ParquetWriter("/dev/null/t.parquet", columns_of({}, {})), Error);
}

/// A sink that takes steps as long as it is told to.
class Recorder final : public TrajectorySink {
 public:
  Recorder(std::vector<double>& times, int fails_after) : times_(times), left_(fails_after) {}
  void add(const TrajectoryStep& step) override {
    if (left_-- == 0) throw Error("disk", "is full");
    times_.push_back(step.time + static_cast<double>(step.vehicles.size()));
  }
  void close() override { times_.push_back(-1); }

 private:
  std::vector<double>& times_;
  int left_;
};

TEST(ThreadedSink, KeepsTheOrderAndEndsWithAll) {
  std::vector<double> times;
  std::vector<std::unique_ptr<TrajectorySink>> sinks;
  sinks.push_back(std::make_unique<Recorder>(times, -1));
  const auto threaded = make_threaded(std::move(sinks), 3);
  const std::vector<TrajectoryRow> rows(2);
  for (int k = 0; k < 500; ++k) threaded->add({k * 1.0, rows, {}});
  threaded->close();
  ASSERT_EQ(times.size(), 501u);
  for (int k = 0; k < 500; ++k) EXPECT_EQ(times[static_cast<std::size_t>(k)], k + 2.0);
  EXPECT_EQ(times.back(), -1);
}

TEST(ThreadedSink, TellsWhatItsThreadMet) {
  std::vector<double> times;
  std::vector<std::unique_ptr<TrajectorySink>> sinks;
  sinks.push_back(std::make_unique<Recorder>(times, 5));
  const auto threaded = make_threaded(std::move(sinks), 3);
  const auto fill = [&] {
    for (int k = 0; k < 500; ++k) threaded->add({k * 1.0, {}, {}});
    threaded->close();
  };
  EXPECT_THROW(fill(), Error);
}

/// Rows of 120,000 steps of one vehicle, in three groups, and no persons.
void write_tables(const fs::path& folder) {
  const auto tables = make_parquet_tables(folder, trajectory_columns());
  std::vector<TrajectoryRow> rows(1);
  rows[0].id = "flow,\"1\" ä";
  rows[0].type = "car";
  rows[0].place = "lane_0";
  for (int k = 0; k < 120000; ++k) {
    rows[0].x = k;
    rows[0].speed = 0.5;
    tables->add({0.5 * k, rows, {}});
  }
  tables->close();
}

TEST_F(Parquet, IsReadByTwoIndependentReaders) {
  const char* const readers = std::getenv("SUMOGAMMA_PARQUET_READERS");
  const fs::path node = find_program("node");
  if (!readers || node.empty())
    GTEST_SKIP() << "SUMOGAMMA_PARQUET_READERS names no folder with readers of the npm registry "
                    "(tools/check_parquet.mjs says which)";
  write_tables(folder_);
  ProcessRequest request;
  request.arguments = {node.string(), SUMOGAMMA_SOURCE_DIR "/tools/check_parquet.mjs", readers,
                       (folder_ / "vehicles.parquet").string(),
                       (folder_ / "persons.parquet").string()};
  const ProcessResult result = run_process(request);
  ASSERT_TRUE(result.ok()) << result.errors;
  // sums: 0.5 (0 + ... + 119999), 0 + ... + 119999, 120000 / 2
  for (const std::string reader : {"hyparquet", "parquet-wasm"})
    EXPECT_THAT(
        result.output,
        ::testing::HasSubstr(
            reader + R"( {"rows":120000,"sums":{"time":3599970000,"x":7199940000,"y":0,"angle":0,)"
                     R"("speed":60000,"pos":0,"slope":0},"last":{"time":59999.5,)"
                     R"("id":"flow,\"1\" ä","type":"car","x":119999)"));
  EXPECT_THAT(result.output, ::testing::HasSubstr("hyparquet {\"rows\":0,"));
  EXPECT_THAT(result.output, ::testing::HasSubstr("parquet-wasm {\"rows\":0,"));
}

TEST_F(Parquet, CsvTablesHaveTheSameRows) {
  const auto tables = make_csv_tables(folder_, {"id", "time", "speed"});
  std::vector<TrajectoryRow> rows(1);
  rows[0].id = "a,b";
  rows[0].speed = 1.25;
  tables->add({0.5, rows, {}});
  tables->add({1.0, {}, rows});
  tables->close();
  ProcessRequest request;
  request.arguments = {"gzip", "-dc", (folder_ / "vehicles.csv.gz").string(),
                       (folder_ / "persons.csv.gz").string()};
  // columns in their own order, whatever order they were named in
  EXPECT_EQ(run_process(request).output,
            "time,id,speed\n0.500,\"a,b\",1.25\ntime,id,speed\n1.000,\"a,b\",1.25\n");
}

}  // namespace
}  // namespace sumogamma
