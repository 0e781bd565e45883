#include "traffic/rule_breaking.h"

namespace sumogamma {

namespace {

/// What an encounter is at: the crossing, or the road on which a junction is approached.
std::uint64_t place_of(const Model& model, ConnectionId link) {
  const Connection& connection = model.road.connection(link);
  const bool crossing = model.road.lane(connection.to).kind == LaneKind::Crossing;
  return index_of(model.road.lane(crossing ? connection.to : connection.from).edge);
}

}  // namespace

bool goes_at_red(const Model& model, const Scene& scene, std::size_t row, ConnectionId link) {
  if (model.road.connection(link).storage > 0.0) return true;
  const AgentType& type = type_of(model.types, scene.type[row]);
  const std::uint64_t place = place_of(model, link);
  return type.kinematics == Kinematics::Holonomic
             ? jaywalks(type.compliance, scene.manners[row], place)
             : runs_red_light(type.compliance, scene.manners[row], place);
}

bool lets_people_go(const Model& model, const Scene& scene, std::size_t row,
                    ConnectionId crossing) {
  const AgentType& type = type_of(model.types, scene.type[row]);
  return type.kinematics == Kinematics::Holonomic ||
         yields_to_people(type.compliance, scene.manners[row], place_of(model, crossing));
}

}  // namespace sumogamma
