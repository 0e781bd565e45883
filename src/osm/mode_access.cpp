#include "osm/mode_access.h"

#include <algorithm>
#include <array>
#include <optional>

namespace sumogamma::osm {
namespace {

/// A kind of motor traffic: the keys that speak of it, most specific first, and SUMO's classes.
struct Mode {
  std::string name;
  std::vector<std::string_view> keys;
  bool double_tracked = true;  ///< what motorcar=no shuts out (the sign shows a car from the front)
  std::vector<std::string> classes;
};

const std::vector<Mode>& modes() {
  static const std::vector<Mode> kModes = {
      {"motorcar",
       {"motorcar"},
       true,
       {"private", "passenger", "hov", "evehicle", "custom1", "custom2"}},
      {"taxi", {"taxi", "psv"}, true, {"taxi"}},
      {"bus", {"bus", "psv"}, true, {"bus"}},
      {"coach", {"coach", "tourist_bus"}, true, {"coach"}},
      {"goods", {"goods"}, true, {"delivery"}},
      {"hgv", {"hgv"}, true, {"truck", "trailer"}},
      {"motorcycle", {"motorcycle"}, false, {"motorcycle"}},
      {"moped", {"moped", "mofa"}, false, {"moped"}}};
  return kModes;
}

/// What a value says; nothing where the key is absent.
std::optional<bool> opens(const Tags& tags, std::string_view key) {
  const std::string& value = tag(tags, key);
  if (value.empty()) return std::nullopt;
  return value != "no" && value != "private" && value != "use_sidepath" && value != "dismount";
}

std::optional<bool> first_of(const Tags& tags, const std::vector<std::string_view>& keys) {
  for (const std::string_view key : keys)
    if (const std::optional<bool> open = opens(tags, key)) return open;
  return std::nullopt;
}

}  // namespace

ModeAccess mode_access(const Tags& tags) {
  ModeAccess access;
  const bool all_motors = first_of(tags, {"motor_vehicle", "vehicle", "access"}).value_or(true);
  const bool no_cars = !opens(tags, "motorcar").value_or(true);
  access.motors = false;
  for (const Mode& mode : modes()) {
    const std::optional<bool> own = first_of(tags, mode.keys);
    const bool open = own.value_or(all_motors && !(mode.double_tracked && no_cars));
    if (!open) access.closed.push_back(mode.name);
    if (own.value_or(false)) access.opened.push_back(mode.name);
    access.motors = access.motors || open;
  }
  access.bicycle = first_of(tags, {"bicycle", "vehicle", "access"}).value_or(true);
  access.foot = first_of(tags, {"foot", "access"}).value_or(true);
  return access;
}

const std::vector<std::string>& classes_of_mode(const std::string& mode) {
  return std::find_if(modes().begin(), modes().end(),
                      [&](const Mode& known) { return known.name == mode; })
      ->classes;
}

std::vector<std::string> motor_modes() {
  std::vector<std::string> names;
  for (const Mode& mode : modes()) names.push_back(mode.name);
  return names;
}

}  // namespace sumogamma::osm
