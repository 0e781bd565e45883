#include "sumo/scenario_input.h"

#include <pugixml.hpp>

#include "base/error.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

/// Files of a comma-separated option value, relative to the config's folder as SUMO resolves them.
std::vector<fs::path> files_of(const fs::path& config, const pugi::xml_node& root,
                               const char* option) {
  std::vector<fs::path> files;
  // options stand inside sections such as <input> or directly below the root
  const pugi::xml_node node =
      root.find_node([&](const pugi::xml_node& n) { return std::string_view(n.name()) == option; });
  std::string value =
      node.attribute("value") ? node.attribute("value").value() : node.attribute("v").value();
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
                    std::string(option) + " names '" + file.string() + "', which does not exist");
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
  const auto networks = files_of(files.config, root, "net-file");
  if (networks.empty())
    throw Error(files.config.string(), "names no net-file, expected one in <input>");
  files.network = networks.front();
  files_of(files.config, root, "route-files");
  files.additional = files_of(files.config, root, "additional-files");
  const pugi::xml_node begin =
      root.find_node([](const pugi::xml_node& n) { return std::string_view(n.name()) == "begin"; });
  files.begin = begin.attribute("value").as_double(0.0);
  return files;
}

}  // namespace sumogamma
