#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "ego/ego_protocol.h"
#include "ego/ego_socket.h"
#include "ego/way_beliefs.h"

namespace sumogamma {

/// How long an ego outside is waited for.
struct ExternalLimits {
  double answer = 10;  ///< for an action, then it counts as full braking [s]
  double join = 60;    ///< for somebody to join, to say hello and to begin an episode [s]
  int most_late = 10;  ///< answers one after the other that don't come: then it has failed
};

/// How an episode ended, as it is told to the ego.
struct EpisodeEnd {
  std::string outcome;
  bool terminated = false;  ///< at the goal, or by a contact; else it was cut off
};

/// An ego that joins through a socket and speaks the protocol of docs/ego.md. The world waits for
/// it. What it does wrong fails its episode, and is never thrown.
class ExternalEgo {
 public:
  /// `hello`: what it is told of the drive.
  ExternalEgo(const std::string& address, bool anywhere, ExternalLimits limits,
              nlohmann::json hello, StopAsked stop);

  const std::string& address() const { return listener_.address(); }

  /// Waits for somebody to begin an episode, of a seed that is left. Nothing: nobody joins any
  /// more, or it has closed in good order.
  std::optional<std::uint64_t> next_episode(std::span<const std::uint64_t> left);

  /// One plan: shows what can be seen, answers questions, and waits for the action. Full braking
  /// where that comes late, and once it has failed.
  EgoAction decide(const EgoView& view);
  /// The end of its episode, with what can be seen then.
  void end_episode(const EpisodeEnd& end, const EgoObservation& last, double progress,
                   const AgentTypeTable& types);

  bool failed() const { return !failure_.empty(); }
  /// What the last client did wrong in this episode; empty: nothing.
  const std::string& failure() const { return failure_; }
  /// Plans of this episode whose action came late.
  std::int64_t late() const { return late_; }
  /// Who failed, and how, since the beginning: one line each.
  const std::vector<std::string>& failures() const { return failures_; }
  /// The last client said that it is through.
  bool closed() const { return closed_; }

 private:
  void join();
  void fail(const std::string& why);
  void send(const nlohmann::json& message);
  nlohmann::json receive(double seconds, bool& late);
  void show(const EgoObservation& observation, double progress, const EpisodeEnd* end,
            const AgentTypeTable& types);
  std::optional<EgoAction> answer(const EgoView& view, const nlohmann::json& message);

  EgoListener listener_;
  ExternalLimits limits_;
  nlohmann::json hello_;
  StopAsked stop_;
  std::unique_ptr<EgoConnection> connection_;
  MessageFormat format_ = MessageFormat::Json;
  ForwardModel forward_;

  // of the episode
  std::uint64_t seed_ = 0;
  std::int64_t plan_ = 0, late_ = 0;
  int late_in_a_row_ = 0;
  WayBeliefs beliefs_;
  bool owes_answer_ = false;  ///< it has been shown something, and has not answered yet
  double progress_shown_ = 0;
  std::string failure_;
  std::vector<std::string> failures_;
  bool closed_ = false;
};

}  // namespace sumogamma
