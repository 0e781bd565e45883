#include "sumo/scenario_inventory.h"

#include <expat.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <string_view>

#include "sumo/compatibility.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUnknown = "no element of SUMO 1.15";

/// Values that ask for what happens anyhow.
bool asks_for_nothing(std::string_view name, std::string_view value) {
  constexpr std::array<std::string_view, 9> kNothing = {
      "false", "0", "0.0", "0.00", "no", "off", "current", "center", "default"};
  if (value.empty()) return true;
  // 0 is not what these are by themselves
  if (name.starts_with("vType.lc") || name.starts_with("vType.jm")) return false;
  if (name == "vehicle.departSpeed")
    return value == "max" || value == "desired" || value == "speedLimit";
  if (name == "vehicle.insertionChecks") return value == "all";
  if (name == "pedestrian.model") return value == "striping";
  return std::find(kNothing.begin(), kNothing.end(), value) != kNothing.end();
}

class Inventory {
 public:
  Inventory(bool plain, bool with_ids) : plain_(plain), with_ids_(with_ids) {
    for (const CompatibilityRow& row : compatibility_table())
      if (row.part == ScenarioPart::Attribute)
        attributes_[row.name.substr(0, row.name.find('.'))].push_back(&row);
  }

  void read(const fs::path& file);
  void read_options(const ScenarioInput& input);
  ScenarioInventory result;

 private:
  struct Reading {
    Inventory* inventory;
    fs::path file;
    std::string name;
    int depth = 0;
  };

  void begin(Reading& reading, std::string_view element, const char** attributes);
  void look_at_attributes(const Reading& reading, std::string_view element,
                          const char** attributes);
  void gather_id(std::string_view element, const std::string& id);
  void note(const std::string& file, const std::string& what, const std::string& id,
            std::string_view why);

  bool plain_, with_ids_;
  std::map<std::string_view, std::vector<const CompatibilityRow*>> attributes_;
  std::map<std::pair<std::string, std::string>, std::size_t> places_;  ///< file and kind
  std::set<fs::path> seen_;
};

std::string_view attribute(const char** attributes, const char* name) {
  for (; *attributes != nullptr; attributes += 2)
    if (std::strcmp(attributes[0], name) == 0) return attributes[1];
  return {};
}

/// Names in an attribute, which SUMO parts by blanks or commas.
void append_names(std::string_view text, std::vector<std::string>& names) {
  constexpr std::string_view kBetween = " \t\n,";
  for (std::size_t begin = text.find_first_not_of(kBetween); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBetween, begin), text.size());
    names.emplace_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBetween, end);
  }
}

void Inventory::note(const std::string& file, const std::string& what, const std::string& id,
                     std::string_view why) {
  const auto [place, added] = places_.emplace(std::pair(file, what), result.not_followed.size());
  if (added) result.not_followed.push_back({what, id, file, 0, std::string(why)});
  ++result.not_followed[place->second].count;
}

void Inventory::gather_id(std::string_view element, const std::string& id) {
  if (element == "vType") {
    result.types.insert(id);
  } else if (element == "vehicle" || element == "trip" || element == "person" ||
             element == "container") {
    result.ids.insert(id);
  } else if (element == "flow" || element == "personFlow" || element == "containerFlow" ||
             element == "flowState") {
    result.flows.insert(id);
  }
}

void Inventory::look_at_attributes(const Reading& reading, std::string_view element,
                                   const char** attributes) {
  const auto rows = attributes_.find(element == "trip" || element == "flow" ? "vehicle" : element);
  if (rows == attributes_.end()) return;
  for (const CompatibilityRow* row : rows->second) {
    if (row->treatment != Treatment::NotFollowed) continue;
    const std::string_view rest = row->name.substr(row->name.find('.') + 1);
    const std::size_t equals = rest.find('=');
    const std::string name(rest.substr(0, equals));
    const std::string_view value = attribute(attributes, name.c_str());
    if (asks_for_nothing(row->name, value)) continue;
    if (equals != std::string_view::npos &&
        value.find(rest.substr(equals + 1)) == std::string_view::npos)
      continue;
    note(reading.name, std::string(element) + " " + std::string(rest),
         std::string(attribute(attributes, "id")), row->note);
  }
}

void Inventory::begin(Reading& reading, std::string_view element, const char** attributes) {
  // the root may have any name
  if (reading.depth++ == 0) return;
  const std::string id(attribute(attributes, "id"));
  if (with_ids_ && !id.empty()) gather_id(element, id);
  if (element == "calibrator") result.complete = false;
  if (element == "include") {
    read(reading.file.parent_path() / std::string(attribute(attributes, "href")));
    return;
  }
  if (plain_) return;
  if (element == "rerouter") append_names(attribute(attributes, "edges"), result.rerouter_edges);
  if (element == "variableSpeedSign")
    append_names(attribute(attributes, "lanes"), result.sign_lanes);
  if (element == "param") {
    const std::string_view key = attribute(attributes, "key");
    const CompatibilityRow* row = find_compatibility(ScenarioPart::Parameter, key);
    if (row != nullptr && row->treatment == Treatment::NotFollowed &&
        !asks_for_nothing(key, attribute(attributes, "value")))
      note(reading.name, "param " + std::string(key), "", row->note);
    return;
  }
  const CompatibilityRow* row = find_compatibility(ScenarioPart::Element, element);
  if (row == nullptr)
    note(reading.name, std::string(element), id, kUnknown);
  else if (row->treatment == Treatment::NotFollowed)
    note(reading.name, std::string(element), id, row->note);
  look_at_attributes(reading, element, attributes);
}

void Inventory::read(const fs::path& file) {
  if (!seen_.insert(fs::weakly_canonical(file)).second) return;
  const std::unique_ptr<gzFile_s, decltype(&gzclose)> stream(gzopen(file.c_str(), "rb"), &gzclose);
  if (!stream) return;
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), &XML_ParserFree);
  Reading reading{this, file, file.filename().string()};
  XML_SetUserData(parser.get(), &reading);
  XML_SetElementHandler(
      parser.get(),
      [](void* user, const char* element, const char** attributes) {
        auto* now = static_cast<Reading*>(user);
        now->inventory->begin(*now, element, attributes);
      },
      [](void* user, const char*) { --static_cast<Reading*>(user)->depth; });
  std::array<char, 1 << 16> chunk{};
  int count = 0;
  while ((count = gzread(stream.get(), chunk.data(), static_cast<unsigned>(chunk.size()))) > 0)
    if (XML_Parse(parser.get(), chunk.data(), count, 0) == XML_STATUS_ERROR) return;
}

void Inventory::read_options(const ScenarioInput& input) {
  for (const auto& [name, option] : input.options) {
    const CompatibilityRow* row = find_compatibility(ScenarioPart::Option, name);
    if (row == nullptr || row->treatment != Treatment::NotFollowed) continue;
    const bool of_the_run = name == "random" || name == "remote-port" || name == "num-clients";
    if ((plain_ && !of_the_run) || asks_for_nothing(name, option.value)) continue;
    note(option.on_command_line ? "--sumo-options" : input.config.filename().string(),
         "option " + name, "", row->note);
  }
}

}  // namespace

ScenarioInventory take_inventory(const ScenarioInput& input, bool plain, bool with_ids) {
  Inventory inventory(plain, with_ids);
  inventory.read_options(input);
  for (const auto* files : {&input.routes, &input.additional})
    for (const fs::path& file : *files) inventory.read(file);
  if (input.options.contains("load-state")) inventory.result.complete = false;
  return std::move(inventory.result);
}

std::string describe(const NotFollowed& item) {
  std::string text = item.count > 1 ? std::to_string(item.count) + " " + item.what : item.what;
  if (item.count == 1 && !item.first.empty()) text += " " + item.first;
  text += " in " + item.file + ": not followed";
  return item.why.empty() ? text : text + " (" + item.why + ")";
}

bool has_id(const ScenarioInventory& inventory, const std::string& id) {
  if (inventory.ids.contains(id)) return true;
  const std::size_t point = id.rfind('.');
  return point != std::string::npos && point + 1 < id.size() &&
         id.find_first_not_of("0123456789", point + 1) == std::string::npos &&
         inventory.flows.contains(id.substr(0, point));
}

}  // namespace sumogamma
