#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sumo/backend.h"
#include "sumo/traci_message.h"

namespace sumogamma {

/// The status of one command and, where that is fine, its value; empty: refused. Throws SumoError
/// where the reply is to another command.
std::optional<TraciReader> read_answer(TraciReader& reply, std::uint8_t domain,
                                       std::uint8_t variable);
/// Likewise, and throws SumoError that names the `question` where it is refused.
TraciReader require_answer(TraciReader& reply, std::uint8_t domain, std::uint8_t variable,
                           const std::string& question);
/// Likewise as a plain value; "", `otherwise`, 0 and none where it is refused.
std::string read_text(TraciReader& reply, std::uint8_t domain, std::uint8_t variable);
double read_number(TraciReader& reply, std::uint8_t domain, std::uint8_t variable,
                   double otherwise);
int read_integer(TraciReader& reply, std::uint8_t domain, std::uint8_t variable);
std::vector<std::string> read_texts(TraciReader& reply, std::uint8_t domain, std::uint8_t variable);

/// A stage of a person's plan.
struct TraciStage {
  int type = 0;
  std::vector<std::string> edges;
  double arrival_position = -1;  ///< along the last edge [m], < 0: its end
};
TraciStage read_stage(TraciReader value);
StageKind stage_kind(int type);

/// Asks for all that SumoAgentDetails holds but how often a vehicle reroutes, and reads the answers
/// to that.
void ask_details(TraciWriter& message, const std::string& id, bool is_person);
SumoAgentDetails read_details(TraciReader& reply, const std::string& id, bool is_person);

}  // namespace sumogamma
