#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

#include "app/command.h"
#include "base/error.h"

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
  std::signal(SIGPIPE, SIG_IGN);
}

int fail(const std::exception& error, int code) {
  std::fprintf(stderr, "sumo-gamma: %s\n", error.what());
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
  app.add_option("--seed", common.seed, "seed of every random draw")->capture_default_str();
  app.add_option("--threads", common.threads,
                 "threads for the model; results are the same for any number")
      ->check(CLI::Range(1u, 1024u))
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
                   add_replay_command, add_report_command, add_version_command}) {
    CommandRunner runner = add(app);
    commands.emplace_back(app.get_subcommands({}).back(), std::move(runner));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    std::fprintf(stderr, "sumo-gamma: %s; see sumo-gamma --help\n", error.what());
    return kExitBadInput;
  }
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
    return run_program(argc, argv);
  } catch (const SumoError& error) {
    return fail(error, kExitSumoFailed);
  } catch (const std::exception& error) {
    return fail(error, kExitBadInput);
  }
}
