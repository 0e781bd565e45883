#include "sumo/scenario_input.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <pugixml.hpp>

#include "base/error.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

/// Value of an option by any of its names; empty where it isn't set. Options stand inside sections
/// such as <input> or directly below the root.
std::string value_of(const pugi::xml_node& root, std::initializer_list<std::string_view> names) {
  const pugi::xml_node node = root.find_node([&](const pugi::xml_node& n) {
    return std::find(names.begin(), names.end(), n.name()) != names.end();
  });
  return node.attribute("value") ? node.attribute("value").value() : node.attribute("v").value();
}

/// A time in plain seconds; `otherwise` where there is none or it is written in another way.
double seconds_of(const std::string& value, double otherwise) {
  char* end = nullptr;
  const double seconds = std::strtod(value.c_str(), &end);
  return end != value.c_str() && *end == '\0' && std::isfinite(seconds) ? seconds : otherwise;
}

/// Files of a comma-separated option value, relative to the config's folder as SUMO resolves them.
std::vector<fs::path> files_of(const fs::path& config, const std::string& option,
                               const std::string& value) {
  std::vector<fs::path> files;
  for (std::size_t start = 0; start < value.size();) {
    const std::size_t end = std::min(value.find(',', start), value.size());
    std::string name = value.substr(start, end - start);
    name.erase(0, name.find_first_not_of(" \t\n"));
    name.erase(name.find_last_not_of(" \t\n") + 1);
    if (!name.empty()) {
      const fs::path file =
          fs::path(name).is_absolute() ? fs::path(name) : config.parent_path() / name;
      if (!fs::exists(file))
        throw Error(config.string(),
                    option + " names '" + file.string() + "', which does not exist");
      files.push_back(file);
    }
    start = end + 1;
  }
  return files;
}

}  // namespace

ScenarioInput find_scenario(const fs::path& scenario) {
  ScenarioInput files;
  if (!fs::exists(scenario))
    throw Error(scenario.string(),
                "no such scenario; give a folder made by 'sumo-gamma import' or a .sumocfg file");
  if (fs::is_directory(scenario)) {
    files.config = scenario / "scenario.sumocfg";
    if (!fs::exists(files.config))
      throw Error(scenario.string(),
                  "holds no scenario.sumocfg; make the folder with 'sumo-gamma import', or give a "
                  ".sumocfg file");
    files.name = fs::weakly_canonical(scenario).filename().string();
  } else {
    files.config = scenario;
    files.name = scenario.stem().string();
  }
  if (fs::exists(files.config.parent_path() / "scenario.toml"))
    files.settings = files.config.parent_path() / "scenario.toml";

  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_file(files.config.c_str());
  if (!parsed)
    throw Error(files.config.string(), std::string("not a SUMO configuration: ") +
                                           parsed.description() + " at byte " +
                                           std::to_string(parsed.offset));
  const pugi::xml_node root = document.document_element();
  const auto networks =
      files_of(files.config, "net-file", value_of(root, {"net-file", "net", "n"}));
  if (networks.empty())
    throw Error(files.config.string(), "names no net-file, expected one in <input>");
  files.network = networks.front();
  files_of(files.config, "route-files", value_of(root, {"route-files", "routes", "r"}));
  files.additional = files_of(files.config, "additional-files",
                              value_of(root, {"additional-files", "additional", "a"}));
  files.begin = seconds_of(value_of(root, {"begin", "b"}), 0.0);
  files.end = seconds_of(value_of(root, {"end", "e"}), -1.0);
  return files;
}

}  // namespace sumogamma
