#include "sumo/net_conversion.h"

#include <array>
#include <pugixml.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "road/road_network.h"
#include "road/sumo_net_reader.h"

namespace sumogamma {

namespace fs = std::filesystem;

namespace {

constexpr std::array<const char*, 6> kLists = {"allow",       "disallow", "changeLeft",
                                               "changeRight", "vClasses", "vClass"};

bool is_foreign(const std::string& word) {
  return word != "all" && vehicle_class_from_name(word) == vehicle_class::kOther;
}

/// Takes the foreign words out of a list; false where there is none.
bool split(const char* list, std::string& kept, std::vector<std::string>& foreign) {
  kept.clear();
  foreign.clear();
  std::istringstream words(list);
  for (std::string word; words >> word;) {
    if (is_foreign(word))
      foreign.push_back(word);
    else
      kept += (kept.empty() ? "" : " ") + word;
  }
  return !foreign.empty();
}

/// Visits every list of classes; true from `visit`: its node is gone.
template <typename Visit>
void for_each_list(pugi::xml_node parent, Visit&& visit) {
  for (pugi::xml_node node = parent.first_child(); node;) {
    const pugi::xml_node next = node.next_sibling();
    for_each_list(node, visit);
    for (const char* name : kLists)
      if (node.attribute(name) && visit(node, name)) break;
    node = next;
  }
}

void load(const fs::path& network, pugi::xml_document& document) {
  const std::string content = read_maybe_gzip(network);
  const pugi::xml_parse_result parsed = document.load_buffer(content.data(), content.size());
  if (!parsed) throw Error(network.string(), std::string("not XML: ") + parsed.description());
}

/// What is left of a permission: an empty list would be one for everybody. True where the node
/// went, too.
bool set_list(pugi::xml_node node, std::string_view name, const std::string& kept) {
  const std::string text(name);
  if (!kept.empty()) {
    node.attribute(text.c_str()).set_value(kept.c_str());
  } else if (name == "disallow") {
    node.remove_attribute("disallow");
  } else if (name == "allow") {
    node.remove_attribute("allow");
    if (!node.attribute("disallow")) node.append_attribute("disallow");
    node.attribute("disallow").set_value("all");
  } else if (name == "vClasses" || name == "vClass") {
    return node.parent().remove_child(node);  // an offset or a limit for these alone
  } else {
    node.attribute(text.c_str()).set_value("ignoring");  // a class that needs no permission
  }
  return false;
}

}  // namespace

ForeignClasses find_foreign_classes(const fs::path& network) {
  pugi::xml_document document;
  load(network, document);
  ForeignClasses classes;
  classes.version = document.document_element().attribute("version").value();
  std::string kept;
  std::vector<std::string> foreign;
  for_each_list(document, [&](pugi::xml_node node, const char* name) {
    if (split(node.attribute(name).value(), kept, foreign))
      for (const std::string& word : foreign) ++classes.places[word];
    return false;
  });
  return classes;
}

void write_without_foreign_classes(const fs::path& network, const fs::path& copy) {
  pugi::xml_document document;
  load(network, document);
  std::string kept;
  std::vector<std::string> foreign;
  for_each_list(document, [&](pugi::xml_node node, const char* name) {
    return split(node.attribute(name).value(), kept, foreign) && set_list(node, name, kept);
  });
  if (!document.save_file(copy.c_str(), "  "))
    throw Error(copy.string(), "can't be written: is the disk full?");
}

std::string describe(const ForeignClasses& classes) {
  std::string text;
  for (const auto& [name, count] : classes.places)
    text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(count) + ")";
  return text;
}

}  // namespace sumogamma
