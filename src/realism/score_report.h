#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "realism/recorded_scene.h"
#include "realism/score.h"

namespace sumogamma {

/// How a recording was read and what of it isn't scored, one line each, for people.
std::vector<std::string> scoring_notes(const RecordedScene& scene, const RecordingScore& score);

/// The table of one recording, a row a method, and one of its distributions; in Markdown.
std::string score_table(const RecordingScore& score);

/// The table of one recording's free runs, a row a method; in Markdown, empty where there are none.
std::string free_table(const RecordingScore& score);

/// Means over the recordings, a row a method; in Markdown.
std::string mean_table(std::span<const RecordingScore> scores);

/// A row for each recording, method and figure: recording,method,types,figure,value. `types` is all
/// or the name of one.
std::string score_csv(std::span<const RecordingScore> scores);

/// All figures of one recording; what isn't known is null.
nlohmann::ordered_json score_json(const RecordedScene& scene, const RecordingScore& score);

}  // namespace sumogamma
