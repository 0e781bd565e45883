#pragma once

#include <array>
#include <map>
#include <set>
#include <string>

#include "base/parallel.h"
#include "model/model.h"
#include "sumo/backend.h"

namespace sumogamma {

/// The row with what an agent's vType says in place of the row's own values (docs/vtypes.md): what
/// differs from SUMO's defaults for its vehicle class was meant, everything else stays. `kept`:
/// keys of scenario.toml that were set ("types.car.headway"), which win over a vType. A body of
/// another length has its axles as far apart in proportion, so that it turns as such a body does.
AgentType with_vehicle_type(const AgentType& row, const SumoAgentDetails& details,
                            const std::set<std::string>& kept);

/// Rows of the model's tables that vTypes of a scenario ask for, added when the first agent of each
/// comes, and K of the others who come. Agents whose vTypes say the same share one.
class VehicleTypeRows {
 public:
  /// `model` outlives this.
  VehicleTypeRows(Model& model, std::set<std::string> kept)
      : model_(model), kept_(std::move(kept)) {}

  /// The row for an agent that counts as `kind`: itself where its vType says nothing else.
  AgentTypeId row_of(AgentTypeId kind, const SumoAgentDetails& details);

 private:
  using Values = std::array<double, 11>;
  static Values values_of(const AgentType& type);

  Model& model_;
  std::set<std::string> kept_;
  Workers workers_{1};
  std::map<std::pair<AgentTypeId, Values>, AgentTypeId> rows_;
};

}  // namespace sumogamma
