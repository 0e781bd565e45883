#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sumogamma {

/// One line of a file of SUMO's, which writes an element a line.
struct XmlLine {
  std::string text;     ///< the whole line, without its end
  std::string element;  ///< its tag; empty for what is no start of an element
  std::vector<std::pair<std::string, std::string>> attributes;  ///< in order, not escaped
  bool closed = false;                                          ///< "/>": it has no children

  /// The value of an attribute; empty where there is none.
  std::string_view get(std::string_view name) const;
  bool has(std::string_view name) const;
  /// Sets an attribute that is there; others are left out, as SUMO was told.
  void set(std::string_view name, std::string value);
  /// A number in an attribute; `otherwise` where it is none.
  double number(std::string_view name, double otherwise = 0) const;
};

/// What becomes of a line.
enum class LineFate {
  Keep,
  Rewrite,  ///< from element and attributes
  Drop,     ///< and what is in it
};

XmlLine parse_line(std::string text);
/// The line again, indented as it was.
std::string text_of(const XmlLine& line);

/// Copies a file of SUMO's line by line, gzipped or not as its name says; `change` sees each start
/// of an element and may change its attributes. A file that SUMO didn't end is ended where its last
/// whole line does. Nothing where there is no such file. Throws Error naming the file.
void copy_lines(const std::filesystem::path& from, const std::filesystem::path& to,
                const std::function<LineFate(XmlLine&)>& change);

/// Shows each start of an element of a file to `look`. Nothing where there is no such file.
void visit_lines(const std::filesystem::path& file,
                 const std::function<void(const XmlLine&)>& look);

}  // namespace sumogamma
