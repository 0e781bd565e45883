#include "sumo/sumo_process.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "base/error.h"

namespace sumogamma {
namespace {

const char* const kShell = "/bin/sh";

bool exists(pid_t pid) { return kill(pid, 0) == 0; }

TEST(SumoOutput, KeepsTheFirstErrorWithItsContinuation) {
  SumoOutput output;
  output.append("Loading...\nWarning: w1\nErr");
  output.append(
      "or: The edge 'x' is not known.\n The route can not be build.\nQuitting (on error).\n");
  output.append("Error: another\n  and more\n");
  EXPECT_EQ(output.first_error(), "The edge 'x' is not known. The route can not be build.");
  EXPECT_EQ(output.warnings(), 1);
  EXPECT_EQ(output.take_first_warnings(), std::vector<std::string>{"w1"});
  EXPECT_TRUE(output.take_first_warnings().empty());
  EXPECT_TRUE(output.contains("Quitting"));
  EXPECT_FALSE(output.contains("Success"));
}

TEST(SumoOutput, AFailedAssertionIsAnError) {
  SumoOutput output;
  output.append("sumo: ./src/microsim/MSVehicle.cpp:1: void f(): Assertion `false' failed.\n");
  EXPECT_NE(output.first_error().find("Assertion"), std::string::npos);
}

TEST(SumoOutput, StaysWithinBounds) {
  SumoOutput output;
  output.append(std::string(1 << 20, 'x'));  // a line without an end
  for (int i = 0; i < 10000; ++i) output.append("Warning: line " + std::to_string(i) + "\n");
  EXPECT_EQ(output.warnings(), 9999);  // the first one hangs on the endless line
  EXPECT_LT(output.tail().size(), 1000u);
  EXPECT_LE(output.take_first_warnings().size(), 10u);
  EXPECT_NE(output.tail().find("line 9999"), std::string::npos);
}

TEST(SumoProcess, TellsExitCodeAndOutput) {
  SumoProcess process(kShell, {"-c", "echo out; echo 'Error: bad' >&2; exit 3"});
  EXPECT_TRUE(process.wait(10));
  EXPECT_EQ(process.exit_code(), 3);
  EXPECT_EQ(process.end_description(), "exit code 3");
  EXPECT_EQ(process.output().first_error(), "bad");
  EXPECT_TRUE(process.output().contains("out"));
}

TEST(SumoProcess, TellsTheSignal) {
  SumoProcess process(kShell, {"-c", "kill -9 $$"});
  EXPECT_TRUE(process.wait(10));
  EXPECT_FALSE(process.exit_code().has_value());
  EXPECT_NE(process.end_description().find("signal 9"), std::string::npos);
}

TEST(SumoProcess, EndsPolitelyElseByForce) {
  SumoProcess polite(kShell, {"-c", "trap 'echo bye; exit 0' TERM; while :; do sleep 0.05; done"});
  SumoProcess stubborn(kShell, {"-c", "trap '' TERM; while :; do sleep 0.05; done"});
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // let them set their traps
  EXPECT_TRUE(polite.running());
  polite.terminate(10);
  EXPECT_EQ(polite.exit_code(), 0);
  EXPECT_TRUE(polite.output().contains("bye"));
  stubborn.terminate(0.2);
  EXPECT_NE(stubborn.end_description().find("signal 9"), std::string::npos);
}

TEST(SumoProcess, LeavesNoZombieAndNoOrphan) {
  pid_t pid = 0;
  {
    SumoProcess process("/bin/sleep", {"1000"});
    pid = process.pid();
    EXPECT_TRUE(exists(pid));
  }
  EXPECT_FALSE(exists(pid));
  EXPECT_EQ(waitpid(pid, nullptr, WNOHANG), -1);
}

TEST(SumoProcess, AStoppedChildIsKilledToo) {
  SumoProcess process("/bin/sleep", {"1000"});
  kill(process.pid(), SIGSTOP);
  process.terminate(0.1);
  EXPECT_FALSE(process.running());
}

// Ctrl-C reaches the foreground group: SUMO must not be in it, or it would die before we have
// written our outputs
TEST(SumoProcess, IsInItsOwnProcessGroup) {
  SumoProcess process("/bin/sleep", {"1000"});
  EXPECT_EQ(getpgid(process.pid()), process.pid());
  EXPECT_NE(getpgid(process.pid()), getpgrp());
}

TEST(SumoProcess, DiesWithItsParent) {
  int report[2];
  ASSERT_EQ(pipe(report), 0);
  const pid_t parent = fork();
  if (parent == 0) {
    SumoProcess process("/bin/sleep", {"1000"});
    const pid_t pid = process.pid();
    [[maybe_unused]] const ssize_t written = write(report[1], &pid, sizeof pid);
    raise(SIGKILL);  // no destructor runs
  }
  pid_t orphan = 0;
  ASSERT_EQ(read(report[0], &orphan, sizeof orphan), static_cast<ssize_t>(sizeof orphan));
  waitpid(parent, nullptr, 0);
  // reaped by init some time after its death: a zombie is as good as gone
  const std::string status = "/proc/" + std::to_string(orphan) + "/stat";
  bool gone = false;
  for (int i = 0; i < 100 && !gone; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    char state = 'Z';
    if (FILE* file = fopen(status.c_str(), "r")) {
      if (fscanf(file, "%*d %*s %c", &state) != 1) state = 'Z';
      fclose(file);
    }
    gone = state == 'Z' || state == 'X';
  }
  EXPECT_TRUE(gone);
  close(report[0]);
  close(report[1]);
}

TEST(SumoProcess, DoesNotInheritOurOpenFiles) {
  const int fd = open("/dev/null", O_WRONLY);  // without O_CLOEXEC, as a std::ofstream has it
  ASSERT_GE(fd, 3);
  SumoProcess process(kShell, {"-c", "for f in /proc/self/fd/*; do echo fd ${f##*/}; done"});
  EXPECT_TRUE(process.wait(10));
  EXPECT_TRUE(process.output().contains("fd 1"));
  EXPECT_FALSE(process.output().contains("fd " + std::to_string(fd) + "\n"));
  for (int other = 10; other < 64; ++other)  // the shell itself opens the low ones
    EXPECT_FALSE(process.output().contains("fd " + std::to_string(other))) << other;
  close(fd);
}

TEST(SumoProcess, ABinaryThatCannotRunIsAnError) {
  EXPECT_THROW(SumoProcess("/no/such/sumo", {}), Error);
  EXPECT_THROW(SumoProcess("/etc/passwd", {}), Error);
}

TEST(FindSumoBinary, LooksInPathAndSaysWhereElse) {
  EXPECT_EQ(find_sumo_binary(kShell), kShell);
  EXPECT_EQ(std::filesystem::path(find_sumo_binary("sh")).filename(), "sh");
  EXPECT_THROW(find_sumo_binary("no-such-sumo"), Error);
  EXPECT_THROW(find_sumo_binary("/etc"), Error);
}

TEST(FreePort, CanBeBound) {
  const int port = free_port();
  EXPECT_GT(port, 1023);
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  close(fd);
}

}  // namespace
}  // namespace sumogamma
