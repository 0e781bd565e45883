#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "ego/episode.h"

namespace sumogamma {

/// What an episode leaves: {"episode": a row of episodes.csv, "plans": rows of plans.csv, "timing":
/// wall times}. Columns are named in docs/ego.md.
nlohmann::ordered_json to_json(const EpisodeResult& result);

/// Of the folder of a drive: episodes/SEED.json, whole or not there.
std::filesystem::path episode_file(const std::filesystem::path& drive, std::uint64_t seed);
void write_episode(const std::filesystem::path& drive, const EpisodeResult& result);
/// Null where the episode isn't done. Throws Error naming the file where it is none.
nlohmann::ordered_json read_episode(const std::filesystem::path& drive, std::uint64_t seed);

/// Writes episodes.csv, plans.csv, timing.csv and drive.json from the episodes that are done, in
/// the order given. All but timing.csv are the same bytes for the same episodes. `settings`: of the
/// drive.
void write_drive(const std::filesystem::path& drive, const nlohmann::ordered_json& settings,
                 const std::vector<nlohmann::ordered_json>& episodes);

}  // namespace sumogamma
