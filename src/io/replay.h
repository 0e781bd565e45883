#pragma once

#include <zlib.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "io/replay_stream.h"

namespace sumogamma {

/// Records what a replay page draws into one compact file (replay.bin): the records of
/// ReplayEncoder, gzipped as they come, so a long run needs no memory.
class ReplayRecorder {
 public:
  /// `title`: shown on the page. `period`: time between recorded steps [s]. The network may be
  /// empty (a standalone scene). Throws Error naming the file where it can't be written.
  ReplayRecorder(const std::filesystem::path& file, const std::string& title,
                 const RoadNetwork& network, const AgentTypeTable& types,
                 double period = ReplayEncoder::kDefaultPeriod);
  ~ReplayRecorder();
  ReplayRecorder(const ReplayRecorder&) = delete;
  ReplayRecorder& operator=(const ReplayRecorder&) = delete;

  /// Records the scene where the period is over. Throws Error naming the file.
  void add(const ReplayStep& step);
  void add_event(const ReplayEvent& event);
  /// Of the last recorded step: see ReplayEncoder.
  void add_spaces(std::span<const InspectedAgent> agents);
  void add_plan(const PlanTrace& plan);
  bool is_at(double time) const { return encoder_.is_at(time); }

  /// Ends the file. Idempotent. Throws Error naming the file.
  void close();

 private:
  void write(const std::string& bytes);
  void write_where_much();

  std::filesystem::path file_;
  ReplayEncoder encoder_;
  gzFile stream_ = nullptr;
};

}  // namespace sumogamma
