#include "sumo/scenario_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <charconv>

#include "base/error.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

/// Where an option was given, for messages.
std::string origin_of(const ScenarioInput& input, const std::string& option) {
  return input.options.at(option).on_command_line ? "--sumo-options" : input.config.string();
}

std::vector<fs::path> existing_files(const ScenarioInput& input, const std::string& option) {
  std::vector<fs::path> files = files_of(input.options, option);
  for (const fs::path& file : files)
    if (!fs::exists(file))
      throw Error(origin_of(input, option),
                  option + " names '" + file.string() + "', which does not exist");
  return files;
}

/// A whole number of SUMO's, for its seed.
std::optional<std::uint64_t> seed_of(const ScenarioInput& input) {
  const auto option = input.options.find("seed");
  if (option == input.options.end()) return std::nullopt;
  const std::string& text = option->second.value;
  std::uint64_t seed = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  if (error != std::errc() || end != text.data() + text.size())
    throw Error(origin_of(input, "seed"),
                "seed '" + text.substr(0, 40) + "' is not a whole number of at least 0");
  return seed;
}

void refuse_what_cannot_run(const ScenarioInput& input) {
  if (is_on(input.options, "mesosim"))
    throw Error(origin_of(input, "mesosim"),
                "mesosim is on: a mesoscopic SUMO has queues and no places on the road, so nothing "
                "can be driven in it; leave mesosim out");
}

void make_reachable(ScenarioInput& input) {
  input.config_for_sumo = input.config.string();
  const fs::path parent = input.config.parent_path();
  if (parent.string().find(',') == std::string::npos) return;
  const int descriptor = open(parent.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // SUMO says what is wrong
  input.folder = std::shared_ptr<const int>(new int(descriptor), [](const int* held) {
    close(*held);
    delete held;
  });
  input.config_for_sumo = "/proc/" + std::to_string(getpid()) + "/fd/" +
                          std::to_string(descriptor) + "/" + input.config.filename().string();
}

fs::path config_of(const fs::path& scenario, std::string& name) {
  if (!fs::exists(scenario))
    throw Error(scenario.string(),
                "no such scenario; give a folder made by 'sumo-gamma import' or a .sumocfg file");
  if (!fs::is_directory(scenario)) {
    name = scenario.stem().string();
    return scenario;
  }
  const fs::path config = scenario / "scenario.sumocfg";
  if (!fs::exists(config))
    throw Error(scenario.string(),
                "holds no scenario.sumocfg; make the folder with 'sumo-gamma import', or give a "
                ".sumocfg file");
  name = fs::weakly_canonical(scenario).filename().string();
  return config;
}

}  // namespace

ScenarioInput find_scenario(const fs::path& scenario, std::span<const std::string> sumo_options) {
  ScenarioInput input;
  input.config = config_of(scenario, input.name);
  if (fs::exists(input.config.parent_path() / "scenario.toml"))
    input.settings = input.config.parent_path() / "scenario.toml";

  input.options = read_sumo_configuration(input.config);
  add_command_line(sumo_options, input.options);
  refuse_what_cannot_run(input);
  const std::vector<fs::path> networks = existing_files(input, "net-file");
  if (networks.empty())
    throw Error(input.config.string(), "names no net-file, expected one in <input>");
  input.network = networks.front();
  input.routes = existing_files(input, "route-files");
  input.additional = existing_files(input, "additional-files");
  input.begin = time_of(input.options, "begin");
  input.end = time_of(input.options, "end");
  input.step_length = time_of(input.options, "step-length");
  input.seed = seed_of(input);
  make_reachable(input);
  return input;
}

}  // namespace sumogamma
