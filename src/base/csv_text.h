#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace sumogamma {

/// A text as a field of CSV (RFC 4180): in quotes where it holds a comma, a quote or a line's end.
inline std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char letter : text) {
    if (letter == '"') field += '"';
    field += letter;
  }
  return field + '"';
}

/// The fields of one line, quotes taken off.
inline std::vector<std::string> csv_fields(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char letter = line[k];
    if (letter == '"') {
      // two in a row within quotes stand for one
      if (quoted && k + 1 < line.size() && line[k + 1] == '"')
        fields.back() += line[++k];
      else
        quoted = !quoted;
    } else if (letter == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += letter;
    }
  }
  return fields;
}

/// One line of a table with a header.
struct CsvRow {
  const std::vector<std::string>& header;
  std::vector<std::string> fields;

  /// Empty where there is no such column.
  std::string_view text(std::string_view column) const {
    const auto found = std::find(header.begin(), header.end(), column);
    const auto at = static_cast<std::size_t>(found - header.begin());
    return at < fields.size() ? std::string_view(fields[at]) : std::string_view();
  }
  std::optional<double> number(std::string_view column) const {
    const std::string_view field = text(column);
    double value = 0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
    return value;
  }
};

/// Calls visit(CsvRow) for every line behind the first, which names the columns. Fields hold no
/// line's end.
template <typename Visit>
void visit_csv_rows(std::string_view text, Visit&& visit) {
  std::vector<std::string> header;
  for (bool first = true; !text.empty(); first = false) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (first)
      header = csv_fields(text.substr(0, end));
    else
      visit(CsvRow{header, csv_fields(text.substr(0, end))});
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

}  // namespace sumogamma
