#include "demand/transport_xml.h"

#include <algorithm>
#include <string>

#include "demand/vehicle_type_xml.h"

namespace sumogamma {
namespace {

void set(pugi::xml_node node, const char* key, const std::string& value) {
  node.append_attribute(key) = value.c_str();
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " ") + name;
  return text;
}

void append_bus(pugi::xml_node root, const RoadNetwork& road, const PublicTransport& transport,
                const BusRun& run) {
  const LinePart& part = *run.part;
  pugi::xml_node vehicle = root.append_child("vehicle");
  set(vehicle, "id", run.id);
  set(vehicle, "type", "bus");
  set(vehicle, "depart", fixed(run.time));
  set(vehicle, "departLane", "best");
  set(vehicle, "departPos", run.first > 0 ? "random_free" : "base");
  set(vehicle, "departSpeed", "max");
  set(vehicle, "line", part.line);
  std::vector<std::string> edges;
  for (std::size_t row = run.first; row < part.route.size(); ++row)
    edges.push_back(road.edge(part.route[row]).name);
  set(vehicle.append_child("route"), "edges", joined(edges));
  for (const ServedStop& served : part.stops) {
    // who departs on the way may have passed the stops of its first edge
    if (run.first > 0 && served.edge <= run.first) continue;
    pugi::xml_node stop = vehicle.append_child("stop");
    set(stop, "busStop", transport.stops[served.stop].id);
    set(stop, "duration", fixed(kDwell));
  }
}

double length_of(const RoadNetwork& road, const std::string& edge) {
  return road.lane(road.edge(road.edge_by_name.at(edge)).lanes.front()).length;
}

/// Where on its first edge a rider departs [m].
double departure_place(const RoadNetwork& road, const BusStop& stop, const Rider& rider) {
  const double length = length_of(road, rider.to.front());
  if (rider.to.size() > 1) return rider.share_of_edge * length;
  const double at = stop.access ? stop.access->along : 0.5 * (stop.begin + stop.end);
  const double rim = std::min(2.0, 0.5 * length);  // not on the junction
  return std::clamp(at + (2.0 * rider.share_of_edge - 1.0) * kNearStop, rim, length - rim);
}

void append_rider(pugi::xml_node root, const RoadNetwork& road, const PublicTransport& transport,
                  const Rider& rider, std::size_t number) {
  pugi::xml_node person = root.append_child("person");
  set(person, "id", "rider." + std::to_string(number));
  set(person, "type", "pedestrian");
  set(person, "depart", fixed(rider.time));
  set(person, "departPos", fixed(departure_place(road, transport.stops[rider.boards], rider)));
  pugi::xml_node walk = person.append_child("walk");
  set(walk, "edges", joined(rider.to));
  set(walk, "busStop", transport.stops[rider.boards].id);
  pugi::xml_node ride = person.append_child("ride");
  set(ride, "busStop", transport.stops[rider.alights].id);
  set(ride, "lines", rider.line);
  walk = person.append_child("walk");
  set(walk, "edges", joined(rider.from));
  set(walk, "arrivalPos", fixed(rider.share_of_edge * length_of(road, rider.from.back())));
}

}  // namespace

void append_transport(pugi::xml_node root, const RoadNetwork& road, const DemandRequest& request,
                      std::span<const BusRun> runs, std::span<const Rider> riders) {
  if (!request.transport) return;
  const PublicTransport& transport = request.transport->transport;
  std::size_t next = 0;
  const auto append_buses_until = [&](double time) {
    for (; next < runs.size() && runs[next].time <= time; ++next)
      append_bus(root, road, transport, runs[next]);
  };
  for (std::size_t i = 0; i < riders.size(); ++i) {
    append_buses_until(riders[i].time);
    append_rider(root, road, transport, riders[i], i);
  }
  append_buses_until(request.duration);
}

}  // namespace sumogamma
