#include "app/program.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <utility>

#include "app/validators.h"

namespace sumogamma {
namespace {
volatile std::sig_atomic_t signal_seen = 0;

}  // namespace

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

bool interrupted() { return signal_seen != 0; }

void set_interrupted(bool now) { signal_seen = now ? 1 : 0; }

namespace {

/// What every command has. Returns the option of the seed.
const CLI::Option* add_common_options(CLI::App& app, CommonOptions& common) {
  app.require_subcommand(1);
  app.fallthrough();
  app.set_help_all_flag("--help-all", "help of every command");
  const CLI::Option* const seed = app.add_option("--seed", common.seed, "seed of every random draw")
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
  return seed;
}

void set_up_log(const std::string& level) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "sumo-gamma", std::make_shared<spdlog::sinks::stderr_color_sink_st>()));
  spdlog::set_level(spdlog::level::from_str(level));
  spdlog::set_pattern("%^%l%$: %v");
}

std::vector<std::string> reversed(const std::vector<std::string>& words) {
  return {words.rbegin(), words.rend()};
}

}  // namespace

int run_program(const std::vector<std::string>& words, std::FILE* out) {
  CLI::App app(
      "GAMMA traffic for Eclipse SUMO: mixed vehicles and pedestrians on any OpenStreetMap city",
      "sumo-gamma");
  CommonOptions common;
  common.out = out;
  const CLI::Option* const seed = add_common_options(app, common);
  std::vector<std::pair<CLI::App*, CommandRunner>> commands;
  for (auto add : {add_import_command, add_demand_command, add_run_command, add_scene_command,
                   add_predict_command, add_drive_command, add_batch_command, add_compare_command,
                   add_replay_command, add_report_command, add_validate_command, add_score_command,
                   add_scene_from_command, add_version_command}) {
    CommandRunner runner = add(app);
    commands.emplace_back(app.get_subcommands({}).back(), std::move(runner));
  }
  try {
    app.parse(reversed(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    throw UsageError(without_long_numbers(error.what()));
  }
  common.seed_given = seed->count() > 0;
  set_up_log(common.log_level);

  for (const auto& [command, runner] : commands)
    if (command->parsed()) return runner(common);
  return kExitBadInput;
}

RunRequest parse_run(const std::vector<std::string>& words) {
  CLI::App app("", "sumo-gamma");
  RunRequest request;
  const CLI::Option* const seed = add_common_options(app, request.common);
  add_run_options(app, request.run).get_option("--output")->required(false);
  std::vector<std::string> all = reversed(words);
  all.emplace_back("run");
  try {
    app.parse(std::move(all));
  } catch (const CLI::ParseError& error) {
    throw UsageError(without_long_numbers(error.what()));
  }
  request.common.seed_given = seed->count() > 0;
  set_up_log(request.common.log_level);
  return request;
}

}  // namespace sumogamma
