#include "ego/external_ego.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/random.h"

namespace sumogamma {

namespace {

using nlohmann::json;

constexpr double kSending = 10.0;       // for the other side to take a message [s]
constexpr double kContactCost = 100.0;  // in the reward [m]

std::string type_of_message(const json& message) { return message["type"].get<std::string>(); }

}  // namespace

ExternalEgo::ExternalEgo(const std::string& address, bool anywhere, ExternalLimits limits,
                         json hello, StopAsked stop)
    : listener_(address, anywhere),
      limits_(limits),
      hello_(std::move(hello)),
      stop_(std::move(stop)) {}

void ExternalEgo::fail(const std::string& why) {
  if (connection_)
    connection_->send(encode_message({{"type", "error"}, {"what", why}}, format_), 1.0);
  connection_.reset();
  failure_ = why;
  failures_.push_back(why);
}

void ExternalEgo::send(const json& message) {
  if (connection_ && !connection_->send(encode_message(message, format_), kSending))
    fail("it takes no messages, or is gone");
}

/// Null where none came in time (`late`), or it failed.
json ExternalEgo::receive(double seconds, bool& late) {
  late = false;
  if (!connection_) return {};
  const Received received = connection_->receive(seconds, stop_);
  switch (received.kind) {
    case Received::Kind::Late:
      late = true;
      return {};
    case Received::Kind::Closed:
      fail("it went away without a word");
      return {};
    case Received::Kind::Bad:
      fail(received.bytes);
      return {};
    case Received::Kind::Message:
      break;
  }
  try {
    return decode_message(received.bytes, format_);
  } catch (const ProtocolError& error) {
    fail(error.what);
    return {};
  }
}

/// Takes the next one that joins, and its hello.
void ExternalEgo::join() {
  connection_ = listener_.accept(limits_.join, stop_);
  if (!connection_) return;
  bool late = false;
  const json message = receive(limits_.join, late);
  if (late) return fail("it has joined and says nothing");
  if (message.is_null()) return;
  const auto version = message.find("protocol");
  if (type_of_message(message) != "hello") return fail("its first message is no hello");
  if (version == message.end() || *version != kEgoProtocol)
    return fail("it speaks another version of the protocol, expected " +
                std::to_string(kEgoProtocol));
  send(hello_);
}

std::optional<std::uint64_t> ExternalEgo::next_episode(std::span<const std::uint64_t> left) {
  hello_["seeds"] = std::vector<std::uint64_t>(left.begin(), left.end());
  failure_.clear();
  closed_ = false;
  plan_ = late_ = 0;
  late_in_a_row_ = 0;
  owes_answer_ = false;
  progress_shown_ = 0;
  beliefs_ = WayBeliefs();
  while (!(stop_ && stop_())) {
    if (!connection_) join();
    if (!connection_) {
      if (!failed()) return std::nullopt;  // nobody joins
      failure_.clear();
      continue;
    }
    bool late = false;
    const json message = receive(limits_.join, late);
    if (late) {
      fail("it begins no episode");
      continue;
    }
    if (message.is_null()) continue;
    const std::string type = type_of_message(message);
    if (type == "close") {
      send({{"type", "closed"}});
      connection_.reset();
      closed_ = true;
      return std::nullopt;
    }
    if (type == "step") continue;  // late, to the last plan of an episode that is over
    if (type != "reset") {
      fail("'" + type.substr(0, 40) + "' where a reset or close was expected");
      continue;
    }
    const auto seed = message.find("seed");
    const bool any = seed == message.end() || seed->is_null();
    if (any || (seed->is_number_unsigned() &&
                std::find(left.begin(), left.end(), seed->get<std::uint64_t>()) != left.end())) {
      failure_.clear();
      seed_ = any ? left.front() : seed->get<std::uint64_t>();
      return seed_;
    }
    fail("a seed that is none of those left in this drive");
  }
  return std::nullopt;
}

void ExternalEgo::show(const EgoObservation& observation, double progress, const EpisodeEnd* end,
                       const AgentTypeTable& types) {
  json message = to_json(observation, types);
  message["type"] = "observation";
  message["seed"] = seed_;
  message["step"] = plan_;
  message["late"] = late_;
  message["progress"] = progress;
  double reward = progress - std::exchange(progress_shown_, progress);
  if (end != nullptr && end->outcome == "collision") reward -= kContactCost;
  message["reward"] = reward;
  message["terminated"] = end != nullptr && end->terminated;
  message["truncated"] = end != nullptr && !end->terminated;
  message["outcome"] = end != nullptr ? end->outcome : "";
  send(message);
  owes_answer_ = true;
}

/// What a message during an episode asks for; an action where it is one for this plan.
std::optional<EgoAction> ExternalEgo::answer(const EgoView& view, const json& message) {
  const std::string type = type_of_message(message);
  if (type == "futures") {
    FuturesRequest request = futures_request_of(message);
    request.key = random_bits(view.seed, static_cast<std::uint64_t>(plan_), 0, Draw::Futures);
    json reply = to_json(sample_futures(view, request, beliefs_, forward_), request.knows);
    send(reply);
    return std::nullopt;
  }
  if (type == "step") {
    const auto number = message.find("step");
    if (number != message.end() && !number->is_number_integer())
      throw ProtocolError{"\"step\" is no whole number"};
    const std::int64_t answered = number != message.end() ? number->get<std::int64_t>() : plan_;
    if (answered > plan_) throw ProtocolError{"a \"step\" beyond the last observation's"};
    const bool is_old = answered < plan_;
    const auto action = message.find("action");
    if (action == message.end()) throw ProtocolError{"a step without an \"action\""};
    const EgoAction asked = action_of(*action);
    if (!is_old) return asked;
    owes_answer_ = false;  // it hasn't seen this plan yet
    return std::nullopt;
  }
  throw ProtocolError{type == "reset" || type == "close"
                          ? "it gave up amid an episode"
                          : "'" + type.substr(0, 40) + "' where a step was expected"};
}

EgoAction ExternalEgo::decide(const EgoView& view) {
  constexpr int kMostQuestions = 1000;  // a plan
  plan_ = view.plan;
  if (connection_) beliefs_.observe(view, forward_);
  const Scene& scene = view.world.scene;
  const AgentType& type = type_of(view.world.model.types, scene.type[view.row]);
  for (int k = 0; k < kMostQuestions && connection_; ++k) {
    if (!owes_answer_) {
      show(observe_ego(view.world.model, view.world.road, scene, view.row, view.goal, view.since),
           view.progress, nullptr, view.world.model.types);
    }
    bool late = false;
    const json message = receive(limits_.answer, late);
    if (late) {
      ++late_;
      if (++late_in_a_row_ >= limits_.most_late) fail("it doesn't answer any more");
      break;
    }
    if (message.is_null()) break;
    try {
      if (auto action = answer(view, message)) {
        late_in_a_row_ = 0;
        owes_answer_ = false;
        return *action;
      }
    } catch (const ProtocolError& error) {
      fail(error.what);
    }
  }
  if (connection_ && late_in_a_row_ == 0) fail("it asks without end");
  return full_braking(type);
}

void ExternalEgo::end_episode(const EpisodeEnd& end, const EgoObservation& last, double progress,
                              const AgentTypeTable& types) {
  if (!connection_ || failed()) return;
  ++plan_;
  show(last, progress, &end, types);
  owes_answer_ = false;
}

}  // namespace sumogamma
