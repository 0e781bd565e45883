#include "base/subprocess.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>

#include "base/error.h"

namespace sumogamma {
namespace {

ProcessRequest shell(const std::string& script) {
  ProcessRequest request;
  request.arguments = {"sh", "-c", script};
  request.time_limit = 20.0;
  return request;
}

double seconds_of(const std::function<void()>& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(RunProcess, GathersBothStreamsAndTheExitCode) {
  const ProcessResult result = run_process(shell("echo out; echo err >&2; exit 3"));
  EXPECT_EQ(result.output, "out\n");
  EXPECT_EQ(result.errors, "err\n");
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(result.signal, 0);
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(describe_end(result, 20), "exit code 3");
}

TEST(RunProcess, DoesNotDeadlockOnMuchOutputOnBothStreams) {
  const ProcessResult result = run_process(
      shell("i=0; while [ $i -lt 3000 ]; do echo 0123456789012345678901234567890123456789; echo "
            "0123456789012345678901234567890123456789 >&2; i=$((i+1)); done"));
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.output.size(), 3000u * 41u);
  EXPECT_EQ(result.errors.size(), 3000u * 41u);
}

TEST(RunProcess, KeepsNoMoreThanTheLimit) {
  ProcessRequest request = shell("head -c 300000 /dev/zero");
  request.output_limit = 1000;
  const ProcessResult result = run_process(request);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.output.size(), 1000u);
}

TEST(RunProcess, ReportsDeathBySignal) {
  const ProcessResult result = run_process(shell("kill -SEGV $$"));
  EXPECT_EQ(result.signal, SIGSEGV);
  EXPECT_FALSE(result.ok());
  EXPECT_NE(describe_end(result, 20).find("signal 11"), std::string::npos);
}

TEST(RunProcess, EndsAProgramThatTakesTooLong) {
  ProcessRequest request = shell("sleep 60");
  request.time_limit = 0.3;
  ProcessResult result;
  EXPECT_LT(seconds_of([&] { result = run_process(request); }), 10.0);
  EXPECT_TRUE(result.timed_out);
  EXPECT_FALSE(result.ok());
}

TEST(RunProcess, KillsAProgramThatIgnoresTermination) {
  ProcessRequest request = shell("trap '' TERM; while true; do sleep 1; done");
  request.time_limit = 0.3;
  ProcessResult result;
  EXPECT_LT(seconds_of([&] { result = run_process(request); }), 10.0);
  EXPECT_TRUE(result.timed_out);
  EXPECT_EQ(result.signal, SIGKILL);
}

TEST(RunProcess, StopsWhenAskedTo) {
  ProcessRequest request = shell("sleep 60");
  request.should_stop = [] { return true; };
  ProcessResult result;
  EXPECT_LT(seconds_of([&] { result = run_process(request); }), 10.0);
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(describe_end(result, 20), "stopped on request");
}

TEST(RunProcess, DoesNotWaitForAGrandchildThatKeepsTheStreamsOpen) {
  ProcessResult result;
  EXPECT_LT(seconds_of([&] { result = run_process(shell("sleep 15 & echo done")); }), 10.0);
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result.output, "done\n");
}

TEST(RunProcess, GivesNoInput) { EXPECT_TRUE(run_process(shell("cat")).ok()); }

TEST(RunProcess, AddsAndReplacesEnvironment) {
  ProcessRequest request = shell("printf '%s %s' \"$SUMOGAMMA_TEST\" \"$HOME\"");
  request.environment = {{"SUMOGAMMA_TEST", "a b"}, {"HOME", "/nowhere"}};
  EXPECT_EQ(run_process(request).output, "a b /nowhere");
}

TEST(RunProcess, NamesAProgramThatIsNotThere) {
  ProcessRequest request;
  request.arguments = {"no-such-program-here"};
  try {
    run_process(request);
    FAIL() << "started nothing";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("no-such-program-here"), std::string::npos);
  }
}

TEST(FindProgram, FindsWhatIsInThePathOnly) {
  EXPECT_TRUE(find_program("sh").is_absolute());
  EXPECT_TRUE(find_program("no-such-program-here").empty());
}

}  // namespace
}  // namespace sumogamma
