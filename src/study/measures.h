#pragma once

#include <span>
#include <string>
#include <string_view>

namespace sumogamma {

/// Which way a measure is better.
enum class Better : signed char { Lower = -1, Neither = 0, Higher = 1 };

/// A key of results.json for people.
struct Measure {
  std::string_view key, label, unit;
  Better better = Better::Neither;
};

/// Those that have a name, in the order in which a report shows them.
std::span<const Measure> named_measures();

/// The measure with this key: a key without a name of its own is its own label.
Measure measure_of(std::string_view key);

/// Does a key tell what was asked for rather than what came of it?
bool is_setting(std::string_view key);

/// Is a key that isn't there a count of nothing?
bool is_zero_where_absent(std::string_view key);

/// Does a key tell how fast this machine was, or how it was used, rather than what happened? These
/// differ from run to run of the same input.
bool is_about_machine(std::string_view key);

}  // namespace sumogamma
