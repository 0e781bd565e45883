#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "road/path.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// The ways on that somebody seen on a lane may take, as paths, so that the rules of the road apply
/// to them: each edge that a lane of this one leads to at the next junction, with the lane changes
/// that it takes, and straight on from there. Made once for each lane and type.
class CandidateWays {
 public:
  /// The network must outlive it.
  explicit CandidateWays(const RoadNetwork& network);

  /// At least `length` [m] of way behind the junction where the network goes that far. On a
  /// junction: the ways that lead over this lane of it. Empty for who walks, off any lane for
  /// vehicles, and where nothing leads on (then there is one way: to the lane's end).
  std::span<const std::shared_ptr<const Path>> ways(const AgentType& type, AgentTypeId id,
                                                    LaneId lane);

 private:
  using Ways = std::vector<std::shared_ptr<const Path>>;

  std::vector<EdgeId> straight_on(EdgeId from, VehicleClassMask mask) const;
  void add_way(const AgentType& type, LaneId start, std::vector<EdgeId> route, Ways& ways) const;
  Ways make(const AgentType& type, LaneId lane) const;

  const RoadNetwork& network_;
  std::vector<std::vector<ConnectionId>> over_;  ///< by lane of a junction, links that lead over it
  std::map<std::pair<LaneId, AgentTypeId>, Ways> made_;
};

}  // namespace sumogamma
