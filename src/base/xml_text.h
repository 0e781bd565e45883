#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// Appends a text as it stands in an attribute of XML, or in HTML.
void append_escaped(std::string& escaped, std::string_view text);

/// Words in an attribute, which SUMO parts by blanks or commas.
std::vector<std::string> words_of(std::string_view text);

}  // namespace sumogamma
