#include "osm/repair_names.h"

#include <algorithm>

#include "base/edit_distance.h"
#include "base/error.h"
#include "osm/map_repairs.h"
#include "osm/network_repairs.h"

namespace sumogamma::osm {

std::vector<RepairName> all_repairs() {
  std::vector<RepairName> names;
  for (const MapRepair& repair : map_repairs()) names.push_back(repair.name);
  for (const NetworkRepair& repair : network_repairs()) names.push_back(repair.name);
  for (const FileRepair& repair : file_repairs()) names.push_back(repair.name);
  return names;
}

void check_names(const RepairSet& names) {
  const std::vector<RepairName> known = all_repairs();
  for (const std::string& name : names) {
    const auto nearest =
        nearest_named(name, known, [](const RepairName& repair) { return repair.name; });
    if (nearest->name != name)
      throw Error("--without " + name, "no repair of this name: did you mean " +
                                           std::string(nearest->name) +
                                           "? docs/import.md lists them");
  }
}

}  // namespace sumogamma::osm
