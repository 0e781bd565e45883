#pragma once

#include <optional>
#include <string_view>

namespace sumogamma {

/// A time as SUMO writes and reads it: seconds ("90", "0.5"), h:m:s ("0:01:30") or d:h:m:s; blanks
/// around it don't matter. [s]; empty for anything else, not finite numbers included.
std::optional<double> parse_time(std::string_view text);

}  // namespace sumogamma
