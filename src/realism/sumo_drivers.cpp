#include "realism/sumo_drivers.h"

#include <fmt/format.h>

#include <sstream>

#include "realism/recorded_scene.h"

namespace sumogamma {

std::vector<std::string> sumo_arguments(const std::filesystem::path& network,
                                        const std::filesystem::path& routes,
                                        const std::string& method, std::uint64_t seed) {
  std::vector<std::string> arguments{"-n",
                                     std::filesystem::absolute(network).string(),
                                     "-r",
                                     routes.string(),
                                     "--step-length",
                                     fmt::format("{:.1f}", kScoreStep),
                                     "--seed",
                                     std::to_string(seed % 2147483647u),
                                     "--no-step-log",
                                     "--no-warnings",
                                     "--time-to-teleport",
                                     "-1",
                                     "--collision.action",
                                     "none"};
  if (method == "sumo-sublane") arguments.insert(arguments.end(), {"--lateral-resolution", "0.64"});
  return arguments;
}

void set_driver(pugi::xml_node type, const std::string& method, const std::string& speed_factor) {
  type.remove_attribute("minGap");
  type.attribute("speedFactor").set_value(speed_factor.c_str());
  type.append_attribute("carFollowModel") = method == "sumo-idm"    ? "IDM"
                                            : method == "sumo-eidm" ? "EIDM"
                                                                    : "Krauss";
}

std::string xml_text(const pugi::xml_document& document) {
  std::ostringstream text;
  document.save(text);
  return text.str();
}

}  // namespace sumogamma
