#include "sumo/sumo_arguments.h"

#include <algorithm>
#include <span>
#include <sstream>
#include <utility>

#include "base/error.h"

namespace sumogamma {
namespace {

struct Option {
  std::string name;                // long name without dashes
  std::vector<std::string> words;  // as they go to SUMO
};

std::string canonical_name(const std::string& word) {
  const std::size_t begin = word.find_first_not_of('-');
  return begin == std::string::npos
             ? ""
             : long_option_name(std::string_view(word).substr(begin, word.find('=') - begin));
}

std::vector<Option> group(const std::vector<std::string>& words, const char* where) {
  std::vector<Option> options;
  for (const std::string& word : words) {
    if (is_option_word(word)) {
      options.push_back({canonical_name(word), {word}});
    } else if (options.empty()) {
      throw Error(where, "'" + word + "' is not an option of SUMO; expected --name value");
    } else {
      options.back().words.push_back(word);
    }
  }
  return options;
}

std::string number(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

struct Default {
  const char* name;
  const char* value;
  bool yields;  ///< to what the scenario's configuration says
};

// moveToXY's safe surroundings (docs/coupling.md): no teleports of held vehicles, no removal of a
// vehicle that touches one
constexpr Default kQuiet[] = {{"no-step-log", "true", true}, {"xml-validation", "never", true}};
constexpr Default kHeld[] = {{"time-to-teleport", "-1", true},
                             {"collision.action", "none", true},
                             {"pedestrian.model", "striping", false}};
// a ghost that comes a long way in a step is a warning of its own in the window
constexpr Default kShown[] = {
    {"start", "true", true}, {"quit-on-end", "true", true}, {"aggregate-warnings", "5", true}};

std::vector<std::string> default_words(const SumoArguments& wish) {
  std::vector<std::string> words;
  auto add = [&](const std::string& name, const std::string& value) {
    words.push_back("--" + name);
    words.push_back(value);
  };
  auto add_all = [&](std::span<const Default> defaults) {
    for (const Default& one : defaults)
      if (!one.yields || !wish.scenario.contains(one.name)) add(one.name, one.value);
  };
  if (!wish.config.empty()) add("configuration-file", wish.config);
  add("step-length", number(wish.step_length));
  add_all(kQuiet);
  if (!wish.plain) add_all(kHeld);
  if (wish.gui) add_all(kShown);
  // who else may come is asked of the user: one who doesn't would be waited for
  if (wish.clients > 1 || wish.scenario.contains("num-clients"))
    add("num-clients", std::to_string(wish.clients));
  // a run is its seed's
  if (is_on(wish.scenario, "random")) add("random", "false");
  return words;
}

}  // namespace

bool is_option_word(const std::string& word) {
  // "-1" is a value
  return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9') && word[1] != '.';
}

std::vector<std::string> sumo_arguments(const SumoArguments& wish) {
  const std::vector<Option> user = group(wish.user, "--sumo-options");
  for (const Option& option : user) {
    if (option.name == "remote-port" || option.name == "num-clients")
      throw Error("--sumo-options", "--" + option.name + ": give it as sumo-gamma's own option");
    if (option.name == "random")
      throw Error("--sumo-options", "--random: every run has a seed; give --seed N");
    if (option.name == "step-length")
      throw Error("--sumo-options", "--step-length: give it as sumo-gamma's own option --step");
    if (option.name == "configuration-file" && !wish.config.empty())
      throw Error("--sumo-options", "--configuration-file: name the .sumocfg as the scenario");
  }
  std::vector<Option> chosen = group(default_words(wish), "SUMO options");
  auto add = [&chosen](const Option& option) {
    const auto same = std::find_if(chosen.begin(), chosen.end(),
                                   [&](const Option& other) { return other.name == option.name; });
    if (same != chosen.end()) {
      *same = option;
    } else {
      chosen.push_back(option);
    }
  };
  for (const Option& option : group(wish.own, "SUMO options")) add(option);
  for (const Option& option : user) add(option);

  std::vector<std::string> words;
  for (const Option& option : chosen)
    words.insert(words.end(), option.words.begin(), option.words.end());
  return words;
}

std::vector<std::string> split_options(std::string_view text) {
  std::vector<std::string> words;
  bool in_word = false;
  char quote = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quote == 0 && (c == ' ' || c == '\t' || c == '\n')) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (quote == 0 && (c == '\'' || c == '"')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    } else if (c == '\\' && quote != '\'' && i + 1 < text.size()) {
      words.back().push_back(text[++i]);
    } else {
      words.back().push_back(c);
    }
  }
  if (quote != 0)
    throw Error("--sumo-options", std::string("a quote (") + quote + ") is never closed");
  return words;
}

}  // namespace sumogamma
