#include "prediction/prediction_map.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "base/units.h"

namespace sumogamma {

namespace {

bool runs_along(const LaneHit& hit, double heading) {
  return hit.direction.dot(direction_of(heading)) >= std::cos(radians(kAlongLane));
}

/// Corners of all that agents on wheels were seen at.
struct Corners {
  Vec2 lower = Vec2::Constant(1e300), upper = Vec2::Constant(-1e300);
  void add(const Vec2& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
};

std::string text_of(const Corners& corners) {
  return fmt::format("{:.0f},{:.0f} to {:.0f},{:.0f}", corners.lower.x(), corners.lower.y(),
                     corners.upper.x(), corners.upper.y());
}

}  // namespace

void find_lanes_under(const LaneLocator& locator, const RoadNetwork& network, const AgentType& type,
                      const Vec2& point, double heading, std::vector<LaneHit>& hits) {
  hits.clear();
  if (type.kinematics == Kinematics::Holonomic) return;
  const VehicleClassMask classes = vehicle_class_from_name(type.sumo_class);
  const auto drives = [&](LaneId id) {
    const Lane& lane = network.lane(id);
    return (lane.kind == LaneKind::Normal || lane.kind == LaneKind::Internal) &&
           (lane.allowed & classes) != 0;
  };
  locator.find_containing(point, drives, hits);
  std::erase_if(hits, [&](const LaneHit& hit) { return !runs_along(hit, heading); });
  if (!hits.empty()) return;
  const LaneHit near = locator.find_nearest(point, classes, heading, kOffLane);
  if (near.lane != kNoLane && drives(near.lane) && runs_along(near, heading)) hits.push_back(near);
}

MapFit fit_of(const PredictionMap& map, const TrackSet& set) {
  const AgentTypeTable types = recorded_agent_types();
  const LaneLocator locator(*map.network);
  MapFit fit;
  std::vector<LaneHit> hits;
  for (const Track& track : set.tracks) {
    const AgentType& type = type_of(types, track.type);
    if (type.kinematics == Kinematics::Holonomic) continue;
    ++fit.wheeled;
    std::size_t on = 0;
    for (std::size_t k = 0; k < track.position.size(); ++k) {
      find_lanes_under(locator, *map.network, type, track.position[k] + map.offset,
                       track.heading[k], hits);
      on += !hits.empty();
    }
    fit.on_map += 2 * on >= track.position.size();
  }
  return fit;
}

MapFit check_fit(const PredictionMap& map, const TrackSet& set) {
  const MapFit fit = fit_of(map, set);
  if (fit.wheeled == 0)
    throw Error(map.name, "is of no use to " + set.name +
                              ", in which nobody is on wheels: leave --map out for it");
  if (fit.on_map > 0) return fit;
  const AgentTypeTable types = recorded_agent_types();
  Corners seen, lanes;
  for (const Track& track : set.tracks)
    if (type_of(types, track.type).kinematics != Kinematics::Holonomic)
      for (const Vec2& point : track.position) seen.add(point + map.offset);
  for (const Lane& lane : map.network->lanes)
    for (const Vec2& point : lane.centerline.points()) lanes.add(point);
  const Vec2 between = 0.5 * (lanes.lower + lanes.upper - seen.lower - seen.upper) + map.offset;
  throw Error(
      map.name,
      fmt::format("none of the {} agents on wheels of {} lies on its lanes: they are at {} "
                  "m, its lanes at {} m. Say where the recording's axes lie on the map: "
                  "--map-offset X,Y, which is added to its positions (near {:.0f},{:.0f} if "
                  "both have the same middle), or --map-origin LAT,LON",
                  fit.wheeled, set.name, text_of(seen), text_of(lanes), between.x(), between.y()));
}

}  // namespace sumogamma
