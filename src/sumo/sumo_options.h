#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// An option as SUMO was told it.
struct SumoOption {
  std::string value;
  std::filesystem::path
      base;  ///< what relative file names in it are relative to; empty: where we are
  bool on_command_line = false;  ///< else from the configuration
};

/// By long name ("net-file"), whatever short name or synonym was used.
using SumoOptions = std::map<std::string, SumoOption>;

/// Long name of an option of SUMO without dashes: "net-file" for "n", "net" and "net-file".
std::string long_option_name(std::string_view name);

/// The options of a .sumocfg as SUMO reads them: any root, sections or none, nested or not,
/// `value`, `v` or text, ${VAR} replaced by the environment. Throws Error naming the file where it
/// is missing, no XML, or sets an option twice (which SUMO refuses, too).
SumoOptions read_sumo_configuration(const std::filesystem::path& config);

/// The options of a command line ("--name", "value", "--name=value", "-n", "value"); they win over
/// what stands in `options`.
void add_command_line(std::span<const std::string> words, SumoOptions& options);

/// Files that an option names: separated by commas, blanks around them dropped, %20 and the like
/// decoded, relative to where the option was given; SUMO's FileHelpers. Empty where it isn't set.
std::vector<std::filesystem::path> files_of(const SumoOptions& options, const std::string& name);

/// A switch: SUMO's "true", "1", "yes", "on", "x", "t" in any case; false where it isn't set.
bool is_on(const SumoOptions& options, const std::string& name);

/// A time [s], empty where it isn't set. Throws Error naming the option where it is no time.
std::optional<double> time_of(const SumoOptions& options, const std::string& name);

}  // namespace sumogamma
