#include <algorithm>
#include <memory>

#include "road/lane_plan.h"
#include "road/path_builder.h"

namespace sumogamma {

std::optional<Path> build_driving_path(const RoadNetwork& network, const PathRequest& request,
                                       std::string& why) {
  if (request.route.empty()) {
    why = "the route has no edges";
    return std::nullopt;
  }
  auto trip = std::make_shared<Trip>();
  trip->route.assign(request.route.begin(), request.route.end());
  trip->request = request;
  trip->request.route = trip->route;
  trip->options = plan_lanes(network, request);
  const std::vector<LaneOption>& options = trip->options.front();
  const Edge& first = network.edge(request.route.front());
  int entry = -1;
  if (request.start_lane != kNoLane &&
      network.lane(request.start_lane).edge == request.route.front() &&
      options[static_cast<std::size_t>(network.lane(request.start_lane).index)].cost < kUnreachable)
    entry = network.lane(request.start_lane).index;
  for (std::size_t k = 0; entry < 0 && k < first.lanes.size(); ++k) {
    const bool better = options[k].cost < kUnreachable &&
                        std::all_of(options.begin(), options.end(), [&](const LaneOption& other) {
                          return options[k].cost <= other.cost;
                        });
    if (better) entry = static_cast<int>(k);
  }
  if (entry < 0) {
    why = "no lane leads from edge '" + first.name + "' along the route to '" +
          network.edge(request.route.back()).name + "' for this vehicle class";
    return std::nullopt;
  }
  PathBuilder builder(network, trip->request);
  if (!builder.drive_on(*trip, {0, entry, request.start_along}, why)) return std::nullopt;
  return builder.finish(std::move(trip));
}

}  // namespace sumogamma
