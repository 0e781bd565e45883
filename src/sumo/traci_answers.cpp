#include "sumo/traci_answers.h"

#include <algorithm>
#include <iterator>

#include "base/error.h"

namespace sumogamma {

std::optional<TraciReader> read_answer(TraciReader& reply, std::uint8_t domain,
                                       std::uint8_t variable) {
  const TraciStatus status = reply.status();
  if (status.command != domain) throw SumoError("SUMO", "an answer to another command over TraCI");
  if (!status.ok()) return std::nullopt;
  return reply.value(domain, variable);
}

TraciReader require_answer(TraciReader& reply, std::uint8_t domain, std::uint8_t variable,
                           const std::string& question) {
  const TraciStatus status = reply.status();
  if (!status.ok()) throw SumoError("SUMO", "can't tell " + question + ": " + status.text);
  return reply.value(domain, variable);
}

std::string read_text(TraciReader& reply, std::uint8_t domain, std::uint8_t variable) {
  std::optional<TraciReader> value = read_answer(reply, domain, variable);
  return value ? value->typed_string() : std::string();
}

double read_number(TraciReader& reply, std::uint8_t domain, std::uint8_t variable,
                   double otherwise) {
  std::optional<TraciReader> value = read_answer(reply, domain, variable);
  return value ? value->typed_double() : otherwise;
}

int read_integer(TraciReader& reply, std::uint8_t domain, std::uint8_t variable) {
  std::optional<TraciReader> value = read_answer(reply, domain, variable);
  return value ? value->typed_integer() : 0;
}

std::vector<std::string> read_texts(TraciReader& reply, std::uint8_t domain,
                                    std::uint8_t variable) {
  std::optional<TraciReader> value = read_answer(reply, domain, variable);
  return value ? value->typed_strings() : std::vector<std::string>();
}

namespace {

constexpr double kNoTime = -1.0;  // what stops that name no duration or end have [s]

// 16 items a stop in 1.15
std::vector<SumoAgentDetails::Stop> read_stops(TraciReader value) {
  std::vector<SumoAgentDetails::Stop> stops;
  value.compound();
  for (std::int32_t left = value.typed_integer(); left > 0; --left) {
    SumoAgentDetails::Stop stop;
    stop.lane = value.typed_string();
    stop.end = value.typed_double();
    stop.place = value.typed_string();
    stop.flags = value.typed_integer();
    stop.duration = std::max(value.typed_double(), kNoTime);
    stop.until = std::max(value.typed_double(), kNoTime);
    stop.start = value.typed_double();
    // arrivals, departure, parts of trains, activity, trip, line
    for (int rest = 8; rest > 0; --rest) value.skip_value();
    stop.speed = value.typed_double();
    stops.push_back(std::move(stop));
  }
  return stops;
}

}  // namespace

TraciStage read_stage(TraciReader value) {
  TraciStage stage;
  value.compound();
  stage.type = value.typed_integer();
  for (int i = 0; i < 3; ++i) value.skip_value();  // type, line, stop
  stage.edges = value.typed_strings();
  for (int i = 0; i < 6; ++i)
    value.skip_value();  // travel time, cost, length, intended vehicle, depart, its position
  stage.arrival_position = value.typed_double();
  return stage;
}

StageKind stage_kind(int type) {
  return type == traci::kStageWaiting   ? StageKind::Waiting
         : type == traci::kStageWalking ? StageKind::Walking
         : type == traci::kStageDriving ? StageKind::Riding
                                        : StageKind::Other;
}

namespace {

constexpr std::uint8_t kDetailVariables[] = {
    traci::kType,     traci::kVehicleClass, traci::kLength, traci::kWidth,       traci::kHeight,
    traci::kMaxSpeed, traci::kSpeedFactor,  traci::kLane,   traci::kLanePosition};

constexpr std::uint8_t kTypeVariables[] = {
    traci::kAcceleration, traci::kDeceleration, traci::kEmergencyDeceleration,
    traci::kHeadway,      traci::kMinGap,       traci::kImperfection};

}  // namespace

void ask_details(TraciWriter& message, const std::string& id, bool is_person) {
  const std::uint8_t domain = is_person ? traci::kPerson : traci::kVehicle;
  for (const std::uint8_t variable : kDetailVariables) message.get(domain, variable, id);
  if (is_person) {
    message.get(domain, traci::kStage, id, 0);
    message.get(domain, traci::kStagesLeft, id);
  } else {
    for (const std::uint8_t variable : kTypeVariables) message.get(domain, variable, id);
    message.get(domain, traci::kAllowedSpeed, id);
    message.get(domain, traci::kEdges, id);
    message.get(domain, traci::kStops, id, 0);
    message.get(domain, traci::kStopState, id);
    message.get(domain, traci::kRouteIndex, id);
    message.get(domain, traci::kParameter, id, "has.taxi.device");
    message.get(domain, traci::kParameter, id, "has.rerouting.device");
  }
}

namespace {

void read_person(TraciReader& reply, SumoAgentDetails& details) {
  if (std::optional<TraciReader> value = read_answer(reply, traci::kPerson, traci::kStage)) {
    const TraciStage stage = read_stage(*value);
    details.stage = stage_kind(stage.type);
    if (details.stage == StageKind::Walking) {
      details.route = stage.edges;
      details.arrival_position = stage.arrival_position;
    }
  }
  details.stages_left = read_integer(reply, traci::kPerson, traci::kStagesLeft);
}

void read_vehicle(TraciReader& reply, SumoAgentDetails& details) {
  constexpr std::uint8_t kDomain = traci::kVehicle;
  SumoVehicleType& type = details.type;
  double* const fields[] = {&type.acceleration, &type.deceleration, &type.emergency_deceleration,
                            &type.headway,      &type.min_gap,      &type.imperfection};
  for (std::size_t k = 0; k < std::size(kTypeVariables); ++k)
    *fields[k] = read_number(reply, kDomain, kTypeVariables[k], -1);
  details.allowed_speed = read_number(reply, kDomain, traci::kAllowedSpeed, 0);
  details.route = read_texts(reply, kDomain, traci::kEdges);
  if (std::optional<TraciReader> value = read_answer(reply, kDomain, traci::kStops))
    details.stops = read_stops(*value);
  details.stop_state = read_integer(reply, kDomain, traci::kStopState);
  details.route_index = std::max(read_integer(reply, kDomain, traci::kRouteIndex), 0);
  details.is_taxi = read_text(reply, kDomain, traci::kParameter) == "true";
  // how often is asked of those that have one: SUMO counts other questions as errors
  if (read_text(reply, kDomain, traci::kParameter) == "true") details.reroute_period = 0.0;
}

}  // namespace

SumoAgentDetails read_details(TraciReader& reply, const std::string& id, bool is_person) {
  const std::uint8_t domain = is_person ? traci::kPerson : traci::kVehicle;
  SumoAgentDetails details;
  details.id = id;
  details.is_person = is_person;
  details.type_id = read_text(reply, domain, traci::kType);
  details.vehicle_class = read_text(reply, domain, traci::kVehicleClass);
  details.length = read_number(reply, domain, traci::kLength, 0);
  details.width = read_number(reply, domain, traci::kWidth, 0);
  details.height = read_number(reply, domain, traci::kHeight, 0);
  details.max_speed = read_number(reply, domain, traci::kMaxSpeed, 0);
  details.speed_factor = read_number(reply, domain, traci::kSpeedFactor, 1);
  details.lane = read_text(reply, domain, traci::kLane);
  details.lane_position = read_number(reply, domain, traci::kLanePosition, 0);
  if (is_person)
    read_person(reply, details);
  else
    read_vehicle(reply, details);
  return details;
}

}  // namespace sumogamma
