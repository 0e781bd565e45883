#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

#include "app/program.h"
#include "base/error.h"
#include "base/print.h"

namespace sumogamma {
namespace {

extern "C" void remember_signal(int) {
  // a second Ctrl-C ends at once
  if (interrupted()) std::_Exit(kExitInterrupted);
  set_interrupted(true);
}

void install_signal_handlers() {
  struct sigaction action = {};
  action.sa_handler = remember_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // unless it is to be ignored, as under nohup
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

/// What is still in buffers must get out, or the run has failed: a full disk, a closed pipe.
int flush_output(int code) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  print(stderr, "sumo-gamma: standard output: can't be written ({})\n", std::strerror(errno));
  return code == kExitDone ? kExitBadInput : code;
}

int fail(const std::exception& error, int code) {
  print(stderr, "sumo-gamma: {}\n", without_long_numbers(error.what()));
  return code;
}
}  // namespace
}  // namespace sumogamma

int main(int argc, char** argv) {
  using namespace sumogamma;
  install_signal_handlers();
  try {
    const std::vector<std::string> words(argv + (argc > 0 ? 1 : 0), argv + argc);
    return flush_output(run_program(words));
  } catch (const SumoError& error) {
    return fail(error, kExitSumoFailed);
  } catch (const std::exception& error) {
    return fail(error, kExitBadInput);
  }
}
