#pragma once

#include <vector>

#include "road/road_network.h"

namespace sumogamma::osm {

/// What counts as lying on each other, for those who look for it and those who mend it.
namespace lane_overlap {
inline constexpr double kTolerance = 0.3;   ///< [m] of overlap that is no harm
inline constexpr double kShortest = 8.0;    ///< [m] of overlap that matters
inline constexpr double kAlong = 0.8;       ///< least |cos| of the angle between two edges
inline constexpr double kSameHeight = 4.0;  ///< [m]; what lies further above is apart
}  // namespace lane_overlap

/// True within 3 m of an end of an edge at which another edge ends, too: nothing counts there.
/// Metres along the edge.
bool at_shared_junction(const Edge& edge, const Edge& other, double from_begin, double to_end);

/// A stretch of one lane that lies on a lane of another edge.
struct LaneOverlap {
  LaneId lane = kNoLane;    ///< whose stretch it is
  LaneId other = kNoLane;   ///< on which it lies
  double from = 0, to = 0;  ///< [m] along the lane's centerline
  double depth = 0;         ///< [m] by which the two strips overlap, at most
};

/// What a lane is for: who has a body of metres there, and who can step aside.
enum class LaneUse : std::uint8_t { Walking, Cycling, Driving };

/// Driving where any motor vehicle may use the lane, Cycling where bicycles may, else Walking.
LaneUse lane_use(const Lane& lane);

/// True for pairs that must not lie on each other: two for wheels, or any with one for driving.
/// People on foot share ground with each other and, as in the street, with bicycles.
inline bool must_be_apart(LaneUse a, LaneUse b) {
  return a == LaneUse::Driving || b == LaneUse::Driving ||
         (a == LaneUse::Cycling && b == LaneUse::Cycling);
}

/// Stretches longer than 8 m on which lanes of different normal edges run along each other (within
/// 37 degrees of the same or the opposite direction), at less than 4 m difference in height, and
/// share more than 0.3 m of their widths. Looked at every 2 m; within 3 m of a junction that both
/// edges touch nothing counts. Only pairs that must be apart, each listed from both sides; by lane,
/// then other, then from.
std::vector<LaneOverlap> find_lane_overlaps(const RoadNetwork& road);

/// Metres of lane that lie on other lanes; where several lie on one stretch it counts once.
struct OverlapLength {
  double wheels = 0;      ///< [m] lanes for driving or cycling on lanes for driving or cycling
  double walking = 0;     ///< [m] lanes for walking on lanes for driving
  double all_wheels = 0;  ///< [m] all lanes for driving or cycling, for comparison
};
OverlapLength overlap_length(const RoadNetwork& road, const std::vector<LaneOverlap>& overlaps);

}  // namespace sumogamma::osm
