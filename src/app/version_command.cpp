#include <proj.h>
#include <spdlog/version.h>
#include <toml++/toml.h>
#include <zlib.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <osmium/version.hpp>
#include <pugixml.hpp>
#include <string>

#include "app/command.h"
#include "base/error.h"
#include "base/print.h"
#include "base/subprocess.h"

namespace sumogamma {

namespace {

/// First line of `sumo --version`, such as "Eclipse SUMO sumo Version 1.15.0"; why not, where it
/// doesn't run.
std::string sumo_version() {
  const std::filesystem::path program = find_program("sumo");
  if (program.empty()) return "not found, install the package sumo";
  ProcessRequest request;
  request.arguments = {program.string(), "--version"};
  request.time_limit = 30;
  try {
    const ProcessResult result = run_process(request);
    if (!result.ok()) return program.string() + ": " + describe_end(result, request.time_limit);
    return result.output.substr(0, result.output.find('\n'));
  } catch (const Error& error) {
    return error.what();
  }
}

void print_line(const char* name, const std::string& value) {
  print(stdout, "{:<14} {}\n", name, value);
}

template <typename... Numbers>
std::string dotted(Numbers... numbers) {
  std::string text;
  ((text += (text.empty() ? "" : ".") + std::to_string(numbers)), ...);
  return text;
}

int run() {
  print_line("sumo-gamma", std::string(SUMOGAMMA_VERSION) + " (commit " + SUMOGAMMA_COMMIT + ")");
  print_line("SUMO", sumo_version());
  print_line("compiler", __VERSION__);
  print_line("Eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
  print_line("libosmium", LIBOSMIUM_VERSION_STRING);
  print_line("PROJ", dotted(PROJ_VERSION_MAJOR, PROJ_VERSION_MINOR, PROJ_VERSION_PATCH));
  print_line("pugixml",
             dotted(PUGIXML_VERSION / 1000, PUGIXML_VERSION % 1000 / 10, PUGIXML_VERSION % 10));
  print_line("nlohmann-json", dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                     NLOHMANN_JSON_VERSION_PATCH));
  print_line("toml++", dotted(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH));
  print_line("CLI11", CLI11_VERSION);
  print_line("spdlog", dotted(SPDLOG_VER_MAJOR, SPDLOG_VER_MINOR, SPDLOG_VER_PATCH));
  print_line("fmt", dotted(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100));
  print_line("zlib", zlibVersion());
  return kExitDone;
}

}  // namespace

CommandRunner add_version_command(CLI::App& parent) {
  parent.add_subcommand("version",
                        "print the versions of this program, of SUMO, and of the libraries");
  return [](const CommonOptions&) { return run(); };
}

}  // namespace sumogamma
