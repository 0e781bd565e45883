#include "demand/vehicle_type_xml.h"

#include <fmt/format.h>

#include "demand/type_demand.h"
#include "scene/sumo_defaults.h"

namespace sumogamma {
namespace {

/// A vType's speedFactor: normal about `mean`, its deviation and bounds as shares of that.
std::string normal_factor(double mean, double deviation, double least, double most) {
  std::string text = "normc(" + fixed(mean, 3);
  for (const double share : {deviation, least, most})
    text.append(",").append(fixed(mean * share, 3));
  return text + ")";
}

}  // namespace

std::string fixed(double value, int decimals) { return fmt::format("{:.{}f}", value, decimals); }

void append_vehicle_type(pugi::xml_node root, const AgentType& type) {
  pugi::xml_node element = root.append_child("vType");
  auto set = [&](const char* key, const std::string& value) {
    element.append_attribute(key) = value.c_str();
  };
  const bool slow = has_own_pace(type);
  set("id", type.name);
  set("vClass", type.sumo_class);
  set("length", fixed(type.length));
  set("width", fixed(type.width));
  set("minGap", fixed(type.min_gap));
  // people on foot and on bicycles differ in the speed they like, others in how they take the
  // limit; SUMO tells nobody the desiredMaxSpeed of people: it stays the default, and the factor
  // says more
  const bool on_foot = type.sumo_class == "pedestrian";
  if (!on_foot) set("maxSpeed", fixed(slow ? type.preferred_speed * 1.6 : type.max_speed));
  if (slow && !on_foot) set("desiredMaxSpeed", fixed(type.preferred_speed));
  const double mean = on_foot ? type.preferred_speed / kWalkingSpeed : 1.0;
  set("speedFactor", slow ? normal_factor(mean, 0.15, 0.6, 1.5) : normal_factor(1, 0.1, 0.7, 1.3));
}

}  // namespace sumogamma
