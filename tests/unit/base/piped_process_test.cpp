#include "base/piped_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace sumogamma {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class PipedProcessTest : public ::testing::Test {
 protected:
  PipedProcessTest() { signal(SIGPIPE, SIG_IGN); }
  ~PipedProcessTest() override { fs::remove(log_); }
  fs::path log_ = fs::temp_directory_path() / ("sumogamma_piped_" + std::to_string(getpid()));
};

TEST_F(PipedProcessTest, IsTalkedTo) {
  PipedProcess echo({{"/bin/cat"}, 0, 1, log_});
  echo.write("one;two;");
  EXPECT_EQ(echo.read_until(';'), "one");
  echo.write("three;");
  EXPECT_EQ(echo.read_until(';'), "two");
  EXPECT_EQ(echo.read_until(';'), "three");
  EXPECT_EQ(echo.finish(), 0);
}

TEST_F(PipedProcessTest, TakesMoreThanAPipeHolds) {
  PipedProcess counter({{"/usr/bin/wc", "-c"}, 0, -1, log_});
  for (int i = 0; i < 50; ++i) counter.write(std::string(100000, 'x'));
  EXPECT_EQ(counter.finish(), 0);
  std::string count;
  std::ifstream(log_) >> count;
  EXPECT_EQ(count, "5000000");
}

TEST_F(PipedProcessTest, WhoGoesAwayIsNamedWithItsWords) {
  PipedProcess gone({{"/bin/ls", "/nowhere-at-all"}, 0, -1, log_});
  try {
    for (int i = 0; i < 1000; ++i) gone.write(std::string(100000, 'x'));
    FAIL() << "it took everything";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/bin/ls"));
    EXPECT_THAT(error.what(), HasSubstr("nowhere-at-all"));
  }
}

TEST_F(PipedProcessTest, WhoSaysNothingIsntWaitedForWithoutEnd) {
  PipedProcess silent({{"/bin/sleep", "60"}, 0, 1, log_, 0.2});
  EXPECT_THROW(silent.read_until(';'), Error);
}

TEST_F(PipedProcessTest, WhatIsntThereCantBeStarted) {
  EXPECT_THROW(PipedProcess({{"no-such-program-here"}, 0, -1, log_}), Error);
}

}  // namespace
}  // namespace sumogamma
