#include "sumo/sumo_arguments.h"

#include <algorithm>
#include <array>
#include <sstream>
#include <utility>

#include "base/error.h"

namespace sumogamma {
namespace {

struct Option {
  std::string name;                // long name without dashes
  std::vector<std::string> words;  // as they go to SUMO
};

// short forms and synonyms of the options that can meet ours
std::string canonical_name(const std::string& word) {
  static constexpr std::array<std::pair<const char*, const char*>, 14> kSynonyms = {{
      {"c", "configuration-file"},
      {"configuration", "configuration-file"},
      {"n", "net-file"},
      {"net", "net-file"},
      {"r", "route-files"},
      {"routes", "route-files"},
      {"a", "additional-files"},
      {"additional", "additional-files"},
      {"b", "begin"},
      {"e", "end"},
      {"W", "no-warnings"},
      {"X", "xml-validation"},
      {"S", "start"},
      {"Q", "quit-on-end"},
  }};
  const std::size_t begin = word.find_first_not_of('-');
  const std::string name =
      begin == std::string::npos ? "" : word.substr(begin, word.find('=') - begin);
  for (const auto& [synonym, full] : kSynonyms)
    if (name == synonym) return full;
  return name;
}

bool is_option(const std::string& word) {
  // "-1" is a value
  return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9') && word[1] != '.';
}

std::vector<Option> group(const std::vector<std::string>& words, const char* where) {
  std::vector<Option> options;
  for (const std::string& word : words) {
    if (is_option(word)) {
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

// moveToXY's safe surroundings (docs/coupling.md): no teleports of held vehicles, no removal of a
// vehicle that touches one
std::vector<std::string> default_words(const SumoArguments& wish) {
  std::vector<std::string> words;
  if (!wish.config.empty()) words = {"--configuration-file", wish.config};
  for (const char* word : {"--step-length", ""}) words.emplace_back(word);
  words.back() = number(wish.step_length);
  const std::vector<std::string> quiet = {"--no-step-log", "true", "--xml-validation", "never"};
  words.insert(words.end(), quiet.begin(), quiet.end());
  if (!wish.plain) {
    const std::vector<std::string> held = {
        "--time-to-teleport", "-1", "--collision.action", "none", "--pedestrian.model", "striping"};
    words.insert(words.end(), held.begin(), held.end());
  }
  if (wish.gui) {
    const std::vector<std::string> shown = {"--start", "true", "--quit-on-end", "true"};
    words.insert(words.end(), shown.begin(), shown.end());
  }
  return words;
}

}  // namespace

std::vector<std::string> sumo_arguments(const SumoArguments& wish) {
  const std::vector<Option> user = group(wish.user, "--sumo-options");
  for (const Option& option : user) {
    if (option.name == "remote-port" || option.name == "num-clients")
      throw Error("--sumo-options", "--" + option.name + " is chosen by sumo-gamma; leave it out");
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
