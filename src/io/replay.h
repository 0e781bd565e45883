#pragma once

#include <zlib.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/trajectories.h"
#include "road/road_network.h"
#include "scene/agent_type.h"
#include "scene/road_state.h"
#include "scene/scene.h"

namespace sumogamma {

/// A moment worth marking on the replay's time line.
enum class ReplayEventKind : std::uint8_t { Collision = 0, RedLight = 1, Stuck = 2 };

/// Records what a replay page draws into one compact file (replay.bin): the map once, then poses in
/// centimetres as second differences, signals where they change, and events; gzipped as it goes, so
/// a long run needs no memory. The layout is documented above the encoder in replay.cpp and decoded
/// by replay/recording.js.
class ReplayRecorder {
 public:
  static constexpr double kDefaultPeriod = 0.1;  ///< [s]

  /// `title`: shown on the page. `period`: time between recorded steps [s]. The network may be
  /// empty (a standalone scene). Throws Error naming the file where it can't be written.
  ReplayRecorder(const std::filesystem::path& file, const std::string& title,
                 const RoadNetwork& network, const AgentTypeTable& types,
                 double period = kDefaultPeriod);
  ~ReplayRecorder();
  ReplayRecorder(const ReplayRecorder&) = delete;
  ReplayRecorder& operator=(const ReplayRecorder&) = delete;

  /// Records the scene where the period is over. `road`: for signals, may be null. `types`: the
  /// scene's own where it has variants of the rows that the recorder was made with. Throws Error
  /// naming the file.
  void add(const Scene& scene, const RoadState* road, const AgentName& name_of,
           const AgentTypeTable* types = nullptr);

  /// Marks an event; `b` is kNobody where only one agent takes part.
  static constexpr std::uint32_t kNobody = ~0u;
  void add_event(ReplayEventKind kind, double time, const Vec2& position, AgentId a,
                 AgentId b = {kNobody});

  /// Ends the file. Idempotent. Throws Error naming the file.
  void close();

 private:
  struct Agent {
    AgentId id;
    std::int64_t x = 0, y = 0, heading = 0;  ///< as last written
    std::int64_t step_x = 0, step_y = 0;     ///< last differences
  };
  void append_changes(const Scene& scene, const AgentName& name_of, const AgentTypeTable* types);
  void append_poses(const Scene& scene);
  void append_signals(const RoadState& road);
  void put_byte(unsigned value) { buffer_.push_back(static_cast<char>(value & 0xffu)); }
  void put_count(std::uint64_t value);
  void put_signed(std::int64_t value);
  void put_text(std::string_view text);
  void flush();

  std::filesystem::path file_;
  double period_, next_time_ = 0;
  bool started_ = false;
  std::int64_t last_ms_ = 0;
  gzFile stream_ = nullptr;
  std::string buffer_;
  std::vector<Agent> agents_, next_;
  std::vector<std::string> signals_;
};

/// Writes one self-contained HTML page that plays a recording; it needs no network and no other
/// file. Throws Error naming the file where the recording is missing, damaged or the page can't be
/// written.
void write_replay_page(const std::filesystem::path& page, const std::filesystem::path& recording);

}  // namespace sumogamma
