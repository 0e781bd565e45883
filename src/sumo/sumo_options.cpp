#include "sumo/sumo_options.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <pugixml.hpp>
#include <utility>

#include "base/error.h"
#include "base/time_text.h"
#include "base/xml_text.h"
#include "sumo/sumo_arguments.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\n\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) + 1 - first);
}

/// ${NAME} by the environment's value, nothing where it has none.
std::string with_environment(std::string_view text) {
  std::string result;
  while (true) {
    const std::size_t begin = text.find("${");
    const std::size_t end = begin == std::string_view::npos ? begin : text.find('}', begin);
    if (end == std::string_view::npos) return result.append(text);
    const std::string name(text.substr(begin + 2, end - begin - 2));
    const char* value = std::getenv(name.c_str());
    result.append(text.substr(0, begin)).append(value != nullptr ? value : "");
    text.remove_prefix(end + 1);
  }
}

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string url_decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int high = text[i] == '%' && i + 2 < text.size() ? hexadecimal(text[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(text[i + 2]) : -1;
    if (low >= 0) {
      result.push_back(static_cast<char>(16 * high + low));
      i += 2;
    } else {
      result.push_back(text[i]);
    }
  }
  return result;
}

/// What an element says as an option: its attribute, else the text in it.
std::string option_text(const pugi::xml_node& node) {
  for (const char* name : {"value", "v"})
    if (*node.attribute(name).value() != '\0') return node.attribute(name).value();
  return std::string(trimmed(node.child_value()));
}

void add_nodes(const pugi::xml_node& parent, const fs::path& config, SumoOptions& options) {
  for (const pugi::xml_node node : parent.children()) {
    if (node.type() != pugi::node_element) continue;
    const std::string text = option_text(node);
    if (!text.empty()) {
      const std::string name = long_option_name(node.name());
      const SumoOption option{with_environment(text), config.parent_path(), false};
      if (!options.emplace(name, option).second)
        throw Error(config.string(), "sets the option " + name + " twice, leave one of them out");
    }
    add_nodes(node, config, options);
  }
}

}  // namespace

std::string long_option_name(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 50> kSynonyms = {{
      {"c", "configuration-file"},
      {"configuration", "configuration-file"},
      {"C", "save-configuration"},
      {"n", "net-file"},
      {"net", "net-file"},
      {"r", "route-files"},
      {"routes", "route-files"},
      {"a", "additional-files"},
      {"additional", "additional-files"},
      {"w", "weight-files"},
      {"weights", "weight-files"},
      {"x", "weight-attribute"},
      {"measure", "weight-attribute"},
      {"b", "begin"},
      {"e", "end"},
      {"s", "route-steps"},
      {"v", "verbose"},
      {"W", "no-warnings"},
      {"X", "xml-validation"},
      {"l", "log"},
      {"t", "duration-log.statistics"},
      {"g", "gui-settings-file"},
      {"S", "start"},
      {"Q", "quit-on-end"},
      {"G", "game"},
      {"d", "delay"},
      {"B", "breakpoints"},
      {"D", "demo"},
      {"H", "human-readable-time"},
      {"log-file", "log"},
      {"ndump", "netstate-dump"},
      {"netstate", "netstate-dump"},
      {"netstate-output", "netstate-dump"},
      {"summary", "summary-output"},
      {"tripinfo", "tripinfo-output"},
      {"vehroutes", "vehroute-output"},
      {"vehroutes.exit-times", "vehroute-output.exit-times"},
      {"vehroutes.last-route", "vehroute-output.last-route"},
      {"vehroutes.sorted", "vehroute-output.sorted"},
      {"vehroutes.dua", "vehroute-output.dua"},
      {"vehroutes.intended-depart", "vehroute-output.intended-depart"},
      {"vehroutes.route-length", "vehroute-output.route-length"},
      {"personroutes", "personroute-output"},
      {"statistics-output", "statistic-output"},
      {"device.ssm.knownveh", "device.ssm.explicit"},
      {"device.emissions.knownveh", "device.emissions.explicit"},
      {"device.battery.knownveh", "device.battery.explicit"},
      {"device.elechybrid.knownveh", "device.elechybrid.explicit"},
      {"device.rerouting.knownveh", "device.rerouting.explicit"},
      {"device.routing.period", "device.rerouting.period"},
  }};
  for (const auto& [synonym, full] : kSynonyms)
    if (name == synonym) return std::string(full);
  return std::string(name);
}

SumoOptions read_sumo_configuration(const fs::path& config) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed =
      document.load_file(config.c_str(), pugi::parse_default | pugi::parse_doctype);
  if (!parsed)
    throw Error(config.string(), std::string("not a SUMO configuration: ") + parsed.description() +
                                     " at byte " + std::to_string(parsed.offset));
  for (const pugi::xml_node& node : document)
    if (node.type() == pugi::node_doctype && declares_entities(node.value()))
      throw Error(config.string(), "declares XML entities of its own, take them out");
  SumoOptions options;
  add_nodes(document.document_element(), config, options);
  return options;
}

void add_command_line(std::span<const std::string> words, SumoOptions& options) {
  std::string open;
  for (const std::string& word : words) {
    if (!is_option_word(word)) {
      if (!open.empty()) options[open].value = word;
      open.clear();
      continue;
    }
    const std::size_t dashes = word.find_first_not_of('-');
    const std::size_t equals = word.find('=');
    open = long_option_name(
        dashes == std::string::npos ? "" : std::string_view(word).substr(dashes, equals - dashes));
    // a switch without a value is on
    options[open] = {equals == std::string::npos ? "true" : word.substr(equals + 1), {}, true};
    if (equals != std::string::npos) open.clear();
  }
}

std::vector<fs::path> files_of(const SumoOptions& options, const std::string& name) {
  std::vector<fs::path> files;
  const auto option = options.find(name);
  if (option == options.end()) return files;
  const std::string_view value = option->second.value;
  for (std::size_t start = 0; start <= value.size();) {
    const std::size_t end = std::min(value.find(',', start), value.size());
    const std::string file = url_decoded(trimmed(value.substr(start, end - start)));
    if (!file.empty()) files.push_back(option->second.base / file);
    start = end + 1;
  }
  return files;
}

bool is_on(const SumoOptions& options, const std::string& name) {
  const auto option = options.find(name);
  if (option == options.end()) return false;
  std::string word = option->second.value;
  std::transform(word.begin(), word.end(), word.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  constexpr std::array<std::string_view, 6> kYes = {"true", "1", "yes", "on", "x", "t"};
  return std::find(kYes.begin(), kYes.end(), word) != kYes.end();
}

std::optional<double> time_of(const SumoOptions& options, const std::string& name) {
  const auto option = options.find(name);
  if (option == options.end()) return std::nullopt;
  const std::optional<double> time = parse_time(option->second.value);
  if (!time)
    throw Error(name + " " + option->second.value,
                "is no time, expected seconds, h:m:s or d:h:m:s");
  return time;
}

}  // namespace sumogamma
