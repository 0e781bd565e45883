#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "road/road.h"

namespace sumogamma {

/// The road as bytes, in this machine's own representation.
std::string archive_of(const Road& road);

/// The road that archive_of() made bytes of, to the last bit; nothing where they aren't whole.
std::optional<Road> road_of(std::string_view bytes);

}  // namespace sumogamma
