#pragma once

#include <optional>
#include <vector>

#include "geometry/spatial_grid.h"
#include "model/model.h"
#include "road/path.h"
#include "scene/road_state.h"
#include "scene/scene.h"
#include "scene/storey.h"

namespace sumogamma {

/// What an agent finds where it may start.
struct EntryView {
  const Model& model;
  const RoadState& road;
  const Scene& scene;
  /// Places of the first of the scene's rows; those behind them came since.
  const SpatialGrid& grid;
};

/// Speed [m/s] with which `agent` may start now where it stands, at the start of `path`, or nothing
/// where its place isn't free: it must not touch anybody, be able to stop behind whoever is ahead
/// and before the first line where something may have to be waited for, and force nobody behind it
/// to brake hard. `ground`: there. `most`: no faster than this [m/s]. `blocker`: who is looked at
/// first, and who was found to be in the way; mostly the same one still is.
std::optional<double> entry_speed(const EntryView& view, const Path& path, const AgentState& agent,
                                  const Ground& ground, double most,
                                  std::optional<AgentId>& blocker);

/// Where beside the start of its path somebody on foot may start [m, positive left]: at `liked` and
/// then, nearest first, aside of it within [`most_right`, `most_left`] and on the same side of the
/// path, away from who comes towards it.
std::vector<double> entry_offsets(double liked, double most_right, double most_left);

/// Does somebody who starts here touch a wall, or stand behind one as seen from the `middle` of its
/// way: inside a house?
bool is_walled_off(const Model& model, const AgentState& agent, const Vec2& middle);

}  // namespace sumogamma
