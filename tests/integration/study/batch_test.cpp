#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <thread>
#include <vector>

#include "base/subprocess.h"
#include "io/output_file.h"

extern char** environ;

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Words = std::vector<std::string>;

/// Two small scenarios for eight seconds each.
class Batch : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("sumogamma_batch_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write_study(const std::string& name, const std::string& head,
                       const std::string& tables = "") const {
    const std::string scenarios = SUMOGAMMA_SOURCE_DIR "/sumo_scenarios/";
    const fs::path file = folder_ / (name + ".toml");
    write_file(file, "[study]\nname = \"small\"\nscenarios = [\"" + scenarios +
                         "signalled_crossing\", \"" + scenarios +
                         "zebra/zebra.sumocfg\"]\nduration = 8\n" + head + "\n" + tables);
    return file;
  }
  static ProcessResult program(Words words) {
    ProcessRequest request;
    request.arguments = std::move(words);
    request.arguments.insert(request.arguments.begin(), SUMOGAMMA_PROGRAM);
    return run_process(request);
  }
  static ProcessResult run(Words words) {
    words.insert(words.begin(), "batch");
    return program(std::move(words));
  }
  static void expect_same_results(const fs::path& one, const fs::path& other) {
    for (const char* file : {"runs.csv", "summary.csv", "summary.md", "study.sqlite", "study.json",
                             "plan.json", "report.html"})
      EXPECT_TRUE(read_file(one / file) == read_file(other / file)) << file;
  }

  fs::path folder_;
};

/// A batch that is killed with SIGKILL as soon as `ready` holds.
template <typename Ready>
void run_and_kill(const Words& words, Ready&& ready) {
  std::vector<std::string> all{SUMOGAMMA_PROGRAM, "batch"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t pid = -1;
  ASSERT_EQ(posix_spawn(&pid, SUMOGAMMA_PROGRAM, nullptr, nullptr, pointers.data(), environ), 0);
  for (int i = 0; i < 6000 && !ready(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(ready());
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
}

std::size_t count_results(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator file(folder, error), end; !error && file != end;
       file.increment(error))
    count += file->path().filename() == "results.json" ? 1 : 0;
  return count;
}

TEST_F(Batch, GivesTheSameBytesHoweverItWasRun) {
  const std::string study =
      write_study("study", "seeds = \"5..6\"\nquestion = \"Who drives <better>?\"").string();
  const fs::path whole = folder_ / "whole", killed = folder_ / "killed", parts = folder_ / "parts";
  const ProcessResult first = run({study, "-o", whole.string(), "--quiet"});
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("| plain |"));
  EXPECT_EQ(count_results(whole), 8u);

  // killed amid runs, twice: what runs on is neither started again nor lost
  const Words again{study, "-o", killed.string(), "--quiet", "--jobs", "2"};
  run_and_kill(again, [&] { return count_results(killed) >= 1; });
  run_and_kill(again, [&] { return count_results(killed) >= 4; });
  const ProcessResult resumed = run(again);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  expect_same_results(whole, killed);

  // one shard in the study's own folder, the other elsewhere
  const fs::path elsewhere = folder_ / "elsewhere";
  EXPECT_EQ(run({study, "-o", parts.string(), "--shard", "1/2", "--quiet"}).exit_code, 0);
  const ProcessResult early = run({study, "-o", parts.string(), "--merge"});
  EXPECT_EQ(early.exit_code, 2);
  EXPECT_THAT(early.errors, HasSubstr("4 of 8 runs are missing"));
  EXPECT_EQ(run({study, "-o", elsewhere.string(), "--shard", "2/2", "--quiet"}).exit_code, 0);
  const ProcessResult merged =
      run({study, "-o", parts.string(), "--merge", "--from", elsewhere.string()});
  EXPECT_EQ(merged.exit_code, 0) << merged.errors;
  expect_same_results(whole, parts);

  // all is done: nothing is run again
  const auto before = fs::last_write_time(whole / "runs/zebra/plain/5/results.json");
  EXPECT_EQ(run({study, "-o", whole.string(), "--quiet"}).exit_code, 0);
  EXPECT_EQ(fs::last_write_time(whole / "runs/zebra/plain/5/results.json"), before);
  expect_same_results(whole, killed);

  // what people read of it
  const ProcessResult report =
      program({"report", whole.string(), "-o", (folder_ / "page.html").string()});
  EXPECT_EQ(report.exit_code, 0) << report.errors;
  EXPECT_EQ(report.output, first.output);
  EXPECT_TRUE(read_file(folder_ / "page.html") == read_file(whole / "report.html"));
  EXPECT_THAT(read_file(folder_ / "page.html"), HasSubstr("<h1>Who drives &lt;better&gt;?</h1>"));
  const std::string zebra = (whole / "runs/zebra").string();
  const ProcessResult same = program({"compare", zebra + "/plain", zebra + "/plain"});
  EXPECT_EQ(same.exit_code, 0) << same.errors;
  EXPECT_THAT(same.output, HasSubstr("| 0.000 ("));
  const ProcessResult apart =
      program({"compare", zebra + "/plain", zebra + "/gamma", "-o", (folder_ / "apart").string()});
  EXPECT_EQ(apart.exit_code, 0) << apart.errors;
  EXPECT_THAT(read_file(folder_ / "apart/distances.csv"), HasSubstr("speed,"));

  const std::string cut = (folder_ / "cut.fcd.xml.gz").string();
  const std::string recording = read_file(zebra + "/gamma/5/trajectories.fcd.xml.gz");
  write_file(cut, recording.substr(0, recording.size() / 2));
  const ProcessResult refused_cut = program({"compare", cut, zebra + "/gamma"});
  EXPECT_EQ(refused_cut.exit_code, 2);
  EXPECT_THAT(refused_cut.errors, HasSubstr("it was cut off"));

  // the same folder with other settings
  const std::string other = write_study("other", "seeds = 1\nagents = 7").string();
  const ProcessResult refused = run({other, "-o", whole.string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("holds runs with other options"));
}

TEST_F(Batch, ARunThatFailsStopsNoOther) {
  const std::string study = write_study("study", "seeds = [3]\ndrivers = \"gamma\"", R"(
[[variant]]
name = "sound"
[[variant]]
name = "broken"
options = ["--sumo-options", "--no-such-option-of-sumo"]
)")
                                .string();
  const fs::path output = folder_ / "out";
  const ProcessResult result = run({study, "-o", output.string(), "--quiet"});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("2 of 4 runs failed"));
  EXPECT_THAT(result.errors, HasSubstr("runs/zebra/broken/3/log.txt"));
  EXPECT_TRUE(fs::exists(output / "runs/zebra/sound/3/results.json"));
  EXPECT_FALSE(read_file(output / "runs/zebra/broken/3/log.txt").empty());
  EXPECT_THAT(read_file(output / "runs.csv"), HasSubstr("zebra,broken,3,failed,"));
}

TEST_F(Batch, AddsSeedsUntilTheIntervalIsNarrow) {
  const std::string study = write_study("study",
                                        "seeds = 2\ndrivers = \"plain\"\nmost_seeds = 6\nuntil = "
                                        "\"flow.mean_speed=1e-9\"")
                                .string();
  const fs::path output = folder_ / "out";
  const ProcessResult result = run({study, "-o", output.string(), "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errors, HasSubstr("after 6 seeds"));
  EXPECT_TRUE(fs::exists(output / "runs/zebra/plain/6/results.json"));
  // wide enough at once
  const ProcessResult wide =
      run({study, "-o", (folder_ / "wide").string(), "--quiet", "--until", "flow.mean_speed=100"});
  EXPECT_EQ(wide.exit_code, 0) << wide.errors;
  EXPECT_EQ(count_results(folder_ / "wide"), 4u);
  const ProcessResult unknown =
      run({study, "-o", (folder_ / "wide").string(), "--quiet", "--until", "flow.no_such=1"});
  EXPECT_EQ(unknown.exit_code, 2);
}

TEST_F(Batch, RefusesBeforeTheFirstRun) {
  struct Case {
    const char *head, *tables, *message;
  };
  const std::string out = (folder_ / "out").string();
  for (const Case& bad : {
           Case{"sedes = 3", "",
                "unknown key 'sedes' of [study], the nearest known one is 'seeds'"},
           Case{"seeds = 3", "[gird]\n", "the nearest known one is 'grid'"},
           Case{"seeds = 3", "[grid]\n\"types.car.hedway\" = [1.0]\n", "types.car.headway"},
           Case{"seeds = 3", "[grid]\ntypes.car.headway = 1.0\n", "must be a list"},
           Case{"seeds = 3\noptions = [\"--no-such\"]", "", "--no-such"},
           Case{"seeds = 3\nbaseline = \"plane\"", "", "the nearest one is 'plain'"},
           Case{"seeds = \"9..2\"", "", "must go up"},
           Case{"seeds = 3\nuntil = \"flow.mean_speed\"", "", "MEASURE=WIDTH"},
           Case{"seeds = 3", "[latin_hypercube]\npoints = 2\n", "needs a KEY"},
           Case{"seeds = 3", "[[variant]]\nname = \"a\"\n[[variant]]\nname = \"a\"\n", "rename"},
           Case{"seeds =", "", "not TOML"},
       }) {
    SCOPED_TRACE(bad.message);
    const ProcessResult result =
        run({write_study("bad", bad.head, bad.tables).string(), "-o", out});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.errors, HasSubstr(bad.message));
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }
  write_file(folder_ / "absent.toml", "[study]\nscenarios = [\"no_such_scenario\"]\nseeds = 2\n");
  const ProcessResult absent = run({(folder_ / "absent.toml").string(), "-o", out});
  EXPECT_EQ(absent.exit_code, 2);
  EXPECT_THAT(absent.errors, HasSubstr("absent.toml:2: scenario 'no_such_scenario' isn't there"));
  // a folder of somebody else's
  write_file(folder_ / "absent.txt", "mine");
  const std::string good = write_study("good", "seeds = 1").string();
  const ProcessResult occupied = run({good, "-o", folder_.string()});
  EXPECT_EQ(occupied.exit_code, 2);
  EXPECT_THAT(occupied.errors, HasSubstr("holds other files"));
  EXPECT_EQ(run({good, "-o", out, "--shard", "3/2"}).exit_code, 2);
}

}  // namespace
}  // namespace sumogamma
