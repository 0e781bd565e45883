#pragma once

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

namespace sumogamma {

/// Levenshtein's distance: how many letters to add, drop or change.
inline std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({change, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// Of things that have names the one whose name is nearest to a text; of equally near ones the
/// first, of none the end. `name_of(thing)` gives a name.
template <typename Range, typename NameOf>
auto nearest_named(std::string_view text, const Range& range, NameOf name_of) {
  return std::min_element(std::begin(range), std::end(range), [&](const auto& a, const auto& b) {
    return edit_distance(text, name_of(a)) < edit_distance(text, name_of(b));
  });
}

}  // namespace sumogamma
