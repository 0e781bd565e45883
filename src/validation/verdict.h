#pragma once

#include <string>
#include <vector>

#include "study/statistics.h"
#include "validation/trial.h"

namespace sumogamma {

enum class Judgement : std::uint8_t {
  Pass,  ///< the mean over seeds lies in the band
  Note,  ///< outside a band that is empirical only
  Fail,  ///< outside, or there was nothing to measure
};

/// A criterion with what came of it.
struct Outcome {
  const Trial* trial = nullptr;
  const Criterion* criterion = nullptr;
  std::vector<double> values;  ///< by seed
  std::vector<double> sumo;    ///< likewise where SUMO drives the same; empty: nothing to compare
  Estimate estimate;           ///< of `values`
  Judgement verdict = Judgement::Fail;
};

/// Judges the values of one criterion.
Outcome judge(const Trial& trial, const Criterion& criterion, std::vector<double> values,
              std::vector<double> sumo);

/// "PASS", "NOTE", "FAIL".
std::string to_string(Judgement verdict);

/// "1,700 to 2,000", "at most 0.05".
std::string band_text(const Band& band);

/// Everything, as validate.json holds it: of each criterion the band, its source, the values, mean,
/// interval, verdict, and SUMO's mean.
std::string outcomes_json(const std::vector<Outcome>& outcomes, const std::string& version);

/// A table for a terminal or a page of Markdown.
std::string outcomes_markdown(const std::vector<Outcome>& outcomes);

/// The page: what fails first, then every trial with its question, setup and figures, each drawn on
/// its band.
std::string outcomes_html(const std::vector<Outcome>& outcomes, const std::string& version);

}  // namespace sumogamma
