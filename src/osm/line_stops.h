#pragma once

#include <span>
#include <utility>
#include <vector>

#include "osm/geo_projection.h"
#include "osm/line_ways.h"
#include "road/public_transport.h"
#include "road/road_network.h"

namespace sumogamma::osm {

/// Puts stops of a map onto lanes, each once for each lane that it is served on, and two that come
/// to lie on each other as one.
class StopPlacer {
 public:
  StopPlacer(const RoadNetwork& road, const GeoProjection& projection)
      : road_(road), projection_(projection) {}

  /// The stops of a line along one of its routes, in the order of travel. `in_order`: they stand in
  /// that order; else they are put into it, and those beside the road on the side of oncoming
  /// traffic are the other direction's. Stops farther than 25 m from the route are left out, and
  /// those of which no lane nearby has room for a bus.
  std::vector<ServedStop> along(std::span<const EdgeId> route, const std::vector<LineStop>& stops,
                                bool in_order);

  std::vector<BusStop> take() { return std::move(placed_); }

 private:
  struct Spot;
  std::vector<Spot> spots_near(std::span<const EdgeId> route, const LineStop& stop,
                               bool kerb_only) const;
  std::size_t stop_at(const Spot& spot, const LineStop& stop);

  const RoadNetwork& road_;
  const GeoProjection& projection_;
  std::vector<BusStop> placed_;
};

}  // namespace sumogamma::osm
