#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace sumogamma {

/// A key of scenario.toml and its value as TOML writes it.
struct StudySetting {
  std::string key, value;

  friend bool operator==(const StudySetting&, const StudySetting&) = default;
};

struct StudyScenario {
  std::string name;            ///< short, one of a kind within the study
  std::filesystem::path path;  ///< folder or .sumocfg
};

/// Who drives, with what set: one column of a study's table.
struct StudyVariant {
  std::string name;    ///< one of a kind within the study
  bool plain = false;  ///< SUMO drives everybody
  std::vector<StudySetting> set;
  std::vector<std::string> options;  ///< further words for `run`
};

/// Seeds are added until an interval is narrow.
struct StudyUntil {
  std::string measure;    ///< key of results.json
  double width = 0;       ///< from end to end of the interval, in the measure's unit or as a share
  bool relative = false;  ///< `width` is a share of the baseline's mean
  std::size_t most_seeds = 200;
};

/// What a study file says, with the parameters written out.
struct Study {
  std::string name, question;
  std::vector<StudyScenario> scenarios;
  std::vector<StudyVariant> variants;
  std::size_t baseline = 0;  ///< index into variants: what others are compared with
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> options;   ///< words for every `run`
  std::vector<std::string> measures;  ///< keys of results.json to show first
  std::optional<StudyUntil> until;
  unsigned threads = 1;
  double time_limit = 86400;  ///< of a run's wall time [s]
};

/// One process to be.
struct StudyRun {
  std::size_t scenario = 0, variant = 0;  ///< indices
  std::uint64_t seed = 0;
};

/// Values that a parameter takes in turn, as TOML writes them.
struct ParameterValues {
  std::string key;
  std::vector<std::string> values;
};

/// From where to where a parameter is sampled.
struct ParameterRange {
  std::string key;
  double low = 0, high = 0;
  bool whole = false;  ///< whole numbers alone
};

/// All combinations, the last parameter changing fastest. Without parameters one empty combination.
std::vector<std::vector<StudySetting>> grid_of(std::span<const ParameterValues> parameters);

/// Latin hypercube (McKay, Beckman, Conover 1979): each range is cut into `points` parts of equal
/// width, and every part of every range is met exactly once, at a random place within it; the same
/// for the same seed. Without ranges or points one empty combination.
std::vector<std::vector<StudySetting>> latin_hypercube(std::span<const ParameterRange> ranges,
                                                       std::size_t points, std::uint64_t seed);

/// Every scenario, variant and seed, seeds in the outer loop: a study that is stopped early has
/// whole pairs.
std::vector<StudyRun> runs_of(const Study& study, std::span<const std::uint64_t> seeds);

/// A text as the name of a folder: letters, digits and "-_.=+", others as "_"; never empty, at the
/// most 80 bytes, and different for different texts.
std::string folder_name(const std::string& text);

/// "runs/SCENARIO/VARIANT/SEED" below the study's folder.
std::filesystem::path folder_of(const Study& study, const StudyRun& run);

}  // namespace sumogamma
