#include "ego/ego_protocol.h"

#include <cmath>

namespace sumogamma {

namespace {

using nlohmann::json;

constexpr int kDeepest = 8;
constexpr std::size_t kMostPoints = 1000;
constexpr int kMostSamples = 200;

/// Passes over a message and stops where it is nested too deep: the reader of CBOR goes into every
/// level by a call of its own.
class DepthCheck final : public json::json_sax_t {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(json::number_integer_t) override { return true; }
  bool number_unsigned(json::number_unsigned_t) override { return true; }
  bool number_float(json::number_float_t, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(json::binary_t&) override { return false; }
  bool start_object(std::size_t) override { return ++depth_ <= kDeepest; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return --depth_ >= 0; }
  bool start_array(std::size_t) override { return ++depth_ <= kDeepest; }
  bool end_array() override { return --depth_ >= 0; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    return false;
  }

 private:
  int depth_ = 0;
};

double finite(const json& value, const char* what) {
  if (!value.is_number()) throw ProtocolError{std::string(what) + " is no number"};
  const double number = value.get<double>();
  if (!std::isfinite(number)) throw ProtocolError{std::string(what) + " is not finite"};
  return number;
}

json pair_of(const Vec2& place) { return json::array({place.x(), place.y()}); }

json to_json(const VisibleAgent& agent, const AgentTypeTable& types) {
  return {{"id", agent.id},
          {"type", type_of(types, agent.type).name},
          {"position", pair_of(agent.position)},
          {"heading", agent.heading},
          {"velocity", pair_of(agent.velocity)},
          {"length", agent.length},
          {"width", agent.width}};
}

const char* word_of(Light light) {
  switch (light) {
    case Light::Red:
      return "red";
    case Light::Amber:
      return "amber";
    case Light::Green:
      return "green";
    case Light::GreenFirst:
      return "green_first";
    case Light::StopThenGo:
      return "stop_then_go";
    case Light::None:
      break;
  }
  return "none";
}

/// Finite where JSON has no word for what isn't.
double bounded(double value) { return std::isfinite(value) ? value : 1e9; }

}  // namespace

json decode_message(std::string_view bytes, MessageFormat& format) {
  format = !bytes.empty() && (bytes.front() == '{' || bytes.front() == ' ') ? MessageFormat::Json
                                                                            : MessageFormat::Cbor;
  json message;
  try {
    DepthCheck check;
    const bool is_text = format == MessageFormat::Json;
    if (!json::sax_parse(bytes.begin(), bytes.end(), &check,
                         is_text ? json::input_format_t::json : json::input_format_t::cbor))
      throw ProtocolError{"neither JSON nor CBOR, or nested too deep"};
    message = is_text ? json::parse(bytes) : json::from_cbor(bytes);
  } catch (const json::exception&) {
    throw ProtocolError{"neither JSON nor CBOR"};
  }
  const auto type = message.find("type");
  if (!message.is_object() || type == message.end() || !type->is_string())
    throw ProtocolError{"no object with a \"type\""};
  return message;
}

std::string encode_message(const json& message, MessageFormat format) {
  if (format == MessageFormat::Json) return message.dump();
  std::string bytes;
  json::to_cbor(message, bytes);
  return bytes;
}

EgoAction action_of(const json& action) {
  EgoAction result;
  if (!action.is_object()) throw ProtocolError{"\"action\" is no object"};
  if (const auto trajectory = action.find("trajectory"); trajectory != action.end()) {
    if (!trajectory->is_array() || trajectory->empty() || trajectory->size() > kMostPoints)
      throw ProtocolError{"\"trajectory\" must be a list of 1 to 1000 points [time, x, y]"};
    for (const json& point : *trajectory) {
      if (!point.is_array() || point.size() != 3)
        throw ProtocolError{"a point of \"trajectory\" must be [time, x, y]"};
      const double time = finite(point[0], "a point's time");
      if (time <= (result.trajectory.empty() ? 0.0 : result.trajectory.back().time))
        throw ProtocolError{"the times of \"trajectory\" must be above 0 and rise"};
      result.trajectory.push_back(
          {time, Vec2(finite(point[1], "a point's x"), finite(point[2], "a point's y"))});
    }
    return result;
  }
  const auto acceleration = action.find("acceleration");
  if (acceleration == action.end())
    throw ProtocolError{R"("action" has neither an "acceleration" nor a "trajectory")"};
  result.acceleration = finite(*acceleration, "\"acceleration\"");
  if (const auto steering = action.find("steering"); steering != action.end())
    result.steering = finite(*steering, "\"steering\"");
  return result;
}

FuturesRequest futures_request_of(const json& message) {
  FuturesRequest request;
  if (const auto plan = message.find("plan"); plan != message.end()) {
    if (!plan->is_array() || plan->size() > kMostPoints)
      throw ProtocolError{"\"plan\" must be a list of at most 1000 accelerations"};
    for (const json& one : *plan)
      request.plan.push_back(finite(one, "an acceleration of \"plan\""));
  }
  if (const auto samples = message.find("samples"); samples != message.end()) {
    const double count = finite(*samples, "\"samples\"");
    if (count < 1 || count > kMostSamples || count != std::floor(count))
      throw ProtocolError{"\"samples\" must be a whole number from 1 to 200"};
    request.samples = static_cast<int>(count);
  }
  if (const auto ways = message.find("ways"); ways != message.end()) {
    if (*ways != "believed" && *ways != "true")
      throw ProtocolError{R"("ways" must be "believed" or "true")"};
    request.knows = *ways == "true";
  }
  return request;
}

json to_json(const EgoObservation& observation, const AgentTypeTable& types) {
  json message{{"time", observation.time},
               {"ego", to_json(observation.ego, types)},
               {"agents", json::array()},
               {"way", json::array()},
               {"light", word_of(observation.light)},
               {"to_light", observation.to_light},
               {"to_goal", observation.to_goal}};
  message["ego"]["speed"] = observation.speed;
  message["ego"]["steering"] = observation.steering;
  for (const VisibleAgent& agent : observation.agents)
    message["agents"].push_back(to_json(agent, types));
  for (const WayPoint& point : observation.way)
    message["way"].push_back({{"position", pair_of(point.position)},
                              {"along", point.along},
                              {"room_left", bounded(point.room_left)},
                              {"room_right", bounded(point.room_right)},
                              {"limit", point.limit}});
  return message;
}

json to_json(const Futures& futures, bool knows) {
  json samples = json::array();
  const std::size_t count = futures.steps > 0 ? futures.gap.size() / futures.steps : 0;
  for (std::size_t sample = 0; sample < count; ++sample) {
    json poses = json::array(), gaps = json::array();
    for (std::size_t step = 0; step < futures.steps; ++step) {
      const std::size_t state = sample * futures.steps + step;
      gaps.push_back(bounded(futures.gap[state]));
      json row = json::array();
      for (std::size_t k = 0; k < futures.agents.size(); ++k) {
        const Futures::Pose& pose = futures.poses[state * futures.agents.size() + k];
        row.push_back({pose.position.x(), pose.position.y(), pose.heading, pose.speed});
      }
      poses.push_back(std::move(row));
    }
    samples.push_back({{"gap", std::move(gaps)}, {"poses", std::move(poses)}});
  }
  return {
      {"type", "futures"},
      {"step", futures.step},
      {"agents", futures.agents},
      {"samples", std::move(samples)},
      {"from", knows ? "everybody's own way, hidden draws" : "beliefs over ways, hidden draws"}};
}

}  // namespace sumogamma
