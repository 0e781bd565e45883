#include "traffic/rule_breaking.h"

#include "scene/traffic_code.h"

namespace sumogamma {

namespace {

/// What an encounter is at: the crossing, or the road on which a junction is approached.
std::uint64_t place_of(const Model& model, ConnectionId link) {
  const Connection& connection = model.road.connection(link);
  const bool crossing = model.road.lane(connection.to).kind == LaneKind::Crossing;
  return index_of(model.road.lane(crossing ? connection.to : connection.from).edge);
}

}  // namespace

bool goes_at_red(const TrafficView& view, std::size_t row, ConnectionId link) {
  const RoadNetwork& network = view.model.road;
  const Connection& connection = network.connection(link);
  if (connection.storage > 0.0) return true;
  const AgentType& type = type_of(view.model.types, view.scene.type[row]);
  const Manners& manners = view.scene.manners[row];
  const std::uint64_t place = place_of(view.model, link);
  if (type.kinematics == Kinematics::Holonomic) return jaywalks(type.compliance, manners, place);
  return admits_turn_on_red(view.code, network, connection, view.road.signal(connection)) ||
         runs_red_light(type.compliance, manners, place);
}

bool lets_people_go(const Model& model, const Scene& scene, std::size_t row,
                    ConnectionId crossing) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  return type.kinematics == Kinematics::Holonomic ||
         yields_to_people(type.compliance, scene.manners[row], place_of(model, crossing));
}

bool creeps(const TrafficView& view, std::size_t row, ConnectionId link) {
  const AgentType& type = type_of(view.model.types, view.scene.type[row]);
  return type.kinematics != Kinematics::Holonomic &&
         creeps_at_red(type.compliance, view.scene.manners[row], place_of(view.model, link));
}

bool rolls_over(const TrafficView& view, std::size_t row, ConnectionId link) {
  const Connection& connection = view.model.road.connection(link);
  if (!halts_first(connection.priority) || view.road.signal(connection) != Light::None)
    return false;
  const AgentType& type = type_of(view.model.types, view.scene.type[row]);
  return type.kinematics != Kinematics::Holonomic &&
         rolls_at_stop_sign(type.compliance, view.scene.manners[row], place_of(view.model, link));
}

}  // namespace sumogamma
