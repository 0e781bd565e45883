#include "sumo/scenario_inventory.h"

#include <expat.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/xml_text.h"
#include "sumo/compatibility.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kUnknown = "no element of SUMO 1.15";

/// A number of departSpeed [m/s], negative for its words.
double speed_of(std::string_view value) {
  double speed = -1.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), speed);
  return error == std::errc() && end == value.data() + value.size() ? speed : -1.0;
}

/// Values that ask for what happens anyhow.
bool asks_for_nothing(std::string_view name, std::string_view value) {
  constexpr std::array<std::string_view, 9> kNothing = {
      "false", "0", "0.0", "0.00", "no", "off", "current", "center", "default"};
  if (value.empty()) return true;
  // 0 is not what these are by themselves
  if (name.starts_with("vType.lc") || name.starts_with("vType.jm")) return false;
  if (name == "vehicle.departSpeed")
    return value == "max" || value == "desired" || value == "speedLimit" || speed_of(value) >= 0.0;
  if (name == "vehicle.insertionChecks") return value == "all";
  if (name == "pedestrian.model") return value == "striping";
  if (name == "edgeData.type") return value == "performance" || value == "traffic";
  if (name.ends_with(".probability") && value.starts_with("-1")) return true;
  if (name.ends_with("-output") || name == "netstate-dump") return is_null_output(value);
  return std::find(kNothing.begin(), kNothing.end(), value) != kNothing.end();
}

/// Elements of two names.
std::string_view usual_name(std::string_view element) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kNames = {
      {{"trip", "vehicle"},
       {"flow", "vehicle"},
       {"inductionLoop", "e1Detector"},
       {"laneAreaDetector", "e2Detector"},
       {"entryExitDetector", "e3Detector"},
       {"laneData", "edgeData"}}};
  for (const auto& [name, usual] : kNames)
    if (name == element) return usual;
  return element;
}

/// Devices of SUMO's that write into its tripinfo-output, and nowhere else.
bool writes_into_tripinfo(std::string_view name) {
  for (const char* device : {"emissions", "battery", "elechybrid"})
    if (name.find(std::string(".") + device + ".") != std::string_view::npos) return true;
  return false;
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
  /// Throws the first refusal.
  void require_right_outputs(const ScenarioInput& input) const;
  ScenarioInventory result;

 private:
  struct Reading {
    Inventory* inventory;
    fs::path file;
    std::string name;
    int depth = 0;
    bool has_entities = false;  ///< of its own
    XML_Parser parser = nullptr;
  };

  void begin(Reading& reading, std::string_view element, const char** attributes);
  void look_at_attributes(const Reading& reading, std::string_view element,
                          const char** attributes);
  void gather_id(std::string_view element, const std::string& id);
  void note(const std::string& file, const std::string& what, const std::string& id,
            std::string_view why);
  void look_at_output(const Reading& reading, std::string_view element, const CompatibilityRow* row,
                      const char** attributes);
  void look_at_param(const Reading& reading, const char** attributes);
  void add_folder(const fs::path& file);
  void refuse(const std::string& file, const std::string& what, std::string_view why,
              std::string_view instead);

  std::vector<Error> refused_, refused_with_tripinfo_;
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

void append_names(std::string_view text, std::vector<std::string>& names) {
  for (std::string& word : words_of(text)) names.push_back(std::move(word));
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
  const auto rows = attributes_.find(usual_name(element));
  if (rows == attributes_.end()) return;
  const bool is_output = attribute(attributes, "file").data() != nullptr;
  if (is_output && is_null_output(attribute(attributes, "file"))) return;
  for (const CompatibilityRow* row : rows->second) {
    if (row->treatment != Treatment::NotFollowed && row->treatment != Treatment::Refused) continue;
    const std::string_view rest = row->name.substr(row->name.find('.') + 1);
    const std::size_t equals = rest.find('=');
    const std::string name(rest.substr(0, equals));
    const std::string_view value = attribute(attributes, name.c_str());
    if (asks_for_nothing(row->name, value)) continue;
    if (equals != std::string_view::npos &&
        value.find(rest.substr(equals + 1)) == std::string_view::npos)
      continue;
    const std::string id(attribute(attributes, "id"));
    if (row->treatment == Treatment::Refused)
      refuse(reading.name, std::string(element) + " " + id + ", attribute " + name, row->note,
             "leave it out");
    else
      note(reading.name, std::string(element) + " " + std::string(rest), id, row->note);
  }
}

void Inventory::refuse(const std::string& file, const std::string& what, std::string_view why,
                       std::string_view instead) {
  Error error(file, what + " would be wrong for who GAMMA drives: " + std::string(why) + "; " +
                        std::string(instead) + ", or give --control none");
  (writes_into_tripinfo(what) ? refused_with_tripinfo_ : refused_).push_back(std::move(error));
}

void Inventory::add_folder(const fs::path& file) {
  const fs::path folder = file.parent_path();
  std::vector<fs::path>& folders = result.output_folders;
  if (std::find(folders.begin(), folders.end(), folder) == folders.end()) folders.push_back(folder);
}

/// An element with a file of its own.
void Inventory::look_at_output(const Reading& reading, std::string_view element,
                               const CompatibilityRow* row, const char** attributes) {
  for (const char* name : {"file", "dest", "output"}) {
    const std::string_view value = attribute(attributes, name);
    if (!is_null_output(value) && !is_stream_output(value))
      add_folder(output_file(value, reading.file));
  }
  const std::string_view file = attribute(attributes, "file");
  if (row == nullptr || is_null_output(file)) return;
  const std::string what = std::string(element) + " " + std::string(attribute(attributes, "id"));
  if (row->treatment == Treatment::Refused) refuse(reading.name, what, row->note, "leave it out");
  if (row->treatment != Treatment::Written) return;
  if (is_stream_output(file))
    refuse(reading.name, what, "into " + std::string(file) + " SUMO alone can write",
           "name a file");
  AskedOutput output{
      std::string(usual_name(element)), {}, {}, output_file(file, reading.file), reading.name};
  if (element == "laneData") output.what = element;
  for (const char** one = attributes; *one != nullptr; one += 2)
    output.attributes.emplace(one[0], one[1]);
  result.outputs.push_back(std::move(output));
}

void Inventory::look_at_param(const Reading& reading, const char** attributes) {
  const std::string_view key = attribute(attributes, "key");
  const CompatibilityRow* row = find_compatibility(ScenarioPart::Parameter, key);
  if (row == nullptr || asks_for_nothing(key, attribute(attributes, "value"))) return;
  if (row->treatment == Treatment::NotFollowed)
    note(reading.name, "param " + std::string(key), "", row->note);
  if (row->treatment == Treatment::Refused)
    refuse(reading.name, "param " + std::string(key), row->note, "leave it out");
}

void Inventory::begin(Reading& reading, std::string_view element, const char** attributes) {
  // the root may have any name
  if (reading.depth++ == 0) return;
  const std::string id(attribute(attributes, "id"));
  if (with_ids_ && !id.empty()) gather_id(element, id);
  if (element == "calibrator") result.complete = false;
  if (element == "WAUT") result.switches_programs = true;
  if (element == "include") {
    read(reading.file.parent_path() / std::string(attribute(attributes, "href")));
    return;
  }
  if (plain_) return;
  if (usual_name(element) == "vehicle" || element == "flowState")
    if (const double speed = speed_of(attribute(attributes, "departSpeed")); speed >= 0.0)
      result.depart_speeds[id] = speed;
  if (element == "rerouter") append_names(attribute(attributes, "edges"), result.rerouter_edges);
  if (element == "variableSpeedSign")
    append_names(attribute(attributes, "lanes"), result.sign_lanes);
  if (element == "param") {
    look_at_param(reading, attributes);
    return;
  }
  if ((element == "detEntry" || element == "detExit") && !result.outputs.empty()) {
    XmlAttributes part;
    for (const char** one = attributes; *one != nullptr; one += 2) part.emplace(one[0], one[1]);
    result.outputs.back().parts.emplace_back(element, std::move(part));
  }
  const CompatibilityRow* row = find_compatibility(ScenarioPart::Element, element);
  if (row == nullptr)
    note(reading.name, std::string(element), id, kUnknown);
  else if (row->treatment == Treatment::NotFollowed)
    note(reading.name, std::string(element), id, row->note);
  look_at_output(reading, element, row, attributes);
  look_at_attributes(reading, element, attributes);
}

void Inventory::read(const fs::path& file) {
  if (!seen_.insert(fs::weakly_canonical(file)).second) return;
  const std::unique_ptr<gzFile_s, decltype(&gzclose)> stream(gzopen(file.c_str(), "rb"), &gzclose);
  if (!stream) return;
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(nullptr), &XML_ParserFree);
  Reading reading{this, file, file.filename().string()};
  reading.parser = parser.get();
  XML_SetUserData(parser.get(), &reading);
  XML_SetEntityDeclHandler(parser.get(), [](void* user, const char*, int, const char*, int,
                                            const char*, const char*, const char*, const char*) {
    auto* now = static_cast<Reading*>(user);
    now->has_entities = true;
    XML_StopParser(now->parser, XML_FALSE);
  });
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
    if (XML_Parse(parser.get(), chunk.data(), count, 0) == XML_STATUS_ERROR) break;
  if (reading.has_entities)
    throw Error(file.string(), "declares XML entities of its own, take them out");
}

void Inventory::read_options(const ScenarioInput& input) {
  for (const auto& [name, option] : input.options) {
    const CompatibilityRow* row = find_compatibility(ScenarioPart::Option, name);
    if (row == nullptr) continue;
    const std::string where =
        option.on_command_line ? "--sumo-options" : input.config.filename().string();
    const bool of_the_run = name == "random" || name == "remote-port" || name == "num-clients";
    if ((plain_ && !of_the_run) || asks_for_nothing(name, option.value)) continue;
    const bool is_file = name.ends_with("-output") || name == "netstate-dump" || name == "log" ||
                         name == "message-log" || name == "error-log" || name.ends_with(".file") ||
                         name == "save-state.prefix" || name == "save-state.files" ||
                         name.ends_with(".output");
    if (is_file && !is_stream_output(option.value))
      for (const fs::path& file : files_of(input.options, name)) add_folder(file);
    if (row->treatment == Treatment::NotFollowed) note(where, "option " + name, "", row->note);
    // mesosim was refused already
    if (row->treatment == Treatment::Refused && name != "mesosim")
      refuse(where, "option " + name, row->note,
             name.ends_with("-output")
                 ? "leave it out, or give --sumo-options \"--" + name + " NUL\""
                 : std::string("leave it out"));
    if (row->treatment != Treatment::Written || !name.ends_with("-output")) continue;
    if (is_stream_output(option.value))
      refuse(where, "option " + name, "into " + option.value + " SUMO alone can write",
             "name a file");
    const std::vector<fs::path> files = files_of(input.options, name);
    if (!files.empty()) result.outputs.push_back({name, {}, {}, files.front(), where});
  }
}

void Inventory::require_right_outputs(const ScenarioInput& input) const {
  if (!refused_.empty()) throw Error(refused_.front());
  const auto tripinfo = input.options.find("tripinfo-output");
  const bool has_tripinfo =
      tripinfo != input.options.end() && !is_null_output(tripinfo->second.value);
  if (has_tripinfo && !refused_with_tripinfo_.empty()) throw Error(refused_with_tripinfo_.front());
  if (is_on(input.options, "human-readable-time") && !result.outputs.empty())
    throw Error(result.outputs.front().source,
                "human-readable-time: outputs that sumo-gamma writes (" +
                    result.outputs.front().what + ") have times in seconds; leave it out");
}

}  // namespace

ScenarioInventory take_inventory(const ScenarioInput& input, bool plain, bool with_ids) {
  Inventory inventory(plain, with_ids);
  inventory.read_options(input);
  for (const auto* files : {&input.routes, &input.additional})
    for (const fs::path& file : *files) inventory.read(file);
  inventory.require_right_outputs(input);
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
  return inventory.ids.contains(id) || inventory.flows.contains(flow_of(id));
}

std::string flow_of(const std::string& id) {
  const std::size_t point = id.rfind('.');
  const bool numbered = point != std::string::npos && point + 1 < id.size() &&
                        id.find_first_not_of("0123456789", point + 1) == std::string::npos;
  return numbered ? id.substr(0, point) : "";
}

}  // namespace sumogamma
