#pragma once

#include <functional>
#include <optional>

#include "app/run_setup.h"
#include "ego/ego_start.h"
#include "ego/episode.h"
#include "ego/external_ego.h"

namespace sumogamma {

/// What the episodes of a drive have in common.
struct Drive {
  RunPlan plan;
  EgoSettings settings;
  std::unique_ptr<Simulation> sim;
  AgentTypeTable types;                    ///< before the first episode
  std::vector<KinematicTable> kinematics;  ///< likewise
  std::unique_ptr<ExternalEgo> external;   ///< null: a planner in the box
  std::filesystem::path replay;            ///< of the episode: a folder; empty: none
  /// The way that GAMMA makes on a seed, as far as it is known [m].
  std::function<std::optional<double>(std::uint64_t seed)> reference;
};

/// The id in SUMO of an ego that is no vehicle of the demand.
inline constexpr const char* kEgoId = "sumo-gamma.ego";
/// Of the vType of such an ego: its own, whatever the demand calls its types.
inline constexpr const char* kEgoTypeId = "sumo-gamma.ego";

/// The page that shows an episode.
std::filesystem::path replay_page(const std::filesystem::path& folder, std::uint64_t seed);

/// One episode from the start of SUMO to its end; nothing where the user interrupted it. Throws
/// SumoError where SUMO fails, and Error where no start has room or the ego can't be driven.
std::optional<EpisodeResult> run_episode(Drive& drive, std::uint64_t seed);

}  // namespace sumogamma
