#include "study/offences/ground.h"

namespace sumogamma {

std::optional<Finding> is_on_sidewalk(const RuleView& view, std::size_t row, const Place& here,
                                      RuleWork& work) {
  const AgentType& type = type_of(view.types, view.scene.type[row]);
  const bool motor = (vehicle_class_from_name(type.sumo_class) & vehicle_class::kMotor) != 0;
  if (!here.walkway || !motor ||
      !holds_beside(view, row, work, [](const Place& place) { return place.walkway; }))
    return {};
  return Finding::Sidewalk;
}

}  // namespace sumogamma
