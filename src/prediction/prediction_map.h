#pragma once

#include <string>
#include <vector>

#include "prediction/track_set.h"
#include "road/lane_locator.h"
#include "road/road_network.h"

namespace sumogamma {

/// An agent whose point is farther than this from the surface of the lanes that admit it isn't on
/// them [m].
inline constexpr double kOffLane = 0.5;
/// Whose way is farther from a lane's direction than this isn't going its way [degrees].
inline constexpr double kAlongLane = 60.0;

/// A network under a recording. The network must outlive it.
struct PredictionMap {
  std::string name;                      ///< of the file, for messages
  const RoadNetwork* network = nullptr;  ///< never null where a map is given
  Vec2 offset = Vec2::Zero();  ///< added to the recording's positions gives the network's [m]
  int first_frame = 0;         ///< of the recording: its signals' time 0
  std::vector<bool> recorded;  ///< by signal: its program is what was recorded, from the
                               ///< recording's first frame on; others tell nothing
};

/// How vehicles of a recording lie on a map.
struct MapFit {
  std::size_t wheeled = 0;  ///< agents on wheels
  std::size_t on_map = 0;   ///< of these: at half of their frames or more they are on a lane
};

/// Lanes that an agent on wheels is on at a point of the network [m], going that way [rad]: all on
/// whose surface it is, or else the nearest within kOffLane. Those that don't admit its class, run
/// more than kAlongLane from its heading or are for people alone don't count. Into `hits`, cleared
/// first; none for who walks.
void find_lanes_under(const LaneLocator& locator, const RoadNetwork& network, const AgentType& type,
                      const Vec2& point, double heading, std::vector<LaneHit>& hits);

/// Counts who lies on the map. For messages alone: it looks at whole tracks.
MapFit fit_of(const PredictionMap& map, const TrackSet& set);

/// The same, but throws Error naming the map where nobody is on wheels in the recording, or nobody
/// lies on it: with the corners of both and the offset that would bring their middles together.
MapFit check_fit(const PredictionMap& map, const TrackSet& set);

}  // namespace sumogamma
