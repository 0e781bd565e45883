#include "study/study_plan.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

#include "base/hash.h"
#include "base/number_text.h"
#include "base/random.h"

namespace sumogamma {

std::vector<std::vector<StudySetting>> grid_of(std::span<const ParameterValues> parameters) {
  std::vector<std::vector<StudySetting>> combinations{{}};
  for (const ParameterValues& parameter : parameters) {
    std::vector<std::vector<StudySetting>> longer;
    for (const std::vector<StudySetting>& begun : combinations)
      for (const std::string& value : parameter.values) {
        longer.push_back(begun);
        longer.back().push_back({parameter.key, value});
      }
    combinations = std::move(longer);
  }
  return combinations;
}

namespace {

/// Fisher and Yates, by draws of our own.
std::vector<std::size_t> shuffled(std::size_t count, std::uint64_t seed, std::uint64_t stream) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t left = count; left > 1; --left) {
    const double draw = random_uniform(seed, stream, left, Draw::StudyDesign);
    std::swap(order[left - 1], order[static_cast<std::size_t>(draw * static_cast<double>(left))]);
  }
  return order;
}

}  // namespace

std::vector<std::vector<StudySetting>> latin_hypercube(std::span<const ParameterRange> ranges,
                                                       std::size_t points, std::uint64_t seed) {
  if (ranges.empty() || points == 0) return {{}};
  std::vector<std::vector<StudySetting>> combinations(points);
  for (std::size_t axis = 0; axis < ranges.size(); ++axis) {
    const ParameterRange& range = ranges[axis];
    const std::vector<std::size_t> part = shuffled(points, seed, 2 * axis);
    for (std::size_t point = 0; point < points; ++point) {
      const double within = random_uniform(seed, 2 * axis + 1, point, Draw::StudyDesign);
      const double share =
          (static_cast<double>(part[point]) + within) / static_cast<double>(points);
      const double value =
          range.whole
              ? std::min(std::floor(range.low + share * (range.high - range.low + 1.0)), range.high)
              : range.low + share * (range.high - range.low);
      std::string text = number_text(value);
      // a whole number is another type in TOML
      if (!range.whole && text.find_first_of(".en") == std::string::npos) text += ".0";
      combinations[point].push_back({range.key, text});
    }
  }
  return combinations;
}

std::vector<StudyRun> runs_of(const Study& study, std::span<const std::uint64_t> seeds) {
  std::vector<StudyRun> runs;
  for (const std::uint64_t seed : seeds)
    for (std::size_t scenario = 0; scenario < study.scenarios.size(); ++scenario)
      for (std::size_t variant = 0; variant < study.variants.size(); ++variant)
        runs.push_back({scenario, variant, seed});
  return runs;
}

std::string folder_name(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  std::string name;
  for (const char letter : text) {
    const bool fits = std::isalnum(static_cast<unsigned char>(letter)) ||
                      std::string_view("-_.=+").find(letter) != std::string_view::npos;
    name += fits ? letter : '_';
  }
  if (name.size() > kLongest) name.resize(kLongest);
  const bool hidden = name.empty() || name.front() == '.';
  if (name != text || hidden) name = (hidden ? "_" : "") + name + "-" + hash_text(fnv1a(text));
  return name;
}

std::filesystem::path folder_of(const Study& study, const StudyRun& run) {
  return std::filesystem::path("runs") / folder_name(study.scenarios[run.scenario].name) /
         folder_name(study.variants[run.variant].name) / std::to_string(run.seed);
}

}  // namespace sumogamma
