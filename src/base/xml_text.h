#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// Appends a text as it stands in an attribute of XML, or in HTML.
void append_escaped(std::string& to, std::string_view text);
std::string escaped(std::string_view text);

/// Does a document declare entities of its own? A few lines can make gigabytes of those, or read
/// other files; nothing of SUMO's has any, and SUMO would expand them.
bool declares_entities(std::string_view document);

/// Words in an attribute, which SUMO parts by blanks or commas.
std::vector<std::string> words_of(std::string_view text);

}  // namespace sumogamma
