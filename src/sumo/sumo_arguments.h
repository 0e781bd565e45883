#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "sumo/sumo_options.h"

namespace sumogamma {

/// What the command line of a SUMO depends on.
struct SumoArguments {
  std::string config;         ///< the .sumocfg
  double step_length = 0.05;  ///< [s]
  bool gui = false;           ///< sumo-gui: start at once, quit at the end
  bool plain = false;    ///< --control none: SUMO's own rules for teleports and collisions stay as
                         ///< the config has them
  int clients = 1;       ///< of TraCI, us included, that SUMO waits for
  SumoOptions scenario;  ///< what the .sumocfg sets: defaults of ours give way to it
  std::vector<std::string> own;   ///< further options of ours, "--name", "value" or "--name=value"
  std::vector<std::string> user;  ///< the user's, as split_options() gives them; they win
};

/// The argument list for SUMO, without the binary. SUMO refuses an option given twice, so every
/// option occurs once: the user's, else `own`, else the default. Throws Error where the user gives
/// an option that sumo-gamma must choose.
std::vector<std::string> sumo_arguments(const SumoArguments& wish);

/// "--name" or "-n", not a value such as "-1".
bool is_option_word(const std::string& word);

/// Splits "--a 1 --b 'two words'" at blanks; single and double quotes and backslashes as in a
/// shell. Throws Error at an open quote.
std::vector<std::string> split_options(std::string_view text);

}  // namespace sumogamma
