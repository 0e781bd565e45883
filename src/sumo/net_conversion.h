#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace sumogamma {

/// Vehicle classes in a network that SUMO 1.15 doesn't know, since a newer SUMO wrote it.
struct ForeignClasses {
  std::string version;                 ///< of the network file, "1.20"
  std::map<std::string, long> places;  ///< by class: permissions that name it
};

/// Finds them. Throws Error where the file can't be read.
ForeignClasses find_foreign_classes(const std::filesystem::path& network);

/// Writes a copy without them. A permission for these classes alone becomes one for nobody, not for
/// everybody. Throws Error naming the file.
void write_without_foreign_classes(const std::filesystem::path& network,
                                   const std::filesystem::path& copy);

/// "cable_car (12), drone (3)"
std::string describe(const ForeignClasses& classes);

}  // namespace sumogamma
