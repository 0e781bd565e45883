#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// What the rules of the road remember of everybody from one tick to the next: parallel arrays, row
/// by row as in the scene. A copyable value like Scene, so that a planner can fork both. Each
/// column has one writer (named here), and is read as it stood when that one began.
struct TrafficState {
  std::vector<AgentId> id;                        ///< of the scene's rows that the others belong to
  std::vector<std::shared_ptr<const Path>> path;  ///< on which `gate` lies

  // lateral/lane_choice
  std::vector<double> passing_offset;   ///< where beside its path it means to be at present [m]
  std::vector<double> lateral_aim;      ///< on the way from where it was to there [m]
  std::vector<double> overtaking_room;  ///< over the middle of the road that it may use now [m];
                                        ///< on foot off its way, round a vehicle that stands
  std::vector<LaneId> merge_to;         ///< lane into which it has to change soon, kNoLane: none
  std::vector<double> gate;  ///< along its path, where it waits for a gap there; infinite: free

  // junction/keep_clear
  std::vector<double> keeps_clear;  ///< [s] for which it has stood because there is no room behind
                                    ///< a junction, or for others to turn
  // road_context
  std::vector<ConnectionId> halted_for;  ///< link before which it last came to a halt
  std::vector<double> halted_at;         ///< when it did [s]

  // patience
  std::vector<double> waiting_time;  ///< [s] since it last got on: creeping is none
  std::vector<double> stood_at;      ///< when it last stood [s]; -infinity: never

  // recovery/reversing
  std::vector<double> backing_left;    ///< [s] for which it still backs out
  std::vector<double> gives_way_left;  ///< [s] for which it lets others go first after that
  // recovery/lost_way
  std::vector<double> strayed;  ///< driven without getting on along its path [m]

  std::size_t size() const { return id.size(); }
};

/// Makes the rows of `traffic` those of the scene: who has left is forgotten, newcomers know
/// nothing yet, and who got another path from the world has no gate on it. Cheap where nobody came
/// or left.
void match_rows(const Scene& scene, const RoadState& road, TrafficState& traffic);

/// Goes on by another path on which the row is `along` [m] (see take_path): what it waited for on
/// the old one is forgotten.
void change_path(Path path, double along, std::size_t row, RoadState& road, Scene& scene,
                 TrafficState& traffic);

}  // namespace sumogamma
