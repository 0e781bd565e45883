#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "ego/ego_view.h"
#include "model/model.h"
#include "planning/hybrid_astar.h"
#include "road/path.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// What an ego is, where it goes and by which rules.
struct EgoTrip {
  const Model& model;
  const EgoGoal& goal;
  std::size_t row;  ///< of the scene
  bool rules;       ///< of the road hold
};

/// The ego's way round what stands in its lanes: outside of all planners, for all alike. It drives
/// along its lane path until a body that has stood for 3 s lies on that, or it is more than 1 m off
/// it; then Hybrid A* looks for a way past, back onto the lanes. Where there is none the lane path
/// stays, and the planner has to brake. With rules whoever stands may be waiting its turn: then
/// those alone are gone round that are parked or at a planned halt.
class EgoDetour {
 public:
  /// To be called once before each plan: notes who stands, and may give the ego's row another path
  /// (take_path), whose centre line a body of its type can follow, and which is back on the lanes
  /// before the goal. `period`: between calls [s].
  void look(const EgoTrip& trip, double period, Scene& scene, RoadState& road);

  int taken() const { return taken_; }    ///< ways round
  int missed() const { return missed_; }  ///< searches that found none

 private:
  void note_standing(const Scene& scene, double period);
  std::vector<OrientedBox> bodies_in_the_way(const EgoTrip& trip, const Scene& scene) const;

  std::unordered_map<std::uint32_t, double> stood_;  ///< by AgentId [s]
  std::shared_ptr<const Path> lanes_;                ///< the path without detours
  std::shared_ptr<const Path> detour_;               ///< the last path that was given
  double margin_ = 0;                                ///< that it keeps [m]
  double wait_ = 0;                                  ///< until it searches again [s]
  int taken_ = 0, missed_ = 0;
};

}  // namespace sumogamma
