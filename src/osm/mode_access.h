#pragma once

#include <string>
#include <vector>

#include "osm/osm_map.h"

namespace sumogamma::osm {

/// Who may use a road by its tags. OpenStreetMap's rule: the most specific tag holds, "bus" before
/// "psv" before "motor_vehicle" before "vehicle" before "access"; without any of them the kind of
/// road says.
struct ModeAccess {
  std::vector<std::string> closed;  ///< kinds of motor traffic that are shut out, by key ("hgv")
  std::vector<std::string> opened;  ///< those that a tag of their own lets in ("bus")
  bool motors = true;               ///< may any kind of motor traffic use it?
  bool bicycle = true, foot = true;
};

ModeAccess mode_access(const Tags& tags);

/// Names of SUMO's vehicle classes that a kind of motor traffic covers ("hgv": truck, trailer).
const std::vector<std::string>& classes_of_mode(const std::string& mode);

/// Kinds of motor traffic of mode_access(), in the order in which they are told.
std::vector<std::string> motor_modes();

}  // namespace sumogamma::osm
