#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ego/plan_trace.h"
#include "io/trajectories.h"
#include "model/gamma_velocity.h"
#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// A moment worth marking on the replay's time line.
enum class ReplayEventKind : std::uint8_t {
  Collision = 0,
  RedLight = 1,
  Stuck = 2,
  Conflict = 3,   ///< beyond FHWA's thresholds
  Encounter = 4,  ///< beyond those of SUMO's SSM device alone
  WrongWay = 5,
  OffRoad = 6,
  Sidewalk = 7
};

inline constexpr std::uint32_t kReplayNobody = ~0u;

/// A mark. The same moment (kind, time, who) may be told again with more to say.
struct ReplayEvent {
  ReplayEventKind kind{};
  double time = 0;  ///< [s]
  Vec2 position = Vec2::Zero();
  AgentId a;
  AgentId b{kReplayNobody};
  std::string words;  ///< what is to be said of it besides kind and who, may be empty
};

/// What the model made of one agent in one tick: `work` as gamma_velocity has left it.
struct InspectedAgent {
  AgentId id;
  Vec2 velocity = Vec2::Zero();  ///< of the frozen scene [m/s]
  Vec2 chosen = Vec2::Zero();    ///< v_new [m/s]
  Binding binding;
  Workspace work;
};

/// A scene to be recorded, with what is known about it.
struct ReplayStep {
  const Scene& scene;
  const AgentName& name_of;
  const RoadState* road = nullptr;         ///< for signals
  const AgentTypeTable* types = nullptr;   ///< the scene's own, where it has variants of rows
  std::span<const Binding> bindings = {};  ///< one a row, or none
};

/// "SGR3" and the map: with what a recording begins.
std::string replay_header(const std::string& title, const RoadNetwork& network,
                          const AgentTypeTable& types);

/// Makes records of what a replay page draws: poses in centimetres as second differences, signals
/// and agents' foes where they change, events, velocity spaces, plans of an ego. The layout is
/// documented above it in replay_stream.cpp and read by replay/recording.js.
class ReplayEncoder {
 public:
  static constexpr double kDefaultPeriod = 0.1;  ///< [s]

  /// `period`: time between recorded steps [s].
  explicit ReplayEncoder(double period = kDefaultPeriod) : period_(period) {}

  /// Records the scene where the period is over, and says whether it was.
  bool add_step(const ReplayStep& step);
  void add_event(const ReplayEvent& event);
  /// Belong to the last step. Precondition: is_at(their scene's time).
  void add_spaces(std::span<const InspectedAgent> agents);
  /// In order of time.
  void add_plan(const PlanTrace& plan);
  /// Is the last step that was recorded the one of this time?
  bool is_at(double time) const { return started_ && std::abs(time - last_time_) < 1e-6; }
  /// The next step will be readable without what came before, by readers who know the header.
  void begin_again();
  void end() { put_byte(0); }

  std::size_t size() const { return buffer_.size(); }
  /// The records since the last call.
  std::string take() { return std::exchange(buffer_, {}); }

 private:
  struct Agent {
    AgentId id;
    std::int64_t x = 0, y = 0, heading = 0;  ///< as last written
    std::int64_t step_x = 0, step_y = 0;     ///< last differences
    std::int64_t foe = -1, binding_foe = -1;
  };
  void append_changes(const ReplayStep& step);
  void append_newcomer(const ReplayStep& step, std::size_t row);
  void append_poses(const ReplayStep& step);
  void append_limits(const ReplayStep& step, std::size_t row, Agent& agent);
  void append_signals(const RoadState& road);
  void append_space(const InspectedAgent& agent);
  void append_choices(const PlanTrace& plan);
  void put_byte(unsigned value) { buffer_.push_back(static_cast<char>(value & 0xffu)); }
  void put_count(std::uint64_t value);
  void put_signed(std::int64_t value);
  void put_text(std::string_view text);
  void put_point(const Vec2& point, double unit);
  void put_line(const std::vector<Vec2>& line);

  double period_, next_time_ = 0, last_time_ = 0;
  bool started_ = false;
  std::int64_t last_ms_ = 0;
  std::string buffer_;
  std::vector<Agent> agents_, next_;
  std::vector<std::string> signals_;
};

}  // namespace sumogamma
