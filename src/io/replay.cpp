#include "io/replay.h"

#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace sumogamma {

ReplayRecorder::ReplayRecorder(const std::filesystem::path& file, const std::string& title,
                               const RoadNetwork& network, const AgentTypeTable& types,
                               double period)
    : file_(file), encoder_(period) {
  stream_ = gzopen(file.c_str(), "wb6");
  if (!stream_)
    throw Error(file.string(), std::string("can't be written (") + std::strerror(errno) + ")");
  write(replay_header(title, network, types));
}

ReplayRecorder::~ReplayRecorder() {
  try {
    close();
  } catch (const Error&) {
    // an exception is on its way already, or nobody asked whether the end was written
  }
}

void ReplayRecorder::write(const std::string& bytes) {
  if (bytes.empty() || !stream_) return;
  if (gzwrite(stream_, bytes.data(), static_cast<unsigned>(bytes.size())) > 0) return;
  const std::string why = std::strerror(errno);
  gzclose(stream_);
  stream_ = nullptr;
  throw Error(file_.string(), "can't be written to its end (" + why + "), make room and run again");
}

void ReplayRecorder::write_where_much() {
  constexpr std::size_t kFlushAt = 1 << 16;
  if (encoder_.size() >= kFlushAt) write(encoder_.take());
}

void ReplayRecorder::add(const ReplayStep& step) {
  if (!stream_) throw Error(file_.string(), "is closed already");
  encoder_.add_step(step);
  write_where_much();
}

void ReplayRecorder::add_event(const ReplayEvent& event) { encoder_.add_event(event); }

void ReplayRecorder::add_spaces(std::span<const InspectedAgent> agents) {
  encoder_.add_spaces(agents);
  write_where_much();
}

void ReplayRecorder::add_plan(const PlanTrace& plan) {
  encoder_.add_plan(plan);
  write_where_much();
}

void ReplayRecorder::close() {
  if (!stream_) return;
  encoder_.end();
  write(encoder_.take());
  const int code = gzclose(stream_);
  stream_ = nullptr;
  if (code != Z_OK)
    throw Error(file_.string(),
                std::string("can't be written to its end (") + std::strerror(errno) + ")");
}

}  // namespace sumogamma
