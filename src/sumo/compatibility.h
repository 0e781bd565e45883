#pragma once

#include <span>
#include <string_view>

namespace sumogamma {

/// What becomes of something that a scenario asks for.
enum class Treatment {
  Followed,        ///< for who GAMMA drives, too
  FollowedBySumo,  ///< SUMO does it, and it doesn't matter who drives
  Written,         ///< an output: sumo-gamma writes it, of everybody
  NotFollowed,     ///< by who GAMMA drives: said at the start of a run
  Refused,         ///< the run doesn't start
};

/// Where a row of the table stands in SUMO's files.
enum class ScenarioPart {
  Element,    ///< of route and additional files: "rerouter"
  Attribute,  ///< of an element: "stop.until"
  Parameter,  ///< <param key="..."> of a vType or vehicle
  Option,     ///< of a configuration: "time-to-teleport"; "meso-*" for all that begin so
};

/// One row of docs/compatibility.md.
struct CompatibilityRow {
  ScenarioPart part;
  std::string_view name;
  Treatment treatment;
  std::string_view note;  ///< what is done, or what isn't; may be empty
};

/// All elements of SUMO 1.15's route and additional files, all options of its configuration, and
/// the attributes that matter. A test compares it with SUMO's own schemas and with the page.
std::span<const CompatibilityRow> compatibility_table();

/// The row of a name; of an option, else, the longest one that ends in * and fits. Null where there
/// is none.
const CompatibilityRow* find_compatibility(ScenarioPart part, std::string_view name);

/// "followed", "followed by SUMO", "written by sumo-gamma", "not followed", "refused".
std::string_view name_of(Treatment treatment);

}  // namespace sumogamma
