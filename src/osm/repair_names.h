#pragma once

#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace sumogamma::osm {

/// What an import mends by itself, under the name by which it can be told not to.
struct RepairName {
  std::string_view name;
  std::string_view mends;  ///< what is wrong without it
};

/// Names of repairs.
using RepairSet = std::set<std::string, std::less<>>;

/// All repairs in the order in which they run.
std::vector<RepairName> all_repairs();

/// Throws Error for a name that no repair has, with the nearest one that one has.
void check_names(const RepairSet& names);

}  // namespace sumogamma::osm
