#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "app/command.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/print.h"

namespace sumogamma {
namespace {
volatile std::sig_atomic_t signal_seen = 0;
extern "C" void remember_signal(int) {
  // a second Ctrl-C ends at once
  if (signal_seen) std::_Exit(kExitInterrupted);
  signal_seen = 1;
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

/// A number of hundreds of digits, which somebody typed, tells no more than its beginning.
std::string without_long_numbers(const std::string& text) {
  constexpr std::size_t kLongest = 30, kKept = 12;
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789", begin), text.size());
    const bool is_long = digits - begin > kLongest;
    result.append(text, begin, is_long ? kKept : digits - begin);
    if (is_long) result += "...";
    const std::size_t next = std::min(text.find_first_of("0123456789", digits), text.size());
    result.append(text, digits, next - digits);
    begin = next;
  }
  return result;
}

int fail(const std::exception& error, int code) {
  print(stderr, "sumo-gamma: {}\n", without_long_numbers(error.what()));
  return code;
}
}  // namespace

bool interrupted() { return signal_seen != 0; }

int run_program(int argc, char** argv) {
  CLI::App app(
      "GAMMA traffic for Eclipse SUMO: mixed vehicles and pedestrians on any OpenStreetMap city",
      "sumo-gamma");
  app.require_subcommand(1);
  app.fallthrough();
  app.set_help_all_flag("--help-all", "help of every command");

  CommonOptions common;
  const CLI::Option* seed = app.add_option("--seed", common.seed, "seed of every random draw")
                                ->check(whole_number(0, 9'999'999'999'999'999'999u))
                                ->capture_default_str();
  app.add_option("--threads", common.threads,
                 "threads for the model; results are the same for any number")
      ->check(whole_number(1, 1024))
      ->capture_default_str();
  app.add_option("--set", common.set, "override a key of scenario.toml: KEY=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  app.add_flag("--quiet", common.quiet, "no progress");
  app.add_option("--log", common.log_level, "trace, debug, info, warn, error or off")
      ->check(CLI::IsMember({"trace", "debug", "info", "warn", "error", "off"}))
      ->capture_default_str();

  std::vector<std::pair<CLI::App*, CommandRunner>> commands;
  for (auto add : {add_import_command, add_run_command, add_scene_command, add_predict_command,
                   add_drive_command, add_batch_command, add_compare_command, add_replay_command,
                   add_report_command, add_validate_command, add_version_command}) {
    CommandRunner runner = add(app);
    commands.emplace_back(app.get_subcommands({}).back(), std::move(runner));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    print(stderr, "sumo-gamma: {}; see sumo-gamma --help\n", without_long_numbers(error.what()));
    return kExitBadInput;
  }
  common.seed_given = seed->count() > 0;
  spdlog::set_default_logger(spdlog::stderr_color_st("sumo-gamma"));
  spdlog::set_level(spdlog::level::from_str(common.log_level));
  spdlog::set_pattern("%^%l%$: %v");

  for (const auto& [command, runner] : commands)
    if (command->parsed()) return runner(common);
  return kExitBadInput;
}

}  // namespace sumogamma

int main(int argc, char** argv) {
  using namespace sumogamma;
  install_signal_handlers();
  try {
    return flush_output(run_program(argc, argv));
  } catch (const SumoError& error) {
    return fail(error, kExitSumoFailed);
  } catch (const std::exception& error) {
    return fail(error, kExitBadInput);
  }
}
