#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "prediction/evaluation.h"
#include "prediction/predictor_parameters.h"

namespace sumogamma {

/// Figures published for a recording, to stand beside ours; marked as published in every table.
struct PublishedResult {
  std::string_view set, method;
  double average = 0, final = 0;
};
/// Deterministic and best-of-20 rows of the paper's tables (protocol A for GAMMA; the data-driven
/// methods as their papers have it).
std::span<const PublishedResult> published_results();

/// Everything of one evaluation: summary with bootstrap intervals over agents, differences to the
/// best simple baseline among `evaluations`, per class, per speed band, collisions, time, and of
/// samples their calibration by class, speed band and step.
nlohmann::ordered_json to_json(const Evaluation& evaluation,
                               const std::vector<Evaluation>& evaluations, std::uint64_t seed);

/// Lines of a table of evaluations, one row a method, grouped by recording, with the published rows
/// below.
std::string to_table(const std::vector<Evaluation>& evaluations, const Protocol& protocol,
                     std::uint64_t seed);

/// How often the truth lies in the samples' 50 and 90 % regions, by recording, method, class, speed
/// band and step [of 100].
std::string calibration_table(const std::vector<Evaluation>& evaluations);

}  // namespace sumogamma
