#pragma once

#include <optional>

#include "model/model.h"
#include "road/path.h"
#include "sumo/backend.h"

namespace sumogamma {

/// Type-table row for a SUMO agent: the row of the vType's own name, else by vehicle class, else,
/// for a class that says nothing of the body (evehicle, hov, custom1, ...), the one nearest in
/// size; nullopt for what drives on rails or water.
std::optional<AgentTypeId> agent_type_of(const AgentTypeTable& types,
                                         const SumoAgentDetails& details);

/// The path that an agent is going to follow from where it is, by the speed limits that hold now;
/// null with `why` set where the network does not carry it.
std::shared_ptr<Path> path_of(const Model& model, const SumoAgentDetails& details, AgentTypeId type,
                              std::string& why, const SpeedLimits& limits = nullptr);

/// Paths of the same vehicle from the lanes beside the one where `path` starts, nearest first:
/// those that its trip can start on and that lead on as far as this one, or for kilometres.
std::vector<std::shared_ptr<const Path>> paths_besides(const Model& model,
                                                       const SumoAgentDetails& details,
                                                       AgentTypeId type_id, const Path& path);

/// Puts the pace of its own at which somebody rides a bicycle into details.max_speed, its factor in
/// it: vType's desiredMaxSpeed, which TraCI does not tell, is seen where SUMO lets it ride no
/// faster than that on a road that allows more; elsewhere it is SUMO's default. Others keep their
/// maximum.
void choose_pace(const RoadNetwork& network, SumoAgentDetails& details);

/// Puts a factor drawn from the type in place of the one that SUMO drew from the vType, where the
/// type has one of its own (Compliance::speed_factor): a pure function of seed and SUMO's id.
void choose_speed_factor(const AgentType& type, std::uint64_t seed, SumoAgentDetails& details);

/// Draws whether, and where, somebody on foot crosses roads between junctions
/// (Compliance::jaywalking_rate): a pure function of seed and SUMO's id.
void choose_mid_block(const AgentType& type, std::uint64_t seed, SumoAgentDetails& details);

/// Place beside the path that one agent likes: on foot and on two wheels towards the kerb, so that
/// opposite flows part [m].
double draw_path_offset(const Model& model, const AgentType& type, std::uint64_t seed, AgentId id);

/// Does a vehicle depart at the first stop of its plan?
bool departs_at_stop(const SumoAgentDetails& details);

}  // namespace sumogamma
