#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "ego/ego_action.h"
#include "ego/ego_view.h"
#include "ego/futures.h"
#include "scene/agent_type.h"

namespace sumogamma {

/// Of the messages, docs/ego.md; one that speaks another is refused.
inline constexpr int kEgoProtocol = 1;

/// A message is a JSON object, as text or as CBOR: answers come as the last message came.
enum class MessageFormat : std::uint8_t { Json, Cbor };

/// What a client said is no message of the protocol.
struct ProtocolError {
  std::string what;
};

/// Reads a message: an object with a "type", no more than 8 levels deep. Throws ProtocolError.
nlohmann::json decode_message(std::string_view bytes, MessageFormat& format);
std::string encode_message(const nlohmann::json& message, MessageFormat format);

/// The "action" of a step: {"acceleration": a}, {"acceleration": a, "steering": s} or
/// {"trajectory": [[t, x, y], ...]} with rising times. Throws ProtocolError for what isn't one, or
/// isn't finite.
EgoAction action_of(const nlohmann::json& action);
/// The "plan" and "samples" of a question for futures, at most 200 of them.
FuturesRequest futures_request_of(const nlohmann::json& message);

nlohmann::json to_json(const EgoObservation& observation, const AgentTypeTable& types);
nlohmann::json to_json(const Futures& futures, bool knows);

}  // namespace sumogamma
